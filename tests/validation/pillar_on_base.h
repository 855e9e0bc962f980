// Lines that move in a tapered pillar on its base with a fillet, which is re-entrant, continued outside in three ways.
#pragma once

#include "coupling/finite_grain.h"
#include "dd/forces/virtual_rays.h"
#include "image_field.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace ddfem::validation
{
/// Cells across the pillar, through its base, and along it.
using PillarMesh = std::array<unsigned, 3>;

inline coupling::GrainParameters grain_parameters(const PillarMesh &cells, const unsigned degree)
{
  coupling::GrainParameters p;
  p.mesh.shape = fem::MeshParameters::Shape::pillar;
  p.mesh.pillar = {60, 200, 0.05, 25, 240, 80};
  p.mesh.subdivisions = cells;
  p.elasticity.degree = degree;
  p.elasticity.traction_tolerance = 1e-8;
  p.elasticity.relative_tolerance = 1e-10; // of the load of the lines, of which their motion changes a part
  p.clamped = false;
  return p;
}

/// How lines are continued outside: by the rule of the rays, or at 45 degrees to the axis, away from it and upwards.
enum class Closure
{
  normal,
  radial,
  tilted
};

inline const Vec3 burgers(0.15, 0, 0.2);

/// A line before and after it has moved.
struct Move
{
  std::string name;
  std::vector<Vec3> before, after;
};

struct Outcome
{
  coupling::GrainSolution solution;
  std::vector<SymTensor> stress; ///< total
};

inline Vec3 tilted_at(const Vec3 &end)
{
  return (Vec3(end[0], end[1], 0).normalized() + Vec3::UnitZ()).normalized();
}

/// The line with surface nodes at its ends, or closed 0.01 m away.
inline Network network_of(std::vector<Vec3> points, const Vec3 &from_start, const Vec3 &from_end, const Closure closure)
{
  constexpr double far = 1e7;
  Network network;
  if (closure == Closure::tilted)
  {
    const Vec3 first = points.front(), last = points.back();
    points.push_back(last + far * from_end);
    points.push_back(first + far * from_start);
  }
  add_line(network, points, burgers, {}, closure == Closure::tilted,
           closure == Closure::tilted ? NodeConstraint::free : NodeConstraint::surface);
  return network;
}

/// What the move sweeps, with the continuations.
inline SweptArea swept_by(const Move &m, const std::function<Vec3(const Vec3 &, bool at_start)> &direction)
{
  SweptArea area;
  for (std::size_t i = 0; i + 1 < m.before.size(); ++i)
  {
    area.add_triangle(m.before[i], m.after[i], m.after[i + 1], burgers, {});
    area.add_triangle(m.before[i], m.after[i + 1], m.before[i + 1], burgers, {});
  }
  const auto end = [&](const Vec3 &from, const Vec3 &to, const bool at_start)
  {
    area.add_ray_motion(from, direction(from, at_start), to, direction(to, at_start), at_start ? -burgers : burgers,
                        {});
  };
  end(m.before.back(), m.after.back(), false);
  end(m.before.front(), m.after.front(), true);
  return area;
}

/// The grain relaxed with the line in its first place, which then moves between platens at rest.
inline Outcome solve(const Move &m, const Closure closure, const PillarMesh &cells, const unsigned degree)
{
  auto p = grain_parameters(cells, degree);
  const RayDirection rule = closure == Closure::radial ? RayDirection::radial : RayDirection::normal;
  p.ray_direction = rule;
  coupling::FiniteGrain grain(p, medium(), MPI_COMM_WORLD);
  const Vec3 tilted_start = tilted_at(m.after.front()), tilted_end = tilted_at(m.after.back());
  const auto direction = [&](const Vec3 &x, const bool at_start) {
    return closure != Closure::tilted ? ray_direction(grain.shape(), rule, x) : at_start ? tilted_start : tilted_end;
  };
  const auto lines = [&](const Network &network)
  { return LineSystem(medium(), network, &grain.shape(), rule, nullptr, nullptr); };
  const Network before = network_of(m.before, tilted_start, tilted_end, closure),
                after = network_of(m.after, tilted_start, tilted_end, closure);
  grain.set_reference(before, lines(before));
  grain.add_swept(swept_by(m, direction));
  const LineSystem sources = lines(after);
  Outcome result{grain.solve(sources, 0.0), {}};
  // Away from the lines, whose own stress would hide that of the continuations.
  const std::vector<Vec3> points{Vec3(0, 0, 40), Vec3(0, 0, 120), Vec3(20, 0, 200), Vec3(0, -40, 60),
                                 Vec3(-50, -30, 40)};
  result.stress = grain.correction_stress(points);
  for (std::size_t k = 0; k < points.size(); ++k)
    result.stress[k] += sources.stress(points[k]);
  return result;
}

/// From side to side of the pillar, its rays over the base; from the fillet to the base's top; around the pillar's foot, with both
/// ends on the base.
inline std::vector<Move> moves()
{
  const fem::PillarGeometry g = grain_parameters({4, 2, 5}, 2).mesh.pillar;
  const auto side = [&](const double angle, const double z)
  {
    const double r = g.radius_at(z);
    return Vec3(r * std::cos(angle), r * std::sin(angle), g.base_height + z);
  };
  const auto straight = [](const Vec3 &p, const Vec3 &q) { return std::vector<Vec3>{p, 0.5 * (p + q), q}; };
  const double top = g.base_height;
  return {{"line across the pillar", straight(side(0.3, 80), side(3.5, 40)), straight(side(0.3, 100), side(3.5, 60))},
          {"line from the fillet to the base",
           {side(1.0, 15), Vec3(30, 45, 55), Vec3(50, 70, 55), Vec3(65, 90, top)},
           {side(1.0, 10), Vec3(30, 50, 50), Vec3(55, 80, 45), Vec3(75, 95, top)}},
          {"line under the pillar",
           {Vec3(-95, 5, top), Vec3(-60, 0, 45), Vec3(0, 0, 40), Vec3(60, -10, 45), Vec3(95, -20, top)},
           {Vec3(-100, 5, top), Vec3(-60, 0, 35), Vec3(0, 0, 25), Vec3(60, -10, 35), Vec3(100, -20, top)}}};
}

struct Difference
{
  double force = 0, stress = 0;
};

inline Difference difference(const Outcome &a, const Outcome &reference)
{
  Difference d{std::abs(a.solution.platen_reaction / reference.solution.platen_reaction - 1), 0};
  for (std::size_t k = 0; k < a.stress.size(); ++k)
    d.stress = std::max(d.stress, (a.stress[k] - reference.stress[k]).norm() / reference.stress[k].norm());
  return d;
}

/// Balances of one solve.
inline void check_balance(Report &report, const std::string &name, const Outcome &o)
{
  // What the quadrature is asked for, of a sum of a few hundred faces.
  report.below(name + ": net force / sum of magnitudes", o.solution.force_imbalance, 1e-8);
  report.below(name + ": net moment / sum of magnitudes", o.solution.moment_imbalance, 1e-8);
  report.below(name + ": difference of the reactions at both ends",
               o.solution.platen_reaction / o.solution.fixed_reaction - 1, 1e-5);
}
} // namespace ddfem::validation
