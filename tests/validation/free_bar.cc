// A bar without load that holds a loop. The volume mean of the total stress is zero (Albenga; int sigma_ij dV is the first moment
// of the tractions, which are zero), and the mean displacements of its ends differ by b_x A_x / S: reciprocity with uniform tension.
// Held after it has relaxed, it exerts no force.
#include "coupling/finite_grain.h"
#include "dd/topology/growth.h"
#include "image_field.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double length = 500, width = 200;
constexpr unsigned along = 20, across = 8;
// A wide core: the stress is then smooth enough to be integrated over the volume by a rule with fixed points.
const IsotropicMedium wide_core{50e3, 0.3, 10};

struct Bar
{
  Network network;
  Vec3 burgers;
  std::unique_ptr<Mesh> mesh =
      box_mesh({std::vector<double>(along, length / along), std::vector<double>(across, width / across),
                std::vector<double>(across, width / across)},
               Vec3::Zero());
  LineSystem lines() const { return {wide_core, network, nullptr, RayDirection::normal, nullptr, nullptr}; }
};

void add(Bar &bar, const Vec3 &centre, const Vec3 &n, const double radius, const Vec3 &b)
{
  add_loop(bar.network, centre, n, radius, b);
  bar.burgers = b;
}

/// Points and weights (of sum 1) of the three-point Gauss rule in each of nx x ny x nz boxes.
struct VolumeRule
{
  std::vector<Vec3> points;
  std::vector<double> weights;
};

VolumeRule volume_rule(const int nx, const int ny, const int nz)
{
  const double place[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
               weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  VolumeRule rule;
  for (int i = 0; i < 3 * nx; ++i)
    for (int j = 0; j < 3 * ny; ++j)
      for (int k = 0; k < 3 * nz; ++k)
      {
        rule.points.emplace_back(length * (i / 3 + place[i % 3]) / nx, width * (j / 3 + place[j % 3]) / ny,
                                 width * (k / 3 + place[k % 3]) / nz);
        rule.weights.push_back(weight[i % 3] * weight[j % 3] * weight[k % 3] / (nx * ny * nz));
      }
  return rule;
}

SymTensor mean(const VolumeRule &rule, const std::vector<SymTensor> &values)
{
  SymTensor sum = SymTensor::Zero();
  for (std::size_t k = 0; k < values.size(); ++k)
    sum += rule.weights[k] * values[k];
  return sum;
}

/// Mean total stress over the mean of the infinite field alone.
double error_of_mean_stress(const Bar &bar, const ImageField &image)
{
  const VolumeRule fine = volume_rule(50, 20, 20), cells = volume_rule(along, across, across);
  const SymTensor infinite = mean(fine, bar.lines().stress(fine.points)),
                  other = mean(cells, image.stress(cells.points));
  return (infinite + other).norm() / infinite.norm();
}

/// Mean of u_x over the end face x = @p face: Simpson's rule over the nodes, exact for the correction.
double mean_displacement(const Bar &bar, const ImageField &image, const double face)
{
  const SweptArea area = grown_area(bar.network, nullptr, RayDirection::normal);
  const auto &nodes = image.elastic_problem().boundary_points();
  const auto correction = image.elastic_problem().boundary_displacements();
  const auto weight = [](const double y)
  {
    const auto k = std::lround(y / width * 2 * across);
    return (k == 0 || k == 2 * across ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / (6 * across);
  };
  double sum = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    if (std::abs(nodes[k][0] - face) > 1e-6)
      continue;
    double u = correction[k][0];
    for (const SweptTriangle &t : area.triangles())
      u += triangle_displacement(wide_core.nu, coupling::to_vec3(nodes[k]), t.vertices[0], t.vertices[1], t.vertices[2],
                                 t.burgers)[0];
    sum += weight(nodes[k][1]) * weight(nodes[k][2]) * u;
  }
  return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
}

/// Force on the platens of a relaxed bar that is then held at both ends, over the force E b A / L of a perfect crystal's.
double reaction_after_relaxation(const Bar &bar, const bool clamped)
{
  coupling::GrainParameters p;
  p.mesh.size = {length, width, width};
  p.mesh.subdivisions = {along, across, across};
  p.fixed_face = "x-";
  p.platen_face = "x+";
  p.clamped = clamped;
  coupling::FiniteGrain grain(p, wide_core, MPI_COMM_WORLD);
  grain.set_reference(bar.network, bar.lines());
  const auto solution = grain.solve(bar.lines(), 0.0);
  const double scale = wide_core.youngs_modulus() * bar.burgers.norm() * vector_area(bar.network).norm() / length;
  return std::max(std::abs(solution.fixed_reaction), std::abs(solution.platen_reaction)) / scale;
}

void check(Report &report, const std::string &name, const Bar &bar)
{
  ImageField image(*bar.mesh, 2, {}, wide_core);
  image.solve(bar.lines());
  report.below(name + ": mean total stress / mean infinite stress", error_of_mean_stress(bar, image), 5e-3);
  const double longer = mean_displacement(bar, image, length) - mean_displacement(bar, image, 0);
  // A loop of vector area A and Burgers vector b (FS/RH) is the plastic strain -b (x) A / V.
  const double exact = -bar.burgers[0] * vector_area(bar.network)[0] / (width * width);
  report.below(name + ": difference of the ends' mean displacements, error", longer / exact - 1, 5e-3);
  for (const bool clamped : {false, true})
    report.below(name + ": force after relaxation, " + (clamped ? "clamped" : "frictionless platens"),
                 reaction_after_relaxation(bar, clamped), 1e-6);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               Bar prismatic, shear;
               add(prismatic, Vec3(270, 110, 95), Vec3::UnitX(), 50, Vec3(0.25, 0, 0));
               add(shear, Vec3(180, 120, 70), Vec3(1, 0, 1).normalized(), 45, 0.25 * Vec3(1, 0, -1).normalized());
               check(report, "prismatic loop", prismatic);
               check(report, "shear loop near an edge", shear);
             });
}
