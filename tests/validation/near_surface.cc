// Image forces near a free surface, from ten elements deep to a fifth of an element: straight edge and screw along the surface
// (F/L = mu b^2/(4 pi (1-nu) d), mu b^2/(4 pi d)), and triangular loops (tests/data/halfspace_loops.json), with the
// analytic images of the lines under the face and without.
#include "coupling/parameters.h"
#include "image_field.h"
#include "reference_loops.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
const std::vector<ImagePlane> top{{4, Vec3::Zero(), -Vec3::UnitZ()}};

/// Relative error of the force on a line along y at depth @p d, element size 1. A line that goes on as it is beyond y- and y+ sees
/// plane strain if these are held along y, antiplane shear if they are held across it.
double force_error(const Mesh &mesh, const unsigned degree, const double d, const bool screw, const double image_depth)
{
  const IsotropicMedium m{50e3, 0.3, 0.01};
  const double b = 0.25, half = 4000;
  Network network;
  const Vec3 burgers = screw ? Vec3(0, b, 0) : Vec3(b, 0, 0);
  add_line(network, {Vec3(0, -half, d), Vec3(0, half, d)}, burgers, {}, false, NodeConstraint::pinned);
  const LineSystem lines(m, network, nullptr, RayDirection::normal, nullptr, nullptr);
  const std::array<bool, 3> held{screw, !screw, screw};
  ImageField image(mesh, degree, {{2, held}, {3, held}}, m);
  image.solve(lines, {}, top, image_depth);
  const Vec3 force = image.force_per_length(Vec3(0, 0, d), Vec3::UnitY(), burgers);
  const double exact = -m.mu * b * b / (4 * M_PI * d) / (screw ? 1 : 1 - m.nu); // towards the surface
  return force[2] / exact - 1;
}

void straight_lines(Report &report, const double image_depth, const unsigned degree, const bool print_only)
{
  const auto half = graded(1, 4, 300), depth = graded(1, 12, 1000);
  const double width = std::accumulate(half.begin(), half.end(), 0.0);
  const auto mesh = box_mesh({mirrored(half), {4}, depth}, Vec3(-width, -2, 0));
  for (const bool screw : {true, false})
    for (const double d : print_only ? std::vector<double>{10.0, 7.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.5, 0.2}
                                     : std::vector<double>{10.0, 4.0, 1.0, 0.2})
    {
      const double error = force_error(*mesh, degree, d, screw, image_depth);
      char row[120];
      std::snprintf(row, sizeof row, "%s at depth %4.1f h, degree %u, images within %3.1f h: error of its image force",
                    screw ? "screw" : "edge ", d, degree, image_depth);
      if (print_only)
      {
        char value[200];
        std::snprintf(value, sizeof value, "%-72s %9.3f %%", row, 100 * error);
        report.note(value);
      }
      else
        report.below(row, error, 0.02);
    }
}

/// Largest error of a component at all points of a reference loop, relative to the largest image component, element size @p h.
double loop_error(const ReferenceLoop &loop, const Mesh &mesh, const double image_depth)
{
  const IsotropicMedium m{loop.mu, loop.nu, 1e-3};
  const LineSystem lines(m, loop.network, nullptr, RayDirection::normal, nullptr, nullptr);
  ImageField image(mesh, 2, {}, m);
  image.solve(lines, {}, top, image_depth);
  return largest_error(image.stress(loop.points), loop.image_stress);
}

void loops(Report &report, const double image_depth)
{
  const auto reference = reference_loops();
  // Loops at depths of 2 to 3.5: half an element and more where elements are 4 long.
  const double h = 4;
  const auto mesh = half_space_mesh(h, 3 * h);
  for (std::size_t k = 0; k < reference.size(); ++k)
  {
    char row[120];
    std::snprintf(row, sizeof row, "loop %zu, elements of %3.1f, images within %3.1f h: error at all points", k, h,
                  image_depth);
    report.below(row, loop_error(reference[k], *mesh, image_depth * h), 0.02);
  }
}
} // namespace

int main(int argc, char **argv)
{
  const bool study = study_requested(argc, argv); // with and without images
  return run(argc, argv,
             [&](Report &report)
             {
               const double depth = coupling::GrainParameters{}.image_depth;
               if (study)
                 for (const unsigned degree : {1U, 2U})
                   for (const double within : {0.0, depth})
                     straight_lines(report, within, degree, true);
               else
                 straight_lines(report, depth, 2, false);
               loops(report, depth);
             });
}
