#include "dd/elasticity/vectorised/displacement_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/displacement_kernels.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/triangle_displacement-inl.h"
#include "dd/elasticity/vectorised/point_groups-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
void add_loops(double nu, const TriangularLoop *loops, std::size_t n_loops, double reference_length,
               const DisplacementBatch &batch)
{
  add_at_points(batch.n, batch.x, batch.u,
                [=](std::size_t, const Vector<Real> &x) HWY_ATTR
                {
                  Vector<Real> sum{};
                  for (std::size_t k = 0; k < n_loops; ++k)
                    sum += displacement_of(nu, loops[k], reference_length, x);
                  return std::array<Real, 3>{sum.x, sum.y, sum.z};
                });
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(add_loops);

void add_triangle_displacement(const double nu, const std::span<const TriangularLoop> loops,
                               const DisplacementBatch &batch, const double reference_length)
{
  HWY_DYNAMIC_DISPATCH(add_loops)(nu, loops.data(), loops.size(), reference_length, batch);
}

std::vector<Vec3> triangle_displacements(const double nu, const std::span<const TriangularLoop> loops,
                                         const std::span<const Vec3> points)
{
  constexpr std::size_t portion = 16; // two of the widest vectors
  std::vector<Vec3> values(points.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t first = 0; first < points.size(); first += portion)
  {
    const std::size_t n = std::min(portion, points.size() - first);
    double x[3][portion], u[3][portion] = {};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        x[c][i] = points[first + i][static_cast<Eigen::Index>(c)];
    add_triangle_displacement(nu, loops, {n, {x[0], x[1], x[2]}, {u[0], u[1], u[2]}});
    for (std::size_t i = 0; i < n; ++i)
      values[first + i] = Vec3(u[0][i], u[1][i], u[2][i]);
  }
  return values;
}
} // namespace ddfem
#endif
