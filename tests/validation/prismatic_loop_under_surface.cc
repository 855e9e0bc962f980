// Circular prismatic loop of radius R, parallel to a free surface at depth d: force towards the surface
// F = (2 pi mu b^2 R^2 d^2 / (1-nu)) int_0^inf k^3 exp(-2 k d) J_1(k R)^2 dk (Bastecka, Czech. J. Phys. B 14 (1964) 430).
#include "image_field.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double radius = 200, depth = 300, burgers = 0.25;

/// Bastecka's integral in units of R^-4 with k in units of 1/R, by Simpson's rule; the integrand is smooth and at k = 40 R/d
/// has fallen to exp(-80) of its largest value.
double force_integral(const double depth_over_radius)
{
  constexpr int n = 4000;
  const double step = 40 / depth_over_radius / n;
  double sum = 0;
  for (int i = 1; i < n; ++i)
  {
    const double k = i * step, bessel = std::cyl_bessel_j(1.0, k);
    sum += (i % 2 == 1 ? 4 : 2) * k * k * k * std::exp(-2 * k * depth_over_radius) * bessel * bessel;
  }
  return sum * step / 3;
}

double exact_force()
{
  const double q = depth / radius;
  return 2 * M_PI * medium().mu * burgers * burgers / (1 - medium().nu) * q * q * force_integral(q);
}

/// Relative error of the force with elements of size @p h near the loop.
double error_of_force(const double h, const unsigned degree)
{
  constexpr int corners = 48;
  // The polygon has the area of the circle.
  const double circumscribed = radius * std::sqrt(2 * M_PI / corners / std::sin(2 * M_PI / corners));
  const auto mesh = half_space_mesh(h, 300);
  ImageField image(*mesh, degree, {});
  Network network;
  add_loop(network, Vec3(0.13 * h, -0.08 * h, depth), Vec3::UnitZ(), circumscribed, Vec3(0, 0, burgers), corners);
  image.solve(LineSystem(medium(), network, nullptr, RayDirection::normal, nullptr, nullptr));
  const Vec3 force = image.total_force(network);
  return -force[2] / exact_force() - 1;
}
} // namespace

int main(int argc, char **argv)
{
  const bool studies = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               const ConvergenceStudy study(report, "prismatic_loop_under_surface");
               const auto error = [&](const unsigned degree, const double h)
               { return study.add(degree, h / depth, error_of_force(h, degree)); };
               if (studies)
               {
                 for (const double h : {150.0, 100.0, 75.0, 60.0, 50.0})
                   error(1, h);
                 for (const double h : {150.0, 100.0, 75.0, 60.0})
                   error(2, h);
                 return;
               }
               // At large depth J_1(k R) = k R / 2 and the integral is (5! / 4) R^2 / (2 d)^6.
               const double far = 50;
               report.below("the integral for d = 50 R against its limit for great depth",
                            force_integral(far) / (30 / std::pow(2 * far, 6)) - 1, 2e-3);
               const double coarse = error(2, 150), production = error(2, 75);
               report.below("quadratic elements of d/4: error of the force", production, 0.02);
               report.below("error at d/4 over error at d/2 (third order: 0.125)", production / coarse, 0.25);
             });
}
