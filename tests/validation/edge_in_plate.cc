// Edge dislocation along z in a plate of thickness t, b along x, at the distance y from the mid-plane: the plate bends by
// theta = (3 b / 2 t)(1 - 4 y^2 / t^2), whatever the elastic constants. Reciprocity with the bending moment M per width:
// M theta = b int_y^{t/2} sigma_xx dy, sigma_xx = 12 M y / t^3.
#include "coupling/finite_grain.h"
#include "image_field.h"

#include <map>

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double thickness = 400, burgers = 0.25, half_width = 3 * thickness;

/// The slab between frictionless platens z = 0 and z = h that do not move: plane strain without an end.
coupling::FiniteGrain plate(const unsigned elements, const unsigned degree, const IsotropicMedium &material)
{
  const double h = thickness / elements;
  coupling::GrainParameters p;
  p.mesh.size = {2 * half_width, thickness, h};
  p.mesh.origin = {-half_width, -thickness / 2, 0};
  p.mesh.subdivisions = {6 * elements, elements, 1};
  p.elasticity.degree = degree;
  p.clamped = false;
  p.reference = coupling::ReferenceState::perfect_crystal;
  return coupling::FiniteGrain(p, material, MPI_COMM_WORLD);
}

/// Mean rotation of the face x = @p face (rad, positive from x to y): that of the plane whose distance from the deformed face
/// does least work with a bending moment, omega = - (12 / t^3) int u_x y dy, u_x as the elements interpolate it.
double rotation(const coupling::FiniteGrain &grain, const double face, const unsigned degree)
{
  const auto nodes = grain.boundary_nodes(), u = grain.boundary_displacement();
  std::map<double, double> profile; // u_x at the nodes of one edge, by y
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (std::abs(nodes[k][0] - face) < 1e-6 && nodes[k][2] < 1e-6)
      profile[nodes[k][1]] = u[k][0];
  std::vector<std::pair<double, double>> v(profile.begin(), profile.end());
  double moment = 0;
  for (std::size_t k = 0; k + degree < v.size(); k += degree)
  {
    const auto [y0, u0] = v[k];
    const auto [y1, u1] = v[k + degree];
    const double middle = degree == 2 ? v[k + 1].second : 0.5 * (u0 + u1);
    moment += (y1 - y0) / 6 * (y0 * u0 + 2 * (y0 + y1) * middle + y1 * u1); // Simpson's rule: exact
  }
  return -12 / std::pow(thickness, 3) * moment;
}

/// Relative error of the bend for a line at y/t = @p place.
double error_of_bend(coupling::FiniteGrain &grain, const unsigned degree, const double place,
                     const IsotropicMedium &material)
{
  // The line is one side of a loop whose other sides are 0.01 m away; x off the faces of elements.
  constexpr double far = 1e7;
  const double x = 7.3, y = place * thickness;
  Network network;
  add_line(network, {Vec3(x, y, -far), Vec3(x, y, far), Vec3(x, far, far), Vec3(x, far, -far)}, Vec3(burgers, 0, 0), {},
           true, NodeConstraint::free);
  const LineSystem lines(material, network, nullptr, RayDirection::normal, nullptr, nullptr);
  grain.set_reference(network, lines);
  grain.solve(lines, 0.0);
  const double bend = rotation(grain, half_width, degree) - rotation(grain, -half_width, degree);
  const double exact = 1.5 * burgers / thickness * (1 - 4 * place * place);
  return std::abs(std::abs(bend) / exact - 1);
}

double largest_error(const unsigned elements, const unsigned degree, const IsotropicMedium &material = medium())
{
  auto grain = plate(elements, degree, material);
  double worst = 0;
  for (const double place : {-0.31, 0.02, 0.17, 0.38})
    worst = std::max(worst, error_of_bend(grain, degree, place, material));
  return worst;
}
} // namespace

int main(int argc, char **argv)
{
  const bool studies = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               const ConvergenceStudy study(report, "edge_in_plate");
               const auto error = [&](const unsigned degree, const unsigned elements)
               { return study.add(degree, 1.0 / elements, largest_error(elements, degree)); };
               if (studies)
               {
                 for (const unsigned n : {4U, 6U, 8U, 12U, 16U, 24U})
                   error(1, n);
                 for (const unsigned n : {4U, 6U, 8U, 12U})
                   error(2, n);
                 return;
               }
               const double coarse = error(1, 6), fine = error(1, 12);
               report.below("bend of the plate, 6 quadratic elements through it: error", error(2, 6), 1e-3);
               report.below("the same with Poisson's ratio 0.1 and other moduli: error",
                            largest_error(6, 2, {120e3, 0.1, 0.25}), 1e-3);
               report.below("linear elements: error at 12 over error at 6 (second order: 0.25)", fine / coarse, 0.3);
             });
}
