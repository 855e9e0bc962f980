// Triangular loops under a free plane: the correction stress against values from Mindlin's half-space tensor
// (tests/data/halfspace_loops.json), in a box graded towards the loop and many times larger than its depth.
#include "image_field.h"
#include "reference_loops.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
/// Largest error of a component over the points deeper than @p depth, relative to the largest image component there.
double case_error(const ReferenceLoop &loop, const Mesh &mesh, const double depth, const unsigned degree = 2)
{
  const IsotropicMedium m{loop.mu, loop.nu, 0.01};
  const LineSystem lines(m, loop.network, nullptr, RayDirection::normal, nullptr, nullptr);
  ImageField image(mesh, degree, {}, m);
  image.solve(lines);
  std::vector<Vec3> points;
  std::vector<std::array<double, 6>> expected;
  for (std::size_t k = 0; k < loop.points.size(); ++k)
    if (loop.points[k][2] > depth)
    {
      points.push_back(loop.points[k]);
      expected.push_back(loop.image_stress[k]);
    }
  return largest_error(image.stress(points), expected);
}

/// Error of all loops against element size, for both degrees.
void print_study(const Report &report)
{
  const ConvergenceStudy study(report, "loops_under_surface");
  const auto reference = reference_loops();
  constexpr double shallowest = 2;
  for (const unsigned degree : {1U, 2U})
    for (const double h : {2.0, 1.5, 1.0, 0.75, 0.5})
    {
      if (degree == 2 && h < 0.75)
        continue;
      const auto mesh = half_space_mesh(h, 3);
      double worst = 0;
      for (const ReferenceLoop &loop : reference)
        worst = std::max(worst, case_error(loop, *mesh, shallowest, degree));
      study.add(degree, h / shallowest, worst);
    }
}
} // namespace

int main(int argc, char **argv)
{
  std::vector<double> sizes;
  const bool studies = study_requested(argc, argv);
  for (int k = 1; k < argc && !studies; ++k)
    sizes.push_back(std::atof(argv[k])); // element sizes of a convergence study
  return run(
      argc, argv,
      [&](Report &report)
      {
        if (studies)
          return print_study(report);
        const auto reference = reference_loops();
        const auto study = [&](const double h, const double depth, const std::vector<std::size_t> &cases)
        {
          const auto mesh = half_space_mesh(h, 3);
          double worst = 0;
          for (const std::size_t k : cases)
          {
            const double error = case_error(reference[k], *mesh, depth);
            char row[120];
            std::snprintf(row, sizeof row,
                          "element size %5.3f, points deeper than %4.2f, loop %zu: largest error %8.4f %%", h, depth, k,
                          100 * error);
            report.note(row);
            worst = std::max(worst, error);
          }
          return worst;
        };
        const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7};
        for (const double h : sizes)
          study(h, 2.0, all);
        if (!sizes.empty())
          return;
        report.below("deeper than two elements, element size 1: error of the correction", study(1.0, 2.0, all), 0.05);
        // The loops that are hardest at element size 1, at the same points.
        const std::vector<std::size_t> hardest{3, 5};
        const double coarse = study(1.5, 2.0, hardest), fine = study(1.0, 2.0, hardest);
        report.below("error at element size 1 over error at 1.5 (second order would give 0.44)", fine / coarse, 0.6);
      });
}
