// A network of vector area A in a bar between frictionless platens that hold its length L exerts the force F = E b_x A_x / L on
// both platens, whatever its shape and place (reciprocity); positive: tension.
#include "coupling/finite_grain.h"
#include "support.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double length = 500, width = 200;

double relative_error(const Network &network, const unsigned elements, const unsigned degree, const RayDirection rule,
                      double &mismatch)
{
  coupling::GrainParameters p;
  p.mesh.size = {length, width, width};
  const unsigned across = elements * 2 / 5;
  p.mesh.subdivisions = {elements, across, across};
  p.elasticity.degree = degree;
  p.fixed_face = "x-";
  p.platen_face = "x+";
  p.clamped = false;
  p.reference = coupling::ReferenceState::perfect_crystal;
  p.ray_direction = rule;
  coupling::FiniteGrain grain(p, medium(), MPI_COMM_WORLD);
  const LineSystem lines(medium(), network, &grain.shape(), rule, nullptr, nullptr);
  grain.set_reference(network, lines);
  const auto solution = grain.solve(lines, 0.0);
  const Vec3 b = network.burgers(network.segments()[0]);
  const double exact = medium().youngs_modulus() * b[0] * vector_area(network)[0] / length;
  mismatch = (solution.fixed_reaction - solution.platen_reaction) / exact;
  return solution.platen_reaction / exact - 1;
}

void study(Report &report, const std::string &name, const Network &network,
           const RayDirection rule = RayDirection::normal)
{
  report.note("\n" + name + ": error of the platen force");
  double coarse = 0, production = 0, mismatch = 0;
  for (const unsigned degree : {1U, 2U})
    for (const unsigned elements : {5U, 10U, 20U})
    {
      if (degree == 2 && elements == 20)
        continue;
      const double error = relative_error(network, elements, degree, rule, mismatch);
      char row[100];
      std::snprintf(row, sizeof row, "  degree %u, %2u elements along the bar: %9.5f %%", degree, elements,
                    100 * error);
      report.note(row);
      if (degree == 2)
        (elements == 5 ? coarse : production) = error;
    }
  report.below(name + ", 10 quadratic elements: error", production, 0.01);
  report.below(name + ", 10 quadratic elements: difference of the platens", mismatch, 1e-5);
  report.below(name + ": error at 10 over error at 5 elements", production / std::max(std::abs(coarse), 1e-3), 1.0);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               const Vec3 n = Vec3(1, 0, 1).normalized(), b = 0.25 * Vec3(1, 0, -1).normalized();
               Network shear, prismatic, near_side, half;
               add_loop(shear, Vec3(230, 90, 110), n, 50, b);
               study(report, "shear loop", shear);
               add_loop(prismatic, Vec3(270, 110, 95), Vec3::UnitX(), 50, Vec3(0.25, 0, 0));
               study(report, "prismatic loop", prismatic);
               add_loop(near_side, Vec3(250, 100, 150), n, 40, b);
               study(report, "shear loop near a side face", near_side);
               // Ends on the side face y = 0; the loop's plane holds the face's normal.
               add_half_loop(half, Vec3(240, 0, 100), n, -Vec3::UnitY(), 60, b);
               study(report, "surface half loop", half);
               study(report, "surface half loop, radial rays", half, RayDirection::radial);
             });
}
