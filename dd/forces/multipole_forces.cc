#include "dd/elasticity/distance.h"
#include "dd/elasticity/gauss.h"
#include "dd/elasticity/vectorised/force_kernels.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/multipole_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ddfem
{
namespace
{
/// Sources nearer than this many half lengths to the middle of a panel are replaced, at most; the number of Gauss points follows.
constexpr double largest_near_distance = 8;
/// What rho^-(2n-1) of the nearest sources that are not replaced must be, for a requested error relative to the far force. The error
/// was measured (benchmarks/accuracy.cc) as 1.4 times that at 1e-3 and up to 9 times at 1e-6, where boxes are larger and less of the force
/// is far; the rest is margin.
double tolerance_of_nearest(const double tolerance)
{
  return tolerance / (3.5 * std::pow(1e-3 / tolerance, 0.2));
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
  stress = multipoles->stress(comm, part);
}

MultipoleForces::MultipoleForces(const LineSystem &system_, const fmm::MultipoleSettings &settings,
                                 const double pair_tolerance_, MPI_Comm comm, FarFieldCache &cache,
                                 const Network &network, PeriodicImages *const images)
    : MultipoleForces(system_, settings, pair_tolerance_)
{
  const std::vector<Vec3> points = place_points();
  FarFieldCache::Field field = cache.evaluate({system, network, points, settings, images, comm});
  multipoles = std::move(field.field);
  stress = std::move(field.stress);
}

/// Gauss points of all panels.
std::vector<Vec3> MultipoleForces::place_points()
{
  const GaussRule rule = gauss_rule(n_gauss);
  std::size_t n_points = 0;
  first_point.reserve(system.lines().size());
  for (const StraightLine &line : system.lines())
  {
    first_point.push_back(static_cast<std::uint32_t>(n_points));
    n_points += n_panels(line) * rule.points.size();
  }
  std::vector<Vec3> points;
  points.reserve(n_points);
  for (std::size_t i = 0; i < system.lines().size(); ++i)
  {
    const StraightLine &line = system.lines()[i];
    for (const Panel &p : panels_of(i))
      for (const double z : rule.points)
        points.emplace_back(line.start + (p.begin + z * (p.end - p.begin)) * (line.end - line.start));
  }
  return points;
}

std::size_t MultipoleForces::n_panels(const StraightLine &line) const
{
  return static_cast<std::size_t>(std::max(1.0, std::ceil((line.end - line.start).norm() / longest_panel)));
}

std::vector<MultipoleForces::Panel> MultipoleForces::panels_of(const std::size_t i) const
{
  const auto n = static_cast<double>(n_panels(system.lines()[i]));
  std::vector<Panel> panels;
  for (double k = 0; k < n; ++k)
    panels.push_back({k / n, (k + 1) / n});
  return panels;
}

/// Peach-Koehler forces of the stress at the Gauss points of a panel on the ends of its line.
template <class Stress>
SegmentForces MultipoleForces::quadrature(const StraightLine &line, const Panel &panel, Stress &&stress_at) const
{
  const Vec3 t = line.end - line.start;
  const GaussRule rule = gauss_rule(n_gauss);
  SegmentForces f;
  for (std::size_t q = 0; q < rule.points.size(); ++q)
  {
    const double s = panel.begin + rule.points[q] * (panel.end - panel.begin);
    const Vec3 df = rule.weights[q] * (panel.end - panel.begin) * contract(stress_at(q), line.burgers).cross(t);
    f.start += (1 - s) * df;
    f.end += s * df;
  }
  return f;
}

SegmentForces MultipoleForces::operator()(const std::size_t i) const
{
  SegmentForces sum;
  std::size_t point = first_point[i];
  for (const Panel &panel : panels_of(i))
  {
    sum += panel_force(i, panel, point);
    point += static_cast<std::size_t>(n_gauss);
  }
  return sum;
}

SegmentForces MultipoleForces::panel_force(const std::size_t i, const Panel &panel, const std::size_t first) const
{
  SegmentForces force =
      quadrature(system.lines()[i], panel, [&](std::size_t q) -> const SymTensor & { return stress[first + q]; });
  replace_near(i, panel, force);
  return force;
}

MultipoleForces::NearSources MultipoleForces::near_sources(const std::size_t i, const Vec3 &start,
                                                           const Vec3 &end) const
{
  const fmm::MultipoleStress &sum = multipoles->sum();
  const fmm::Octree &tree = sum.octree();
  const Vec3 middle = 0.5 * (start + end);
  const double half = 0.5 * (end - start).norm(), reach = near_distance * half;
  const double closest = closest_distance * half;
  NearSources near;
  near.closest.reserve(2 * LineTable::block_size); // most panels have fewer
  near.others.reserve(8 * LineTable::block_size);
  tree.for_each_line_near(middle, reach,
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
  return near;
}

void MultipoleForces::replace_near(const std::size_t i, const Panel &panel, SegmentForces &force) const
{
  const StraightLine &line = system.lines()[i];
  const Vec3 t = line.end - line.start, middle = line.start + 0.5 * (panel.begin + panel.end) * t;
  const Vec3 shift = system.cell() ? system.cell()->shift_into_cell(middle) : Vec3(Vec3::Zero());
  const Vec3 start = line.start + shift + panel.begin * t, end = line.start + shift + panel.end * t;
  const NearSources near = near_sources(i, start, end);
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
