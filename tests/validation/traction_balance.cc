// The tractions of the infinite field of a closed network (real lines and virtual rays) over the closed surface have no net
// force and no net moment.
#include "coupling/finite_grain.h"
#include "support.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
coupling::GrainParameters grain_parameters(const bool round)
{
  coupling::GrainParameters p;
  p.image_depth = 0; // the balance is that of the infinite field
  p.mesh.shape = round ? fem::MeshParameters::Shape::cylinder : fem::MeshParameters::Shape::box;
  p.mesh.size = {250, 250, 250}; // 1000 b
  p.mesh.radius = 125;
  p.mesh.height = 250;
  p.mesh.origin = round ? std::array<double, 3>{125, 125, 0} : std::array<double, 3>{0, 0, 0};
  p.mesh.subdivisions = {4, 4, 4};
  p.elasticity.traction_tolerance = 1e-8;
  return p;
}

void check(Report &report, const std::string &name, const Network &network, const bool round, const RayDirection rule)
{
  auto p = grain_parameters(round);
  p.ray_direction = rule;
  coupling::FiniteGrain grain(p, medium(), MPI_COMM_WORLD);
  const LineSystem lines(medium(), network, &grain.shape(), rule, nullptr, nullptr);
  const auto solution = grain.solve(lines, 0.0);
  report.below(name + ": net force / sum of magnitudes", solution.force_imbalance, 1e-6);
  report.below(name + ": net moment / sum of magnitudes", solution.moment_imbalance, 1e-6);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               const Vec3 centre(125, 125, 125), screw(0, 0, 0.25), edge(0.25, 0, 0);
               Network loop, prismatic, threading_edge, threading_screw, half;
               add_loop(loop, centre + Vec3(20, -10, 30), Vec3(1, 2, 3).normalized(), 60, edge);
               add_loop(prismatic, centre + Vec3(0, 0, 90), Vec3::UnitZ(), 40, screw);
               const std::vector<Vec3> thread{Vec3(131, 122, 0), Vec3(131, 122, 250)};
               add_line(threading_edge, thread, edge, {}, false, NodeConstraint::surface);
               add_line(threading_screw, thread, screw, {}, false, NodeConstraint::surface);
               add_half_loop(half, Vec3(120, 110, 250), Vec3::UnitX(), Vec3::UnitZ(), 50, edge);
               for (const bool round : {false, true})
               {
                 const std::string body = round ? "cylinder, " : "box, ";
                 check(report, body + "glide loop", loop, round, RayDirection::normal);
                 check(report, body + "prismatic loop near the end face", prismatic, round, RayDirection::normal);
                 check(report, body + "threading edge", threading_edge, round, RayDirection::normal);
                 check(report, body + "threading screw", threading_screw, round, RayDirection::normal);
                 check(report, body + "surface half loop", half, round, RayDirection::normal);
               }
               check(report, "box, surface half loop, radial rays", half, false, RayDirection::radial);
             });
}
