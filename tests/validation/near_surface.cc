// Image forces near a free surface, from ten elements deep to a fifth of an element: straight edge and screw along the surface
// (F/L = mu b^2/(4 pi (1-nu) d), mu b^2/(4 pi d)), and triangular loops (tests/data/halfspace_loops.json), with the
// analytic images of the lines under the face and without.
#include "coupling/parameters.h"
#include "image_field.h"
#include "reference_loops.h"

#include <chrono>
#include <span>

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
const std::vector<ImagePlane> top{{4, Vec3::Zero(), -Vec3::UnitZ()}};

/// What the force on a line costs and how good it is.
struct Measured
{
  double error;          ///< relative
  double setup, seconds; ///< wall time: mesh, matrix and preconditioner; images, tractions, solve and stress
  std::uint64_t n_unknowns;
};

/// Relative error of the force on a line along y at depth @p d. A line that goes on as it is beyond y- and y+ sees plane strain if
/// these are held along y, antiplane shear if they are held across it.
Measured measure_force(const std::vector<std::vector<double>> &sizes, const unsigned degree, const double d,
                       const bool screw, const double image_depth)
{
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](const Clock::time_point from, const Clock::time_point to)
  { return std::chrono::duration<double>(to - from).count(); };
  const IsotropicMedium m{50e3, 0.3, 0.01};
  const double b = 0.25, half = 4000;
  Network network;
  const Vec3 burgers = screw ? Vec3(0, b, 0) : Vec3(b, 0, 0);
  add_line(network, {Vec3(0, -half, d), Vec3(0, half, d)}, burgers, {}, false, NodeConstraint::pinned);
  const LineSystem lines(m, network, nullptr, RayDirection::normal, nullptr, nullptr);
  const std::array<bool, 3> held{screw, !screw, screw};
  const double width = std::accumulate(sizes[0].begin(), sizes[0].end(), 0.0),
               length = std::accumulate(sizes[1].begin(), sizes[1].end(), 0.0);
  const auto start = Clock::now();
  const auto mesh = box_mesh(sizes, Vec3(-width / 2, -length / 2, 0));
  ImageField image(*mesh, degree, {{2, held}, {3, held}}, m);
  const auto ready = Clock::now();
  image.solve(lines, {}, top, image_depth);
  const Vec3 force = image.force_per_length(Vec3(0, 0, d), Vec3::UnitY(), burgers);
  const double exact = -m.mu * b * b / (4 * M_PI * d) / (screw ? 1 : 1 - m.nu); // towards the surface
  return {force[2] / exact - 1, seconds(start, ready), seconds(ready, Clock::now()), image.elastic_problem().n_dofs()};
}

void straight_lines(Report &report, const double image_depth, const unsigned degree, const bool print_only)
{
  const std::vector<std::vector<double>> sizes{mirrored(graded(1, 4, 300)), {4}, graded(1, 12, 1000)};
  for (const bool screw : {true, false})
    for (const double d : print_only ? std::vector<double>{10.0, 7.0, 5.0, 4.0, 3.5, 3.0, 2.0, 1.0, 0.5, 0.2}
                                     : std::vector<double>{10.0, 4.0, 1.0, 0.2})
    {
      const double error = measure_force(sizes, degree, d, screw, image_depth).error;
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

/// Relative error of the force on a line at the depth 1 by the elements alone, of size @p h. Around the line and its surface lies what
/// is left of the half-space, which holds the other faces where the analytic images say.
double error_of_elements(const double h, const unsigned degree, const bool screw)
{
  const IsotropicMedium m{50e3, 0.3, 0.01};
  const double b = 0.25, end = 4e5, half_width = 3, depth = 4;
  Network network;
  const Vec3 burgers = screw ? Vec3(0, b, 0) : Vec3(b, 0, 0);
  add_line(network, {Vec3(0, -end, 1), Vec3(0, end, 1)}, burgers, {}, false, NodeConstraint::pinned);
  const LineSystem lines(m, network, nullptr, RayDirection::normal, nullptr, nullptr);
  const auto cells = [h](const double length)
  { return std::vector<double>(static_cast<std::size_t>(std::lround(length / h)), h); };
  const auto mesh = box_mesh({cells(2 * half_width), {h, h}, cells(depth)}, Vec3(-half_width, -h, 0));
  std::vector<fem::DisplacementCondition> held;
  for (const unsigned face : {0U, 1U, 2U, 3U, 5U}) // not z-
    held.push_back({face, {true, true, true}});
  const SurfaceImages exact(lines, top, {2.0, 1e-8});
  ImageField image(*mesh, degree, held, m);
  image.solve(lines, [&](const Vec3 &x) { return exact.displacement(std::span(&x, 1))[0]; });
  const Vec3 force = image.force_per_length(Vec3(0, 0, 1), Vec3::UnitY(), burgers);
  return force[2] / (-m.mu * b * b / (4 * M_PI) / (screw ? 1 : 1 - m.nu)) - 1; // the depth is 1
}

void print_convergence(const Report &report)
{
  for (const bool screw : {true, false})
  {
    const ConvergenceStudy study(report, screw ? "screw_under_surface" : "edge_under_surface");
    for (const unsigned degree : {1U, 2U})
      for (const double parts : {2.0, 3.0, 4.0, 6.0, 8.0, 12.0})
        if (degree == 1 || parts < 12)
          study.add(degree, 1 / parts, error_of_elements(1 / parts, degree, screw));
  }
}

/// Element sizes from a line outwards: @p finest up to twice its depth, then twice as wide each up to 1, which is kept up to
/// @p coarse, then growing by 2 up to @p end.
std::vector<double> refined(const double finest, const double depth, const double coarse, const double end)
{
  std::vector<double> sizes;
  double x = 0, size = finest;
  while (x < end)
  {
    sizes.push_back(size);
    x += size;
    if (x >= 2 * depth - 1e-9 && size < 1)
      size = std::min(1.0, 2 * size);
    else if (x >= coarse - 1e-9 && size >= 1)
      size *= 2;
  }
  return sizes;
}

/// The other way to resolve a line near the surface: quadratic elements refined towards it, without images, against images on the mesh
/// of element size 1. The mesh is graded and has one cell along the line: the least that refinement can cost.
void compare_with_refinement(Report &report)
{
  report.note("depth/h  line   mesh at the line   unknowns   error of force   set-up (s)   correction (s)");
  const auto print = [&](const double d, const bool screw, const std::string &mesh, const Measured &m)
  {
    char row[160];
    std::snprintf(row, sizeof row, "%6.1f   %s  %-17s %9lu  %12.4f %%   %9.3f   %9.3f", d, screw ? "screw" : "edge ",
                  mesh.c_str(), static_cast<unsigned long>(m.n_unknowns), 100 * m.error, m.setup, m.seconds);
    report.note(row);
  };
  const std::vector<std::vector<double>> plain{mirrored(graded(1, 4, 300)), {4}, graded(1, 12, 1000)};
  for (const bool screw : {false, true})
    for (const double d : {4.0, 2.0, 1.0, 0.5, 0.2})
    {
      print(d, screw, "h, no images", measure_force(plain, 2, d, screw, 0));
      print(d, screw, "h, images", measure_force(plain, 2, d, screw, coupling::GrainParameters{}.image_depth));
      for (const int parts : {2, 4})
        if (const double finest = d / parts; finest < 1)
        {
          const std::vector<std::vector<double>> sizes{
              mirrored(refined(finest, d, 4, 300)), {4}, refined(finest, d, 12, 1000)};
          print(d, screw, "depth/" + std::to_string(parts) + ", no images", measure_force(sizes, 2, d, screw, 0));
        }
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
  const bool refine = argc > 1 && std::string_view(argv[1]) == "--refine";
  return run(argc, argv,
             [&](Report &report)
             {
               if (refine)
                 return compare_with_refinement(report);
               const double depth = coupling::GrainParameters{}.image_depth;
               if (study)
               {
                 print_convergence(report);
                 for (const unsigned degree : {1U, 2U})
                   for (const double within : {0.0, depth})
                     straight_lines(report, within, degree, true);
               }
               else
                 straight_lines(report, depth, 2, false);
               loops(report, depth);
             });
}
