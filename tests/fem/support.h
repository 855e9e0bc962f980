// What several tests of fem/ share: meshes, exact solutions, prescribed values.
#pragma once

#include "fem/elastic_problem.h"
#include "fem/mesh.h"

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace ddfem::fem::test
{
using Point = dealii::Point<3>;
using Vector = dealii::Tensor<1, 3>;
using Stress = dealii::SymmetricTensor<2, 3>;

inline constexpr Moduli copper{48e3, 0.34};

inline double youngs_modulus(const Moduli &moduli)
{
  return 2. * moduli.mu * (1. + moduli.nu);
}

inline MeshParameters box(std::array<double, 3> size, std::array<unsigned, 3> cells, std::array<double, 3> origin = {})
{
  MeshParameters parameters;
  parameters.shape = MeshParameters::Shape::box;
  parameters.size = size;
  parameters.subdivisions = cells;
  parameters.origin = origin;
  return parameters;
}

inline MeshParameters cylinder(double radius, double height, unsigned across, unsigned along)
{
  MeshParameters parameters;
  parameters.shape = MeshParameters::Shape::cylinder;
  parameters.radius = radius;
  parameters.height = height;
  parameters.subdivisions = {across, across, along};
  return parameters;
}

inline MeshParameters mesh_file(const std::string &name, double unit = 1000.)
{
  MeshParameters parameters;
  parameters.shape = MeshParameters::Shape::gmsh;
  parameters.file = std::string(DDFEM_SOURCE_DIR) + "/meshes/" + name;
  parameters.length_unit_nm = unit;
  return parameters;
}

inline ElasticProblem::Parameters accurate(unsigned degree)
{
  ElasticProblem::Parameters parameters;
  parameters.degree = degree;
  parameters.relative_tolerance = 1e-13;
  return parameters;
}

/// Values of a displacement field at the boundary points of a problem.
inline std::vector<Vector> prescribe(const ElasticProblem &problem, const std::function<Vector(const Point &)> &field)
{
  std::vector<Vector> values;
  for (const auto &x : problem.boundary_points())
  {
    values.push_back(field(x));
  }
  return values;
}

inline Stress hooke(const Moduli &moduli, const dealii::Tensor<2, 3> &gradient)
{
  const auto strain = symmetrize(gradient);
  const double lambda = 2. * moduli.mu * moduli.nu / (1. - 2. * moduli.nu);
  return 2. * moduli.mu * strain + lambda * trace(strain) * dealii::unit_symmetric_tensor<3>();
}

/// Points spread over a box, away from its surface and from planes of simple fractions.
inline std::vector<Point> scattered_points(const Point &low, const Point &high, unsigned n)
{
  std::vector<Point> points;
  for (unsigned i = 1; i <= n; ++i)
  {
    const std::array<double, 3> fraction = {std::fmod(i * 0.7548776662, 1.), std::fmod(i * 0.5698402910, 1.),
                                            std::fmod(i * 0.3247179572, 1.)};
    Point x;
    for (unsigned d = 0; d < 3; ++d)
    {
      x[d] = low[d] + (0.01 + 0.98 * fraction[d]) * (high[d] - low[d]);
    }
    points.push_back(x);
  }
  return points;
}

/// Point force F (MPa nm^2) at x0 in an infinite body: Kelvin's solution.
struct PointForce
{
  Point source;
  Vector force;
  Moduli moduli;

  Vector displacement(const Point &x) const
  {
    const Vector arm = x - source;
    const double r = arm.norm();
    const Vector n = arm / r;
    return ((3. - 4. * moduli.nu) * force + (n * force) * n) /
           (16. * std::numbers::pi * moduli.mu * (1. - moduli.nu) * r);
  }

  Stress stress(const Point &x) const
  {
    const Vector arm = x - source;
    const double r = arm.norm(), factor = -1. / (8. * std::numbers::pi * (1. - moduli.nu) * r * r);
    const Vector n = arm / r;
    Stress result;
    for (unsigned i = 0; i < 3; ++i)
    {
      for (unsigned j = i; j < 3; ++j)
      {
        const double isotropic = i == j ? n * force : 0.;
        result[i][j] = factor * ((1. - 2. * moduli.nu) * (force[i] * n[j] + force[j] * n[i] - isotropic) +
                                 3. * n[i] * n[j] * (n * force));
      }
    }
    return result;
  }
};

/// Field of one source made of two functions.
class FunctionField : public TractionField
{
public:
  using StressFunction = std::function<Stress(const Point &)>;
  using LengthFunction = std::function<double(const Point &, double)>;

  /// Smooth everywhere unless told otherwise.
  explicit FunctionField(
      StressFunction stress_function, LengthFunction length_function = [](const Point &, double) { return 1e300; })
      : stress_of(std::move(stress_function)), length_of(std::move(length_function))
  {
  }

  Stress at(const Point &x) const { return stress_of(x); }

  unsigned n_sources() const override { return 1; }
  void smooth_lengths(const Point &centre, double radius, std::span<const unsigned> /*sources*/,
                      std::span<double> lengths) const override
  {
    lengths[0] = length_of(centre, radius);
  }
  void add_stress(std::span<const unsigned> /*sources*/, std::span<const Point> points,
                  std::span<Stress> values) const override
  {
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      values[i] += stress_of(points[i]);
    }
  }

private:
  StressFunction stress_of;
  LengthFunction length_of;
};

inline FunctionField field_of(const PointForce &force)
{
  return FunctionField([force](const Point &x) { return force.stress(x); },
                       [force](const Point &x, double radius) { return x.distance(force.source) - radius; });
}
} // namespace ddfem::fem::test
