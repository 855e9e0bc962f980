// Screw dislocation along a free rod of radius R (Eshelby, J. Appl. Phys. 24 (1953) 176), at mid-length. On the axis the
// correction is the twist sigma_theta_z = - mu b r / (pi R^2). At the distance xi from it the image force is, outwards,
// F = (mu b^2 xi / 2 pi) [ 1/(R^2 - xi^2) - 2 (R^2 - xi^2)/R^4 ]: the mirror image at R^2/xi less what the twist of the free ends
// takes off. Without the twist the rod would expel the line everywhere; with it F vanishes at xi = R sqrt(1 - 1/sqrt 2).
#include "dd/geometry/grain_shape.h"
#include "fem/mesh.h"
#include "image_field.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double radius = 100, burgers = 0.25;

/// A rod with @p across elements over its diameter, half as many per length along it.
class Rod
{
public:
  Rod(const unsigned across, const unsigned degree, const double aspect)
      : height(aspect * radius), mesh(make(across, height)), shape(Vec3::Zero(), radius, height),
        image(*mesh, degree, {})
  {
  }
  /// Solves for a screw at @p x, y of the cross-section.
  void put_screw(const double x, const double y)
  {
    Network network;
    add_line(network, {Vec3(x, y, 0), Vec3(x, y, height)}, Vec3(0, 0, burgers), {}, false, NodeConstraint::surface);
    image.solve(LineSystem(medium(), network, &shape, RayDirection::normal, nullptr, nullptr));
  }
  /// Largest error of the twist for a screw on the axis, relative to its largest value mu b / (pi R).
  double error_of_twist()
  {
    put_screw(0, 0);
    double worst = 0;
    for (const double r : {0.1, 0.3, 0.5, 0.7, 0.9})
      for (int k = 0; k < 5; ++k)
      {
        const double angle = 0.3 + 2 * M_PI * k / 5, c = std::cos(angle), s = std::sin(angle);
        const SymTensor stress = image.stress({Vec3(r * radius * c, r * radius * s, height / 2)})[0];
        worst = std::max(worst, std::abs(-s * stress[4] + c * stress[5] + medium().mu * burgers * r / (M_PI * radius)));
      }
    return worst / (medium().mu * burgers / (M_PI * radius));
  }
  /// Outward image force on a screw at @p xi / R, over mu b^2 / (2 pi R); mean over @p n azimuths.
  std::vector<double> forces(const double xi, const int n)
  {
    std::vector<double> values;
    for (int k = 0; k < n; ++k)
    {
      const double angle = 0.17 + 0.31 * k;
      const Vec3 outward(std::cos(angle), std::sin(angle), 0), x = xi * radius * outward;
      put_screw(x[0], x[1]);
      const Vec3 f = image.force_per_length(x + height / 2 * Vec3::UnitZ(), Vec3::UnitZ(), Vec3(0, 0, burgers));
      values.push_back(f.dot(outward) / (medium().mu * burgers * burgers / (2 * M_PI * radius)));
    }
    return values;
  }

private:
  static fem::TriangulationPointer make(const unsigned across, const double height)
  {
    fem::MeshParameters m;
    m.shape = fem::MeshParameters::Shape::cylinder;
    m.radius = radius;
    m.height = height;
    m.subdivisions = {across, across, static_cast<unsigned>(std::lround(across * height / (4 * radius)))};
    return fem::make_mesh(MPI_COMM_WORLD, m);
  }
  double height;
  fem::TriangulationPointer mesh;
  CylinderShape shape;
  ImageField image;
};

double exact_force(const double xi)
{
  const double q = 1 - xi * xi;
  return xi * (1 / q - 2 * q);
}

/// Largest error of the force over mu b^2 / (2 pi R).
double error_of_force(Rod &rod)
{
  double worst = 0;
  for (const double xi : {0.3, 0.45, 0.6})
    for (const double f : rod.forces(xi, 3))
      worst = std::max(worst, std::abs(f - exact_force(xi)));
  return worst;
}

/// xi / R where the force changes sign, from a parabola through three places; the exact force gives 0.54121 in this way.
double sign_change(Rod &rod)
{
  const double low = rod.forces(0.51, 1)[0], middle = rod.forces(0.54, 1)[0], high = rod.forces(0.57, 1)[0];
  const double slope = (high - low) / 0.06, curvature = (high - 2 * middle + low) / (0.03 * 0.03);
  double step = 0;
  for (int k = 0; k < 20; ++k)
    step = -middle / (slope + 0.5 * curvature * step);
  return 0.54 + step;
}
} // namespace

int main(int argc, char **argv)
{
  const bool studies = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               const ConvergenceStudy study(report, "screw_in_rod");
               const auto error = [&](const unsigned degree, const unsigned across)
               {
                 Rod rod(across, degree, 8);
                 return study.add(degree, 2.0 / across, error_of_force(rod));
               };
               if (studies)
               {
                 for (const unsigned across : {6U, 8U, 12U, 16U, 24U})
                   error(1, across);
                 for (const unsigned across : {6U, 8U, 12U, 16U})
                   error(2, across);
                 return;
               }
               Rod coarse(6, 2, 6);
               report.below("length 6 R, 6 elements across: error of the Eshelby twist", coarse.error_of_twist(), 0.02);
               const double zero = std::sqrt(1 - 1 / std::sqrt(2.0));
               Rod rod(12, 2, 6);
               // 2 % of the force at 0.3 R, which is -0.216 in this unit.
               report.below("12 elements across: error of the image force / (mu b^2 / 2 pi R)", error_of_force(rod),
                            0.02 * std::abs(exact_force(0.3)));
               report.below("12 elements across: error of the place where it changes sign / R", sign_change(rod) - zero,
                            0.01);
             });
}
