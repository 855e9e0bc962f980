// Screw dislocation on the axis of a free rod of radius R: at mid-length the correction is the Eshelby twist
// sigma_theta_z = - mu b r / (pi R^2) (Eshelby, J. Appl. Phys. 24 (1953) 176).
#include "coupling/convert.h"
#include "coupling/dislocation_tractions.h"
#include "dd/forces/line_system.h"
#include "dd/geometry/grain_shape.h"
#include "fem/elastic_problem.h"
#include "fem/mesh.h"
#include "support.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
/// Largest error at mid-length, relative to the largest value mu b / (pi R).
double largest_error(const unsigned across, const double aspect)
{
  const double radius = 100, height = aspect * radius, b = 0.25;
  fem::MeshParameters m;
  m.shape = fem::MeshParameters::Shape::cylinder;
  m.radius = radius;
  m.height = height;
  m.subdivisions = {across, across, static_cast<unsigned>(across * aspect / 4)};
  const auto mesh = fem::make_mesh(MPI_COMM_WORLD, m);
  fem::ElasticProblem problem(*mesh, {}, {medium().mu, medium().nu}, {});
  const CylinderShape shape(Vec3::Zero(), radius, height);
  Network network;
  add_line(network, {Vec3(0, 0, 0), Vec3(0, 0, height)}, Vec3(0, 0, b), {}, false, NodeConstraint::surface);
  const LineSystem lines(medium(), network, &shape, RayDirection::normal, nullptr, nullptr);
  problem.set_tractions(coupling::DislocationTractions(lines));
  problem.solve(std::vector<dealii::Tensor<1, 3>>(problem.boundary_points().size()));

  std::vector<dealii::Point<3>> points;
  std::vector<double> angles, radii;
  for (const double r : {0.1, 0.3, 0.5, 0.7, 0.9})
    for (int k = 0; k < 5; ++k)
    {
      angles.push_back(0.3 + 2 * M_PI * k / 5);
      radii.push_back(r * radius);
      points.push_back({radii.back() * std::cos(angles.back()), radii.back() * std::sin(angles.back()), height / 2});
    }
  const auto stress = problem.stress_at(points);
  double worst = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const double c = std::cos(angles[k]), s = std::sin(angles[k]);
    const double theta_z = -s * stress[k][0][2] + c * stress[k][1][2];
    worst = std::max(worst, std::abs(theta_z + medium().mu * b * radii[k] / (M_PI * radius * radius)));
  }
  return worst / (medium().mu * b / (M_PI * radius));
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report) {
               report.below("free rod of length 6 R, 6 elements across: error of the Eshelby twist",
                            largest_error(6, 6), 0.02);
             });
}
