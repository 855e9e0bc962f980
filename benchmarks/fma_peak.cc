#include "benchmarks/fma_peak.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "benchmarks/fma_peak.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <ctime>

HWY_BEFORE_NAMESPACE();
namespace ddfem::benchmarks::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t n_chains = 12; // latency times throughput of two units, and registers are left

/// Sum of what the chains come to, so that they are computed; @p flops: number of operations.
double run_chains(const std::size_t n_steps, double &flops)
{
  const hn::CappedTag<double, 8> d;
  using V = hn::Vec<decltype(d)>;
  const V factor = hn::Set(d, 0.999), term = hn::Set(d, 1e-3);
  V a0 = hn::Set(d, 0.1), a1 = hn::Set(d, 0.2), a2 = hn::Set(d, 0.3), a3 = hn::Set(d, 0.4), a4 = hn::Set(d, 0.5),
    a5 = hn::Set(d, 0.6), a6 = hn::Set(d, 0.7), a7 = hn::Set(d, 0.8), a8 = hn::Set(d, 0.9), a9 = hn::Set(d, 1.1),
    a10 = hn::Set(d, 1.2), a11 = hn::Set(d, 1.3);
  for (std::size_t i = 0; i < n_steps; ++i)
  {
    a0 = hn::MulAdd(a0, factor, term);
    a1 = hn::MulAdd(a1, factor, term);
    a2 = hn::MulAdd(a2, factor, term);
    a3 = hn::MulAdd(a3, factor, term);
    a4 = hn::MulAdd(a4, factor, term);
    a5 = hn::MulAdd(a5, factor, term);
    a6 = hn::MulAdd(a6, factor, term);
    a7 = hn::MulAdd(a7, factor, term);
    a8 = hn::MulAdd(a8, factor, term);
    a9 = hn::MulAdd(a9, factor, term);
    a10 = hn::MulAdd(a10, factor, term);
    a11 = hn::MulAdd(a11, factor, term);
  }
  flops = 2.0 * static_cast<double>(n_chains * n_steps * hn::Lanes(d));
  const V sum =
      hn::Add(hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)),
              hn::Add(hn::Add(hn::Add(a4, a5), hn::Add(a6, a7)), hn::Add(hn::Add(a8, a9), hn::Add(a10, a11))));
  return hn::GetLane(hn::SumOfLanes(d, sum));
}
} // namespace ddfem::benchmarks::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem::benchmarks
{
HWY_EXPORT(run_chains);

double peak_flops()
{
  double best = 0;
  volatile double sink = 0;
  for (int repetition = 0; repetition < 10; ++repetition)
  {
    double flops = 0;
    const std::clock_t start = std::clock();
    sink = sink + HWY_DYNAMIC_DISPATCH(run_chains)(4'000'000, flops);
    best = std::max(best, flops * CLOCKS_PER_SEC / static_cast<double>(std::clock() - start));
  }
  return best;
}
} // namespace ddfem::benchmarks
#endif
