#include "dd/elasticity/distance.h"
#include "dd/elasticity/gauss.h"
#include "dd/elasticity/vectorised/force_kernels.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/forces/multipole_field.h"

#include <algorithm>
#include <cmath>

namespace ddfem
{
namespace
{
/// Sources nearer than this many half lengths of a panel are replaced, at most; the number of Gauss points follows.
constexpr double largest_near_distance = 6.5;
/// Error of quadrature, relative to the far force, over rho^-(2n-1) of the nearest sources that are not replaced: measured 2 to 4
/// in networks whose total force is 5 to 50 times the far one, 11 where it is 90 times.
constexpr double near_to_far = 20;

double bernstein_radius(const double distance)
{
  return distance + std::sqrt(1 + distance * distance);
}

int n_points_for(const double tolerance)
{
  const double power = -std::log(tolerance) / std::log(bernstein_radius(largest_near_distance));
  return std::max(1, static_cast<int>(std::ceil(0.5 * (power + 1))));
}

/// Distance, in half lengths, from which @p n points reach the tolerance.
double near_distance_for(const double tolerance, const int n)
{
  const double rho = std::pow(tolerance, -1.0 / (2 * n - 1));
  return 0.5 * (rho - 1 / rho);
}

SegmentForces &operator+=(SegmentForces &f, const SegmentForces &g)
{
  f.start += g.start;
  f.end += g.end;
  return f;
}
} // namespace

MultipoleForces::MultipoleForces(const LineSystem &system_, const fmm::MultipoleSettings &settings,
                                 const double pair_tolerance_, MPI_Comm comm)
    : system(system_), pair_tolerance(std::min(pair_tolerance_, 0.1 * settings.tolerance)),
      n_gauss(n_points_for(settings.tolerance / near_to_far)),
      near_distance(near_distance_for(settings.tolerance / near_to_far, n_gauss))
{
  for (const StraightLine &l : system.lines())
    longest_panel += 2 * (l.end - l.start).norm() / static_cast<double>(system.lines().size());
  const GaussRule rule = gauss_rule(n_gauss);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < system.lines().size(); ++i)
  {
    first_point.push_back(points.size());
    const StraightLine &line = system.lines()[i];
    for (const Panel &p : panels_of(i))
      for (const double z : rule.points)
        points.emplace_back(line.start + (p.begin + z * (p.end - p.begin)) * (line.end - line.start));
  }
  multipoles = std::make_unique<MultipoleField>(system, points, settings);
  stress = multipoles->stress(comm);
}

std::vector<MultipoleForces::Panel> MultipoleForces::panels_of(const std::size_t i) const
{
  const StraightLine &line = system.lines()[i];
  const double n = std::max(1.0, std::ceil((line.end - line.start).norm() / longest_panel));
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
  const fmm::Octree &tree = multipoles->sum().octree();
  const Vec3 middle = 0.5 * (start + end);
  const double half = 0.5 * (end - start).norm(), reach = near_distance * half;
  NearSources near;
  tree.for_each_line_near(
      middle, reach + half,
      [&](const std::uint32_t k, const std::size_t image)
      {
        const fmm::LineSource &source = multipoles->sum().lines()[k];
        const Vec3 x1 = source.start + tree.image_shifts()[image], x2 = source.end + tree.image_shifts()[image];
        if (distance_segment_segment(x1, x2, start, end).squared > reach * reach)
          return;
        // Of the images of the line itself, the one that the panel lies on.
        if (tree.line_order()[k] == i && distance_point_segment(middle, x1, x2).squared < 1e-12 * half * half)
          near.itself = near.table.size();
        near.table.add_segment(x1, x2, source.burgers);
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
  // What the sources have added at the Gauss points, and what they should have added.
  const GaussRule rule = gauss_rule(n_gauss);
  StressBuffer added(rule.points.size());
  for (std::size_t q = 0; q < rule.points.size(); ++q)
    added.set_point(q, Vec3(start + rule.points[q] * (end - start)));
  add_segment_stress(system.medium(), near.table, added.batch());
  const SegmentForces wrong = quadrature(line, panel, [&](std::size_t q) { return SymTensor(added.value(q)); });
  const SegmentForces exact =
      force_of_segments(system.medium(), near.table, start, end, line.burgers, pair_tolerance, near.itself);
  // Linear shape functions of the panel's ends, in those of the line's.
  force.start += (1 - panel.begin) * exact.start + (1 - panel.end) * exact.end - wrong.start;
  force.end += panel.begin * exact.start + panel.end * exact.end - wrong.end;
}
} // namespace ddfem
