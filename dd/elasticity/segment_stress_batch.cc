// Vectorised loops over points. Compiled so that square roots and selections do not stop the vectoriser (CMakeLists.txt),
// and for several instruction sets, of which the loader takes the best that the processor has.
#include "dd/elasticity/segment_stress.h"

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#define DDFEM_FOR_EVERY_PROCESSOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define DDFEM_FOR_EVERY_PROCESSOR
#endif

namespace ddfem
{
namespace
{
DDFEM_FOR_EVERY_PROCESSOR
void add_segment(const internal::LineConstants &given, const double length, const double *const x1,
                 const double *const x2, const StressBatch &given_batch)
{
  const internal::LineConstants c = given; // copies that no store can change
  const StressBatch batch = given_batch;
#pragma omp simd
  for (std::size_t i = 0; i < batch.n; ++i)
  {
    const double x = batch.x[0][i], y = batch.x[1][i], z = batch.x[2][i];
    double s[6];
    internal::segment_stress_at(c, length, x - x1[0], y - x1[1], z - x1[2], x - x2[0], y - x2[1], z - x2[2], s);
    batch.sigma[0][i] += s[0];
    batch.sigma[1][i] += s[1];
    batch.sigma[2][i] += s[2];
    batch.sigma[3][i] += s[3];
    batch.sigma[4][i] += s[4];
    batch.sigma[5][i] += s[5];
  }
}

DDFEM_FOR_EVERY_PROCESSOR
void add_ray(const internal::LineConstants &given, const double *const origin, const StressBatch &given_batch)
{
  const internal::LineConstants c = given;
  const StressBatch batch = given_batch;
#pragma omp simd
  for (std::size_t i = 0; i < batch.n; ++i)
  {
    double s[6];
    internal::ray_stress_at(c, batch.x[0][i] - origin[0], batch.x[1][i] - origin[1], batch.x[2][i] - origin[2], s);
    batch.sigma[0][i] += s[0];
    batch.sigma[1][i] += s[1];
    batch.sigma[2][i] += s[2];
    batch.sigma[3][i] += s[3];
    batch.sigma[4][i] += s[4];
    batch.sigma[5][i] += s[5];
  }
}
} // namespace

void SegmentStressField::add(const StressBatch &batch) const
{
  add_segment(constants, length, x1.data(), x2.data(), batch);
}

void RayStressField::add(const StressBatch &batch) const
{
  add_ray(constants, origin.data(), batch);
}
} // namespace ddfem
