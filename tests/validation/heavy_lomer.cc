// The Lomer-Cottrell lock (Durocher, thesis, Bordeaux 2018, table IV.2) and the map of Lomer reactions. Minutes.
//
// The rows `lock ...` and `map ...` of the output are drawn by examples/lomer_cottrell_lock/plot.py.
#include "dd/crystal/material.h"
#include "samples/dislocation_driver.h"
#include "support.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>
#include <vector>

namespace
{
using namespace ddfem;

const Material &aluminium = find_material("aluminium");
const SlipSystems fcc(Lattice::fcc, aluminium.lattice_parameter);
constexpr double length = 200;

/// One of the two lines.
struct Line
{
  Miller plane;
  Vec3 burgers, direction;
};

struct Discretisation
{
  double min_segment, max_segment;
  double tolerance = 0.05; ///< of the time integration, nm
};

/// Two lines pinned at their ends that cross at their mid-points with a gap of 0.02 nm.
class CrossingLines : public DislocationDriver
{
public:
  CrossingLines(const std::array<Line, 2> &lines, const Discretisation &h, const VelocitySettings &velocities = {})
      : DislocationDriver(settings(h, velocities), fcc), product(lines[0].burgers + lines[1].burgers)
  {
    for (const Line &l : lines)
    {
      const Vec3 n = fcc.orientation().unit_vector(l.plane);
      const PlaneIndex p = network.planes().find_or_insert(l.plane, n, Vec3(Vec3::Zero()));
      const Vec3 t = l.direction.normalized(),
                 gap = network.n_nodes() > 0 ? Vec3(0.02 * n.cross(t)) : Vec3(Vec3::Zero());
      const int pieces = 2 * static_cast<int>(std::ceil(0.5 * length / (0.75 * h.max_segment)));
      std::vector<Vec3> points;
      for (int k = 0; k <= pieces; ++k)
        points.push_back(network.planes().project(p, gap + (double(k) / pieces - 0.5) * length * t));
      add_line(network, points, l.burgers, p, false, NodeConstraint::pinned);
    }
  }

  double junction() const
  {
    double sum = 0;
    for (const SegmentIndex s : network.segments())
      if ((network.burgers(s) - product).norm() < 1e-6 || (network.burgers(s) + product).norm() < 1e-6)
        sum += network.length(s);
    return sum;
  }

  std::size_t four_arm_nodes() const
  {
    return static_cast<std::size_t>(std::count_if(network.nodes().begin(), network.nodes().end(),
                                                  [&](const NodeIndex i) { return network.degree(i) >= 4; }));
  }

private:
  static DriverSettings settings(const Discretisation &h, const VelocitySettings &velocities)
  {
    const double b = aluminium.burgers_magnitude;
    return {{aluminium.mu, aluminium.nu, b},
            b,
            linear_glide(aluminium.drag, aluminium.drag),
            {h.min_segment, h.max_segment, 0.1, h.min_segment / 8},
            {h.tolerance, 1, 0.2, 1e-4, 30},
            1e-5,
            {},
            velocities};
  }
  Vec3 product;
};

/// The lines of the thesis, with the overlines of its table IV.2 put such that line and Burgers vector lie in the
/// planes.
std::array<Line, 2> thesis_lines()
{
  const double h = aluminium.burgers_magnitude / std::numbers::sqrt2;
  return {Line{{1, 1, -1}, h * Vec3(0, -1, -1), Vec3(-1, 2, 1)}, Line{{1, 1, 1}, h * Vec3(-1, 0, 1), Vec3(-2, 1, 1)}};
}

/// Stress tau on (010) along [00-1].
SymTensor shear(const double tau)
{
  SymTensor s = SymTensor::Zero();
  s[5] = -tau;
  return s;
}

template <class... T> std::string row(const T &...fields)
{
  std::ostringstream out;
  ((out << fields << ' '), ...);
  return out.str();
}

/// How often a node next to an end of the junction is more than twice as fast as the one behind it.
struct Race
{
  std::size_t pairs = 0, twice = 0;

  void count(const Network &network, const std::vector<Vec3> &velocity)
  {
    constexpr double at_rest = 5; // nm/ns
    for (const NodeIndex end : network.nodes())
      if (network.degree(end) == 3)
        for (const SegmentIndex s : network.connected_segments(end))
        {
          const NodeIndex first = network.other_end(s, end);
          if (network.is_physical(first) || !network.plane(s).is_valid())
            continue;
          const auto arms = network.connected_segments(first);
          const NodeIndex second = network.other_end(arms[0] == s ? arms[1] : arms[0], first);
          const double fast = velocity[first.value].norm(), slow = velocity[second.value].norm();
          if (network.is_physical(second) || std::max(fast, slow) < at_rest)
            continue;
          ++pairs;
          twice += fast > 2 * slow ? 1 : 0;
        }
  }
};

/// The lock at 0 and then 150 MPa; returns the length of the junction after 20 ps, while it zips.
double zipped_length(const VelocitySettings &velocities, const Discretisation &h, const std::string &name,
                     const validation::Report &report)
{
  CrossingLines lock(thesis_lines(), h, velocities);
  unsigned steps = 0, evaluations = 0;
  Race race;
  const auto run_to = [&](const double until)
  {
    while (lock.time < until - 1e-12)
    {
      evaluations += lock.step(until - lock.time).evaluations;
      ++steps;
      race.count(lock.network, lock.velocities());
    }
    return lock.junction();
  };
  const double zipping = run_to(0.02), at_rest = run_to(0.5);
  lock.applied = shear(150);
  const double unzipping = run_to(0.52), loaded = run_to(1.5);
  report.note(row("velocities", name, zipping, at_rest, unzipping, loaded, "nm; steps", steps, "mean", 1.5e3 / steps,
                  "ps; evaluations", evaluations, "; remesh operations",
                  lock.counts.refinements + lock.counts.coarsenings, "; node next to the junction twice as fast in",
                  race.twice, "of", race.pairs));
  return zipping;
}

/// Local and consistent velocities, with and without sliding drag (thesis, section IV.1.1.2, figures IV.8 to IV.10).
void compare_velocities(validation::Report &report)
{
  const Discretisation coarse{4, 10}, fine{1.6, 4, 0.01};
  const double converged =
      zipped_length({VelocityMethod::consistent, 0.01}, fine, "consistent 0.01, 1.6 to 4 nm:", report);
  zipped_length({VelocityMethod::local, 1}, coarse, "local 1:", report);
  const double local = zipped_length({VelocityMethod::local, 0.1}, coarse, "local 0.1:", report);
  zipped_length({VelocityMethod::local, 0.01}, coarse, "local 0.01:", report);
  zipped_length({VelocityMethod::consistent, 1}, coarse, "consistent 1:", report);
  const double consistent = zipped_length({VelocityMethod::consistent, 0.1}, coarse, "consistent 0.1:", report);
  report.below("lock: length after 20 ps, local velocities, against fine segments", local / converged - 1, 0.03);
  report.below("lock: the same, consistent velocities", consistent / converged - 1, 0.02);
}

struct LockLengths
{
  double free = 0, loaded = 0;
};

/// Relaxes at 0 and 150 MPa; rows of time and length go to the report.
LockLengths relaxed_lengths(const Discretisation &h, const validation::Report &report)
{
  CrossingLines lock(thesis_lines(), h);
  LockLengths lengths;
  const auto run_to = [&](const double end)
  {
    while (lock.time < end - 1e-12)
    {
      lock.step(end - lock.time);
      report.note(row("lock", h.min_segment, h.max_segment, h.tolerance, lock.time, lock.junction()));
    }
    return lock.junction();
  };
  lengths.free = run_to(0.5);
  lock.applied = shear(150);
  lengths.loaded = run_to(2.5);
  return lengths;
}

/// Whether the lock, relaxed at 150 MPa, holds @p tau for 3 ns.
bool holds(const double tau)
{
  CrossingLines lock(thesis_lines(), {4, 10});
  lock.relax(0.3, 1);
  lock.applied = shear(150);
  lock.relax(1, 1);
  lock.applied = shear(tau);
  const double end = lock.time + 3;
  while (lock.time < end - 1e-12 && lock.junction() > 0)
    if (lock.step(end - lock.time).max_speed < 0.1)
      break;
  return lock.junction() > 0;
}

/// Pull of an arm of line energy mu b^2 (1 - nu cos^2 theta)/(4 pi (1-nu)) ln on its node along the common line e of
/// the planes, in units of mu/(4 pi) ln; phi is the angle of the arm from e.
double line_tension_pull(const Vec3 &b, const Vec3 &n, const Vec3 &e, const double phi)
{
  const Vec3 t = std::cos(phi) * e + std::sin(phi) * n.cross(e), dt = -std::sin(phi) * e + std::cos(phi) * n.cross(e);
  const double nu = aluminium.nu;
  return ((b.squaredNorm() - nu * b.dot(t) * b.dot(t)) * t.dot(e) - 2 * nu * b.dot(t) * b.dot(dt) * dt.dot(e)) /
         (1 - nu);
}

/// Length of the junction of two lines at angles @p phi from e by balance of orientation-dependent line tensions
/// (Dupuy & Fivel, Acta Mater. 50 (2002) 4873).
double line_tension_junction(const std::array<Line, 2> &lines, const Vec3 &e, const std::array<double, 2> &phi)
{
  const Vec3 b = lines[0].burgers + lines[1].burgers;
  const double junction = (b.squaredNorm() - aluminium.nu * b.dot(e) * b.dot(e)) / (1 - aluminium.nu);
  for (double s = 0; s < 0.5 * length; s += 0.1)
  {
    double pull = -junction;
    for (std::size_t k = 0; k < 2; ++k)
    {
      const double x = 0.5 * length * std::cos(phi[k]) - s, y = 0.5 * length * std::sin(phi[k]);
      pull += line_tension_pull(lines[k].burgers, fcc.orientation().unit_vector(lines[k].plane), e, std::atan2(y, x));
    }
    if (pull < 0)
      return 2 * s;
  }
  return length;
}

void compare_map(validation::Report &report)
{
  const SlipSystem &first = fcc[*fcc.find("B4")], &second = fcc[*fcc.find("C1")];
  const Vec3 n1 = first.normal, n2 = second.normal, e = n1.cross(n2).normalized();
  int cases = 0, different = 0, clear = 0, clearly_different = 0;
  double deviation = 0;
  int junctions = 0;
  for (int p1 = -75; p1 <= 75; p1 += 15)
    for (int p2 = -75; p2 <= 75; p2 += 15)
    {
      const std::array<double, 2> phi{p1 * std::numbers::pi / 180, p2 * std::numbers::pi / 180};
      const std::array<Line, 2> lines{
          Line{first.plane_miller, first.burgers, std::cos(phi[0]) * e + std::sin(phi[0]) * n1.cross(e)},
          Line{second.plane_miller, -second.burgers, std::cos(phi[1]) * e + std::sin(phi[1]) * n2.cross(e)}};
      CrossingLines pair(lines, {8, 20});
      pair.relax(0.15, 2);
      const double found = pair.junction(), expected = line_tension_junction(lines, e, phi);
      report.note(row("map", p1, p2, found, expected, pair.four_arm_nodes()));
      ++cases;
      different += (found > 1) != (expected > 1) ? 1 : 0;
      if (expected > 30 || found > 30)
      {
        ++clear;
        clearly_different += found > 1 && expected > 1 ? 0 : 1;
        deviation += std::abs(found - expected);
        ++junctions;
      }
    }
  report.below(row("Lomer map: cases of", cases, "in which only one of DD and line tension has a junction"), different,
               13);
  report.below(row("Lomer map: the same for junctions beyond 30 nm, of", clear), clearly_different, 1);
  report.below("Lomer map: mean deviation of these lengths from line tension / L", deviation / junctions / length,
               0.05);
}
} // namespace

int main(int argc, char **argv)
{
  return validation::run(
      argc, argv,
      [](validation::Report &report)
      {
        compare_velocities(report);
        // examples/lomer_cottrell_lock/quasi_static.py --local --shortest 3 --pieces 16 --stress 0 150
        constexpr double free = 96.868, loaded = 79.069;
        LockLengths smallest{1e9, 1e9}, largest;
        const std::array<Discretisation, 4> ranges{{{3, 7.5}, {4, 10}, {6, 15}, {4, 10, 0.005}}};
        for (const Discretisation &h : ranges)
        {
          const LockLengths l = relaxed_lengths(h, report);
          const std::string name = row("lock", h.min_segment, "to", h.max_segment, "nm, tolerance", h.tolerance);
          report.note(row(name, ": ", l.free, l.loaded, "nm at 0 and 150 MPa"));
          report.below(name + ": junction at 0 MPa against quasi-static", l.free / free - 1, 0.01);
          report.below(name + ": junction at 150 MPa against quasi-static", l.loaded / loaded - 1, 0.01);
          smallest = {std::min(smallest.free, l.free), std::min(smallest.loaded, l.loaded)};
          largest = {std::max(largest.free, l.free), std::max(largest.loaded, l.loaded)};
        }
        report.below("lock: spread over the discretisations at 0 MPa", largest.free / smallest.free - 1, 0.01);
        report.below("lock: spread over the discretisations at 150 MPa", largest.loaded / smallest.loaded - 1, 0.01);
        report.below("lock: dissolved at 150 MPa (0: holds)", holds(150) ? 0 : 1, 0.5);
        report.below("lock: holds at 200 MPa (0: dissolves)", holds(200) ? 1 : 0, 0.5);
        compare_map(report);
      });
}
