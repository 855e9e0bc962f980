// The image field (total minus infinite) of lines in a body, for validation programs that compare it with closed forms, and the
// tables of their convergence studies.
#pragma once

#include "coupling/convert.h"
#include "coupling/dislocation_tractions.h"
#include "dd/forces/segment_points.h"
#include "dd/forces/surface_images.h"
#include "fem/elastic_problem.h"
#include "support.h"

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string_view>
#include <vector>

namespace ddfem::validation
{
using Mesh = dealii::parallel::distributed::Triangulation<3>;

/// Displacement (nm) at a point (nm).
using Displacement = std::function<Vec3(const Vec3 &)>;

/// The image field of lines in the body of a mesh. What it is made of is known here only: programs ask for stresses and forces.
class ImageField
{
public:
  /// @p mesh must outlive the object. @p conditions: as for fem::ElasticProblem.
  ImageField(const fem::Triangulation &mesh, const unsigned degree,
             const std::vector<fem::DisplacementCondition> &conditions, const IsotropicMedium &material = medium())
      : problem(mesh, parameters(degree), {material.mu, material.nu}, conditions)
  {
  }

  /// Solves for the image field of @p lines; @p held is the image displacement where it is prescribed (none: zero). Lines within
  /// @p image_depth (nm) of @p planes get analytic images.
  void solve(const LineSystem &lines, const Displacement &held = {}, const std::vector<ImagePlane> &planes = {},
             const double image_depth = 0)
  {
    images = SurfaceImages(lines, planes, {image_depth, 1e-6});
    problem.set_tractions(coupling::DislocationTractions(lines, &images));
    std::vector<Vec3> nodes;
    std::transform(problem.boundary_points().begin(), problem.boundary_points().end(), std::back_inserter(nodes),
                   coupling::to_vec3);
    const auto of_images = images.displacement(nodes);
    std::vector<dealii::Tensor<1, 3>> prescribed;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      prescribed.push_back(coupling::to_tensor(held ? Vec3(held(nodes[i]) - of_images[i]) : Vec3(-of_images[i])));
    problem.solve(prescribed);
  }
  /// Image stress, MPa.
  std::vector<SymTensor> stress(const std::vector<Vec3> &points) const
  {
    std::vector<dealii::Point<3>> positions;
    std::transform(points.begin(), points.end(), std::back_inserter(positions), coupling::to_point);
    std::vector<SymTensor> values;
    for (const auto &s : problem.stress_at(positions))
      values.push_back(coupling::to_sym_tensor(s));
    for (std::size_t k = 0; k < points.size(); ++k)
      values[k] += images.stress(points[k]);
    return values;
  }
  /// Image force per length (MPa nm) on a line along @p xi (unit vector) at @p x.
  Vec3 force_per_length(const Vec3 &x, const Vec3 &xi, const Vec3 &b) const
  {
    return (to_matrix(stress({x})[0]) * b).cross(xi);
  }
  /// Image force (MPa nm^2) on the whole network, by the rule of nodal forces.
  Vec3 total_force(const Network &network) const
  {
    const SegmentPoints points(network);
    const auto values = stress(points.positions());
    Vec3 force = Vec3::Zero();
    std::size_t i = 0;
    for (const SegmentIndex s : network.segments())
    {
      for (std::size_t q = 0; q < points.weights(i).size(); ++q)
        force += points.weights(i)[q] *
                 (to_matrix(values[points.begin_of(i) + q]) * network.burgers(s)).cross(network.direction(s));
      ++i;
    }
    return force;
  }
  const fem::ElasticProblem &elastic_problem() const { return problem; }

private:
  static fem::ElasticProblem::Parameters parameters(const unsigned degree)
  {
    fem::ElasticProblem::Parameters p;
    p.degree = degree;
    p.max_iterations = 10000; // some meshes have elements hundreds of times longer than wide
    return p;
  }
  fem::ElasticProblem problem;
  SurfaceImages images;
};

/// A line through @p x along @p direction that is straight for 0.01 m on either side.
inline void add_endless_line(Network &network, const Vec3 &x, const Vec3 &direction, const Vec3 &b)
{
  constexpr double far = 1e7;
  add_line(network, {x - far * direction, x + far * direction}, b, {}, false, NodeConstraint::pinned);
}

/// Box with cells of the given sizes along the axes, its lowest corner at @p low; boundary ids x-, x+, ..., z+ = 0 ... 5.
inline std::unique_ptr<Mesh> box_mesh(const std::vector<std::vector<double>> &sizes, const Vec3 &low)
{
  Vec3 high = low;
  for (int c = 0; c < 3; ++c)
    high[c] =
        std::accumulate(sizes[static_cast<std::size_t>(c)].begin(), sizes[static_cast<std::size_t>(c)].end(), low[c]);
  auto mesh = std::make_unique<Mesh>(MPI_COMM_WORLD);
  dealii::GridGenerator::subdivided_hyper_rectangle(*mesh, sizes, coupling::to_point(low), coupling::to_point(high),
                                                    true);
  return mesh;
}

/// Plate |y| < thickness/2, |x| < half_width, |z| < h, two cells thick in z (the recovery of stresses wants vertices inside the
/// body), with @p elements of size h through the thickness.
inline std::unique_ptr<Mesh> plate_mesh(const double thickness, const double half_width, const unsigned elements)
{
  const double h = thickness / elements;
  const auto n = static_cast<std::size_t>(std::lround(2 * half_width / h));
  return box_mesh(
      {std::vector<double>(n, 2 * half_width / static_cast<double>(n)), std::vector<double>(elements, h), {h, h}},
      Vec3(-half_width, -thickness / 2, -h));
}

/// Element sizes from the fine middle of half-width @p fine outwards to @p half_width, growing by 2.
inline std::vector<double> graded(const double h, const double fine, const double half_width)
{
  std::vector<double> sizes(static_cast<std::size_t>(std::lround(fine / h)), h);
  double x = fine, size = h;
  while (x < half_width)
  {
    size *= 2;
    sizes.push_back(size);
    x += size;
  }
  return sizes;
}

/// Sizes mirrored about the middle of an interval.
inline std::vector<double> mirrored(const std::vector<double> &half)
{
  std::vector<double> all(half.rbegin(), half.rend());
  all.insert(all.end(), half.begin(), half.end());
  return all;
}

/// Stand-in for a half-space z > 0: a box with element size @p h near the origin, up to @p fine to the sides and 2 @p fine
/// deep, and more than ten times as wide and deep as that.
inline std::unique_ptr<Mesh> half_space_mesh(const double h, const double fine)
{
  const auto half = graded(h, fine, 11.5 * fine), depth = graded(h, 2 * fine, 23 * fine);
  const auto across = mirrored(half);
  const double width = std::accumulate(half.begin(), half.end(), 0.0);
  return box_mesh({across, across, depth}, Vec3(-width, -width, 0));
}

/// Errors against element size, printed as lines "study NAME degree P size H error E" that docs/figures/convergence.py reads.
class ConvergenceStudy
{
public:
  ConvergenceStudy(const Report &rows, std::string case_name) : report(rows), name(std::move(case_name)) {}

  /// @p size: element size over the length of the case; @p error: relative. Returns the error.
  double add(const unsigned degree, const double size, const double error) const
  {
    char row[160];
    std::snprintf(row, sizeof row, "study %s degree %u size %8.5f error %10.3e", name.c_str(), degree, size, error);
    report.note(row);
    return error;
  }

private:
  const Report &report;
  std::string name;
};

/// Whether the program was called with --study: print the table of a convergence study instead of the statements.
inline bool study_requested(const int argc, char **argv)
{
  return argc > 1 && std::string_view(argv[1]) == "--study";
}
} // namespace ddfem::validation
