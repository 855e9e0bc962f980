// A tapered pillar on its base with a fillet, which is re-entrant: the tractions of the infinite field have no net force and no net
// moment, with rays along the normal and with radial ones, and the reactions at both ends are the same.
#include "coupling/finite_grain.h"
#include "support.h"

#include <vector>

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
coupling::GrainParameters grain_parameters()
{
  coupling::GrainParameters p;
  p.mesh.shape = fem::MeshParameters::Shape::pillar;
  p.mesh.pillar = {60, 200, 0.05, 25, 240, 80};
  p.mesh.subdivisions = {4, 2, 5};
  p.elasticity.traction_tolerance = 1e-8;
  p.clamped = false;
  p.reference = coupling::ReferenceState::perfect_crystal;
  return p;
}

coupling::GrainSolution solve(const Network &network, const RayDirection rule)
{
  auto p = grain_parameters();
  p.ray_direction = rule;
  coupling::FiniteGrain grain(p, medium(), MPI_COMM_WORLD);
  const LineSystem lines(medium(), network, &grain.shape(), rule, nullptr, nullptr);
  grain.set_reference(network, lines);
  return grain.solve(lines, 0.0);
}

void check(Report &report, const std::string &name, const Network &network)
{
  const auto normal = solve(network, RayDirection::normal), radial = solve(network, RayDirection::radial);
  // What the quadrature is asked for, of a sum of a few hundred faces.
  report.below(name + ": net force / sum of magnitudes", normal.force_imbalance, 1e-8);
  report.below(name + ": net moment / sum of magnitudes", normal.moment_imbalance, 1e-8);
  report.below(name + ", radial rays: net force", radial.force_imbalance, 1e-8);
  report.below(name + ", radial rays: net moment", radial.moment_imbalance, 1e-8);
  report.below(name + ": difference of the reactions at both ends", normal.platen_reaction / normal.fixed_reaction - 1,
               1e-5);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               const coupling::GrainParameters p = grain_parameters();
               const fem::PillarGeometry &g = p.mesh.pillar;
               const Vec3 b(0.15, 0, 0.2);
               const auto side = [&](const double angle, const double z)
               {
                 const double r = g.radius_at(z);
                 return Vec3(r * std::cos(angle), r * std::sin(angle), g.base_height + z);
               };
               // From side to side of the pillar, its rays over the base; from the fillet to the base's top; a half loop around
               // the pillar's foot, with both ends on the base.
               Network across, foot, base;
               const Vec3 p0 = side(0.3, 100), p1 = side(3.5, 60);
               add_line(across, {p0, 0.5 * (p0 + p1), p1}, b, {}, false, NodeConstraint::surface);
               check(report, "line across the pillar", across);
               const Vec3 q0 = side(1.0, 10), q1(75, 95, g.base_height);
               add_line(foot, {q0, Vec3(30, 50, 50), Vec3(55, 80, 45), q1}, b, {}, false, NodeConstraint::surface);
               check(report, "line from the fillet to the base", foot);
               const Vec3 r0(-100, 5, g.base_height), r1(100, -20, g.base_height);
               add_line(base, {r0, Vec3(-60, 0, 35), Vec3(0, 0, 25), Vec3(60, -10, 35), r1}, b, {}, false,
                        NodeConstraint::surface);
               check(report, "line under the pillar", base);
             });
}
