#include "dd/forces/multipole_forces.h"

#include "dd/common/parallel.h"
#include "dd/common/stopwatch.h"
#include "dd/elasticity/distance.h"
#include "dd/elasticity/gauss.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/stress_exchange.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ddfem
{
namespace
{
/// Sources nearer than this many half lengths to the middle of a panel are replaced, at most; the number of Gauss points follows.
constexpr double largest_near_distance = 9;
/// What rho^-(2n-1) of the nearest sources that are not replaced must be, for a requested error relative to the far force. The error
/// was measured (benchmarks/accuracy.cc) as up to 5 times that at 1e-3 and 60 times at 1e-6, where boxes are larger and less of the force
/// is far.
double tolerance_of_nearest(const double tolerance)
{
  return tolerance / (5.3 * std::pow(std::max(1e-3 / tolerance, 1.0), 0.4));
}

double bernstein_radius(const double distance)
{
  return distance + std::sqrt(1 + distance * distance);
}

int n_points_for(const double tolerance)
{
  const double power = -std::log(tolerance) / std::log(bernstein_radius(largest_near_distance));
  return std::max(1, static_cast<int>(std::ceil(0.5 * (power + 1))));
}

/// Distance from the middle, in half lengths, from which @p n points reach the tolerance: the larger axis of the ellipse.
double near_distance_for(const double tolerance, const int n)
{
  const double rho = std::pow(tolerance, -1.0 / (2 * n - 1));
  return 0.5 * (rho + 1 / rho);
}

SegmentForces &operator+=(SegmentForces &f, const SegmentForces &g)
{
  f.start += g.start;
  f.end += g.end;
  return f;
}

SegmentForces &operator-=(SegmentForces &f, const SegmentForces &g)
{
  f.start -= g.start;
  f.end -= g.end;
  return f;
}
} // namespace

MultipoleForces::MultipoleForces(const LineSystem &system_, const fmm::MultipoleSettings &settings,
                                 const double pair_tolerance_)
    : system(system_), pair_tolerance(std::min(pair_tolerance_, 0.1 * settings.tolerance)),
      n_gauss(n_points_for(tolerance_of_nearest(settings.tolerance))),
      near_distance(near_distance_for(tolerance_of_nearest(settings.tolerance), n_gauss)),
      closest_distance(near_distance_for(tolerance_of_nearest(settings.tolerance), n_gauss + 1))
{
  for (const StraightLine &l : system.lines())
    longest_panel += 2 * (l.end - l.start).norm() / static_cast<double>(system.lines().size());
}

MultipoleForces::MultipoleForces(const LineSystem &system_, const fmm::MultipoleSettings &settings,
                                 const double pair_tolerance_, MPI_Comm comm, const fmm::Part part)
    : MultipoleForces(system_, settings, pair_tolerance_)
{
  multipoles = std::make_shared<MultipoleField>(system, place_points(), settings);
  sum(multipoles->stress(comm, part, fmm::Recipient::owner), comm);
}

MultipoleForces::MultipoleForces(const LineSystem &system_, const fmm::MultipoleSettings &settings,
                                 const double pair_tolerance_, MPI_Comm comm, FarFieldCache &cache,
                                 const Network &network, PeriodicImages *const images)
    : MultipoleForces(system_, settings, pair_tolerance_)
{
  const std::vector<Vec3> at = place_points();
  FarFieldCache::Field field = cache.evaluate({system, network, at, settings, images, comm});
  multipoles = std::move(field.field);
  sum(std::move(field.stress), comm);
}

/// Gauss points of all panels.
std::vector<Vec3> MultipoleForces::place_points()
{
  const GaussRule rule = gauss_rule(n_gauss);
  const std::size_t n_lines = system.lines().size();
  std::vector<std::size_t> first{0};
  first.reserve(n_lines + 1);
  for (std::size_t i = 0; i < n_lines; ++i)
    first.push_back(first.back() + n_panels(i) * rule.points.size());
  points = PointsOfLines(std::move(first));
  std::vector<Vec3> places(points.n_points());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n_lines; ++i)
  {
    const StraightLine &line = system.lines()[i];
    std::size_t k = points.begin(i);
    for_each_panel(i,
                   [&](const Panel &p)
                   {
                     for (const double z : rule.points)
                       places[k++] = line.start + (p.begin + z * (p.end - p.begin)) * (line.end - line.start);
                   });
  }
  return places;
}

std::size_t MultipoleForces::n_panels(const std::size_t i) const
{
  const StraightLine &line = system.lines()[i];
  return static_cast<std::size_t>(std::max(1.0, std::ceil((line.end - line.start).norm() / longest_panel)));
}

template <class Visit> void MultipoleForces::for_each_panel(const std::size_t i, Visit &&visit) const
{
  const auto n = static_cast<double>(n_panels(i));
  for (double k = 0; k < n; ++k)
    visit(Panel{k / n, (k + 1) / n});
}

/// @p stress: at the points of this rank's leaves. What close sources add comes first, because it needs no stress.
void MultipoleForces::sum(std::vector<SymTensor> stress, MPI_Comm comm)
{
  line_shares = shares_by_first_point(points, multipoles->sum());
  StressExchange exchange(points, line_shares, multipoles->sum(), stress, comm);
  forces.assign(points.n_lines(), {Vec3::Zero(), Vec3::Zero()});
  multipoles->sum().learn_costs(replace_near());
  {
    const ThreadStopwatch watch(spent_besides.waiting);
    exchange.finish(stress);
  }
  spent_besides.n_stresses_sent = exchange.n_sent();
  const std::span<const std::uint32_t> own = line_shares.of(rank_of(comm).mine);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < own.size(); ++k)
    forces[own[k]] += quadrature(own[k], stress);
}

/// Leaf by leaf; returns the processor time of some of them, see fmm::WorkCosts, s.
std::vector<double> MultipoleForces::replace_near()
{
  const fmm::Octree &tree = multipoles->sum().octree();
  const std::span<const std::uint32_t> leaves = multipoles->sum().own_leaves();
  std::vector<double> seconds(leaves.size(), 0.0);
  const Stopwatch watch(spent_besides.close_pairs);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < leaves.size(); ++k)
    fmm::WorkCosts::measure(k, seconds[k], [&] { replace_near_in(tree.boxes()[leaves[k]]); });
  return seconds;
}

/// On the lines that begin in a leaf.
void MultipoleForces::replace_near_in(const fmm::Box &leaf)
{
  const fmm::Octree &tree = multipoles->sum().octree();
  const auto for_each_line = [&](auto &&visit)
  {
    for (const std::uint32_t point : std::span(tree.point_order()).subspan(leaf.points_begin, leaf.n_points()))
      if (const std::size_t i = points.line_of(point); points.begin(i) == point)
        visit(i);
  };
  double longest = 0;
  for_each_line(
      [&](const std::size_t i)
      {
        const double length = (system.lines()[i].end - system.lines()[i].start).norm();
        longest = std::max(longest, length / static_cast<double>(n_panels(i)));
      });
  // A little more than the largest half length, which is rounded otherwise.
  Surroundings around{{tree, leaf, 0.5 * (1 + 1e-9) * near_distance * longest}, {}};
  for_each_line([&](const std::size_t i)
                { for_each_panel(i, [&](const Panel &panel) { replace_near(i, panel, around, forces[i]); }); });
}

/// Peach-Koehler forces of the stress at the Gauss points of a line.
SegmentForces MultipoleForces::quadrature(const std::size_t i, const std::vector<SymTensor> &stress) const
{
  const StraightLine &line = system.lines()[i];
  const Vec3 t = line.end - line.start;
  const GaussRule rule = gauss_rule(n_gauss);
  SegmentForces f{Vec3::Zero(), Vec3::Zero()};
  std::size_t point = points.begin(i);
  for_each_panel(i,
                 [&](const Panel &panel)
                 {
                   for (std::size_t q = 0; q < rule.points.size(); ++q)
                   {
                     const double s = panel.begin + rule.points[q] * (panel.end - panel.begin);
                     const Vec3 df =
                         rule.weights[q] * (panel.end - panel.begin) * contract(stress[point++], line.burgers).cross(t);
                     f.start += (1 - s) * df;
                     f.end += s * df;
                   }
                 });
  return f;
}

void MultipoleForces::find_near_sources(const std::size_t i, const Vec3 &start, const Vec3 &end,
                                        Surroundings &around) const
{
  const fmm::MultipoleStress &sum = multipoles->sum();
  const fmm::Octree &tree = sum.octree();
  const Vec3 middle = 0.5 * (start + end);
  const double half = 0.5 * (end - start).norm(), reach = near_distance * half;
  const double closest = closest_distance * half;
  NearSources &near = around.near;
  near.closest.clear();
  near.others.clear();
  near.itself = no_line;
  around.lines.for_each(middle, reach,
                        [&](const std::uint32_t k, const std::size_t image)
                        {
                          const fmm::LineSource source = sum.line(k);
                          const Vec3 &shift = tree.image_shifts()[image];
                          const double squared =
                              distance_point_segment(middle, source.start + shift, source.end + shift).squared;
                          if (squared > reach * reach)
                            return;
                          // Of the images of the line itself, the one that the panel lies on.
                          if (tree.line_order()[k] == i && squared < 1e-12 * half * half)
                            near.itself = near.closest.size();
                          (squared < closest * closest ? near.closest : near.others).add_moved(sum.table(), k, shift);
                        });
}

void MultipoleForces::replace_near(const std::size_t i, const Panel &panel, Surroundings &around,
                                   SegmentForces &force) const
{
  const StraightLine &line = system.lines()[i];
  const Vec3 t = line.end - line.start, middle = line.start + 0.5 * (panel.begin + panel.end) * t;
  const Vec3 shift = system.cell() ? system.cell()->shift_into_cell(middle) : Vec3(Vec3::Zero());
  const Vec3 start = line.start + shift + panel.begin * t, end = line.start + shift + panel.end * t;
  find_near_sources(i, start, end, around);
  const NearSources &near = around.near;
  // What the sources should have added, and what they have added at the Gauss points. One point more suffices for most of them.
  const auto by_rule = [&](const LineTable &table, const int n)
  { return force_of_segments_by_rule(system.medium(), table, start, end, line.burgers, n); };
  SegmentForces f =
      force_of_segments(system.medium(), near.closest, start, end, line.burgers, pair_tolerance, near.itself);
  f += by_rule(near.others, n_gauss + 1);
  f -= by_rule(near.closest, n_gauss);
  f -= by_rule(near.others, n_gauss);
  // Linear shape functions of the panel's ends, in those of the line's.
  force.start += (1 - panel.begin) * f.start + (1 - panel.end) * f.end;
  force.end += panel.begin * f.start + panel.end * f.end;
}
} // namespace ddfem
