// The tractions of a closed network (real lines and virtual rays) over the closed surface have no net force and no net moment: those
// of the infinite field, and those of the infinite field with the analytic images of near lines.
#include "coupling/finite_grain.h"
#include "support.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
coupling::GrainParameters grain_parameters(const bool round, const double image_depth)
{
  coupling::GrainParameters p;
  p.image_depth = image_depth;
  p.mesh.shape = round ? fem::MeshParameters::Shape::cylinder : fem::MeshParameters::Shape::box;
  p.mesh.size = {250, 250, 250}; // 1000 b
  p.mesh.radius = 125;
  p.mesh.height = 250;
  p.mesh.origin = round ? std::array<double, 3>{125, 125, 0} : std::array<double, 3>{0, 0, 0};
  p.mesh.subdivisions = {4, 4, 4};
  p.elasticity.traction_tolerance = 1e-8;
  return p;
}

void check(Report &report, const std::string &name, const Network &network, const bool round, const RayDirection rule,
           const double image_depth)
{
  auto p = grain_parameters(round, image_depth);
  p.ray_direction = rule;
  coupling::FiniteGrain grain(p, medium(), MPI_COMM_WORLD);
  const LineSystem lines(medium(), network, &grain.shape(), rule, nullptr, nullptr);
  const auto solution = grain.solve(lines, 0.0);
  report.below(name + ": net force / sum of magnitudes", solution.force_imbalance, 1e-6);
  report.below(name + ": net moment / sum of magnitudes", solution.moment_imbalance, 1e-6);
}

/// A line between two surface points of the cube, in four pieces.
Network line_between(const Vec3 &p, const Vec3 &q, const Vec3 &b)
{
  Network network;
  add_line(network, {p, 0.75 * p + 0.25 * q, 0.5 * (p + q), 0.25 * p + 0.75 * q, q}, b, {}, false,
           NodeConstraint::surface);
  return network;
}

/// Lines that end where images of several faces meet, in a box whose faces at z = 0 and z = 250 are held. The ends of lines are
/// cores and legs on the scale of the core radius (0.25 nm).
void check_images(Report &report)
{
  const Vec3 edge(0.25, 0, 0), mixed(0.1, -0.15, 0.2);
  const std::vector<std::pair<std::string, Network>> cases{
      {"side to side, mixed", line_between(Vec3(0, 100, 120), Vec3(250, 140, 130), mixed)},
      {"side to side, screw", line_between(Vec3(0, 100, 120), Vec3(250, 100, 120), edge)},
      {"side to platen", line_between(Vec3(0, 110, 140), Vec3(120, 125, 250), mixed)},
      {"5 from a free edge", line_between(Vec3(0, 5, 120), Vec3(250, 140, 130), mixed)},
      {"1 from a free edge", line_between(Vec3(0, 1, 120), Vec3(250, 140, 130), mixed)},
      {"in a free edge", line_between(Vec3(0, 0, 120), Vec3(250, 140, 130), mixed)},
      {"1 from the edge of a platen", line_between(Vec3(0, 110, 249), Vec3(250, 140, 130), mixed)},
      {"in the edge of a platen", line_between(Vec3(0, 110, 250), Vec3(250, 140, 130), mixed)},
      {"along a free face, 0.5 deep", line_between(Vec3(0.5, 0, 120), Vec3(0.5, 250, 120), mixed)},
      {"through the platens, 1 from a side", line_between(Vec3(1, 110, 0), Vec3(1, 110, 250), mixed)}};
  for (const auto &[name, network] : cases)
    check(report, "images, " + name, network, false, RayDirection::normal, 4);
  check(report, "images, 1 from a free edge, radial rays", cases[4].second, false, RayDirection::radial, 4);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               const Vec3 centre(125, 125, 125), screw(0, 0, 0.25), edge(0.25, 0, 0);
               Network loop, prismatic, half;
               add_loop(loop, centre + Vec3(20, -10, 30), Vec3(1, 2, 3).normalized(), 60, edge);
               add_loop(prismatic, centre + Vec3(0, 0, 90), Vec3::UnitZ(), 40, screw);
               const Vec3 bottom(131, 122, 0), top(131, 122, 250);
               const Network threading_edge = line_between(bottom, top, edge),
                             threading_screw = line_between(bottom, top, screw);
               add_half_loop(half, Vec3(120, 110, 250), Vec3::UnitX(), Vec3::UnitZ(), 50, edge);
               for (const bool round : {false, true})
               {
                 const std::string body = round ? "cylinder, " : "box, ";
                 const auto normal = RayDirection::normal;
                 check(report, body + "glide loop", loop, round, normal, 0);
                 check(report, body + "prismatic loop near the end face", prismatic, round, normal, 0);
                 check(report, body + "threading edge", threading_edge, round, normal, 0);
                 check(report, body + "threading screw", threading_screw, round, normal, 0);
                 check(report, body + "surface half loop", half, round, normal, 0);
               }
               check(report, "box, surface half loop, radial rays", half, false, RayDirection::radial, 0);
               check_images(report);
             });
}
