// Screw dislocation in a plate of thickness t, at the distance y from the mid-plane: image force per length
// (mu b^2 / 4 t) tan(pi y / t) towards the nearer face (images at y -> t - y, ...; the conformal map exp(pi x/t) gives the same).
// The end faces of the slab are planes of antisymmetry, u_x = u_y = 0: antiplane strain without an end.
#include "image_field.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double thickness = 400, burgers = 0.25;

/// Largest relative error of the force on lines t/4 below the surface, in nine places of an element. @p elements: a multiple
/// of four, so that these are the same places on every mesh. 3 t from the line the plate's ends change the force by
/// exp(-6 pi) of itself.
double largest_error(const unsigned elements, const unsigned degree)
{
  const auto mesh = plate_mesh(thickness, 3 * thickness, elements);
  ImageField image(*mesh, degree, {{4, {true, true, false}}, {5, {true, true, false}}});
  const double h = thickness / elements;
  const Vec3 b(0, 0, burgers);
  double worst = 0;
  for (const double up : {-0.4, -0.1, 0.3})
    for (const double along : {0.1, 0.3, 0.5})
    {
      const Vec3 x(along * h, thickness / 4 + up * h, 0);
      Network network;
      add_endless_line(network, x, Vec3::UnitZ(), b);
      image.solve(LineSystem(medium(), network, nullptr, RayDirection::normal, nullptr, nullptr));
      const double force = image.force_per_length(x, Vec3::UnitZ(), b)[1];
      const double exact = medium().mu * b.squaredNorm() / (4 * thickness) * std::tan(M_PI * x[1] / thickness);
      worst = std::max(worst, std::abs(force / exact - 1));
    }
  return worst;
}
} // namespace

int main(int argc, char **argv)
{
  const bool studies = study_requested(argc, argv);
  return run(
      argc, argv,
      [&](Report &report)
      {
        const ConvergenceStudy study(report, "screw_in_plate");
        const auto error = [&](const unsigned degree, const unsigned elements)
        { return study.add(degree, 1.0 / elements, largest_error(elements, degree)); };
        if (studies)
        {
          for (const unsigned n : {8U, 12U, 16U, 24U, 32U, 48U})
            error(1, n);
          for (const unsigned n : {8U, 12U, 16U, 24U, 32U})
            error(2, n);
          return;
        }
        const double linear_coarse = error(1, 12), linear = error(1, 24), coarse = error(2, 8),
                     production = error(2, 16);
        report.below("16 quadratic elements through the plate, line 4 deep: error of the force", production, 0.02);
        report.below("linear elements: error at 24 over error at 12 (second order: 0.25)", linear / linear_coarse,
                     0.35);
        report.below("quadratic elements: error at 16 over error at 8 (third order: 0.125)", production / coarse, 0.2);
      });
}
