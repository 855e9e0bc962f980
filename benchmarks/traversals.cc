// Traversals of the network against plain loops over arrays (Durocher, thesis, Bordeaux 2018, section II.5.2).
#include "benchmarks/networks.h"

#include <benchmark/benchmark.h>
#include <omp.h>

namespace
{
using namespace ddfem;

constexpr double grain_size = 20; // 1e6 nodes and segments
constexpr double dt = 1e-3;

/// Per-thread sum with a cache line of its own.
struct alignas(64) Sum
{
  SymTensor value = SymTensor::Zero();
};

/// The same content as a network and as plain arrays.
struct Data
{
  MovingNetwork grain = irradiated_grain(grain_size);
  Network &network = grain.network;
  std::vector<Vec3> position, old_position, velocity = grain.displacement, burgers;
  std::vector<std::uint32_t> start, end, first_arm{0}, arms;

  Data()
  {
    for (const NodeIndex i : network.nodes())
    {
      position.push_back(network.position(i));
      for (const SegmentIndex s : network.connected_segments(i))
        arms.push_back(s.value);
      first_arm.push_back(static_cast<std::uint32_t>(arms.size()));
    }
    old_position = position;
    for (const SegmentIndex s : network.segments())
    {
      start.push_back(network.start(s).value);
      end.push_back(network.end(s).value);
      burgers.push_back(network.burgers(s));
    }
  }
};

Data &data()
{
  static Data d;
  return d;
}

/// @p bytes: what has to be read and written of each element at least. Both by the time of all cores together: with two
/// threads the bandwidth is that of each.
void report(benchmark::State &state, std::size_t n, double bytes)
{
  using benchmark::Counter;
  const auto count = static_cast<double>(n);
  state.counters["time_each"] = Counter(count, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["bytes_per_s"] = Counter(count * bytes, Counter::kIsIterationInvariantRate);
}

/// STREAM triad (McCalpin 1995): the bandwidth to compare with.
void triad(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const std::size_t n = 8'000'000; // 192 MB: more than any cache
  static std::vector<double> a(n), b(n, 1.0), c(n, 2.0);
  for ([[maybe_unused]] const auto unused : state)
  {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < n; ++i)
      a[i] = b[i] + 3.0 * c[i];
    benchmark::ClobberMemory();
  }
  report(state, n, 3 * sizeof(double));
}

void move_nodes_arrays(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  Data &d = data();
  for ([[maybe_unused]] const auto unused : state)
  {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < d.position.size(); ++i)
    {
      d.old_position[i] = d.position[i];
      d.position[i] += dt * d.velocity[i];
    }
    benchmark::ClobberMemory();
  }
  report(state, d.position.size(), 4 * sizeof(Vec3));
}

void move_nodes(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  Data &d = data();
  for ([[maybe_unused]] const auto unused : state)
  {
    d.network.for_each_node(
        [&d](NodeIndex i)
        {
          const Vec3 x = d.network.position(i);
          d.old_position[i.value] = x;
          d.network.set_position(i, x + dt * d.velocity[i.value]);
        });
    benchmark::ClobberMemory();
  }
  report(state, d.network.n_nodes(), 4 * sizeof(Vec3));
}

/// Adds the plastic strain times volume of a segment that has moved (annex A.1 of the thesis). Component by component:
/// GCC 12 stores a Vec3 in halves and reads it back as a whole, which stalls for longer than all the rest takes.
void add_strain(const Vec3 &x1, const Vec3 &old1, const Vec3 &x2, const Vec3 &old2, const Vec3 &b, SymTensor &sum)
{
  const double ex = x2[0] - old1[0], ey = x2[1] - old1[1], ez = x2[2] - old1[2];
  const double hx = x1[0] - old1[0] - x2[0] + old2[0], hy = x1[1] - old1[1] - x2[1] + old2[1],
               hz = x1[2] - old1[2] - x2[2] + old2[2];
  const double nx = 0.5 * (ey * hz - ez * hy), ny = 0.5 * (ez * hx - ex * hz), nz = 0.5 * (ex * hy - ey * hx);
  sum[0] += nx * b[0];
  sum[1] += ny * b[1];
  sum[2] += nz * b[2];
  sum[3] += 0.5 * (nx * b[1] + ny * b[0]);
  sum[4] += 0.5 * (nx * b[2] + nz * b[0]);
  sum[5] += 0.5 * (ny * b[2] + nz * b[1]);
}

// Useful bytes of a segment in both versions: its node (there are as many of them) with two positions, b, two indices.
constexpr double bytes_of_segment = 3 * sizeof(Vec3) + 2 * sizeof(std::uint32_t);

void strain_arrays(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  Data &d = data();
  std::vector<Sum> sums(static_cast<std::size_t>(omp_get_max_threads()));
  for ([[maybe_unused]] const auto unused : state)
  {
#pragma omp parallel
    {
      SymTensor sum = SymTensor::Zero();
#pragma omp for schedule(static)
      for (std::size_t s = 0; s < d.start.size(); ++s)
      {
        const std::uint32_t i = d.start[s], j = d.end[s];
        add_strain(d.position[i], d.old_position[i], d.position[j], d.old_position[j], d.burgers[s], sum);
      }
      sums[static_cast<std::size_t>(omp_get_thread_num())].value = sum;
    }
    benchmark::DoNotOptimize(sums.data());
    benchmark::ClobberMemory();
  }
  report(state, d.start.size(), bytes_of_segment);
}

/// A loop over the range of segments with a sum of each thread's own.
void strain(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const Data &d = data();
  std::vector<Sum> sums(static_cast<std::size_t>(omp_get_max_threads()));
  for ([[maybe_unused]] const auto unused : state)
  {
#pragma omp parallel
    {
      SymTensor sum = SymTensor::Zero();
#pragma omp for schedule(static)
      for (const SegmentIndex s : d.network.segments())
      {
        const NodeIndex i = d.network.start(s), j = d.network.end(s);
        add_strain(d.network.position(i), d.old_position[i.value], d.network.position(j), d.old_position[j.value],
                   d.network.burgers(s), sum);
      }
      sums[static_cast<std::size_t>(omp_get_thread_num())].value = sum;
    }
    benchmark::DoNotOptimize(sums.data());
    benchmark::ClobberMemory();
  }
  report(state, d.network.n_segments(), bytes_of_segment);
}

/// for_each_segment() with sums that are looked up by the number of the thread for every segment.
void strain_for_each(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const Data &d = data();
  std::vector<Sum> sums(static_cast<std::size_t>(omp_get_max_threads()));
  for ([[maybe_unused]] const auto unused : state)
  {
    d.network.for_each_segment(
        [&](SegmentIndex s, NodeIndex i, NodeIndex j)
        {
          add_strain(d.network.position(i), d.old_position[i.value], d.network.position(j), d.old_position[j.value],
                     d.network.burgers(s), sums[static_cast<std::size_t>(omp_get_thread_num())].value);
        });
    benchmark::DoNotOptimize(sums.data());
    benchmark::ClobberMemory();
  }
  report(state, d.network.n_segments(), bytes_of_segment);
}

// Length of the segments: two nodes (as many as there are segments), two indices, one result.
constexpr double bytes_of_length = sizeof(Vec3) + 2 * sizeof(std::uint32_t) + sizeof(double);

void lengths_arrays(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const Data &d = data();
  std::vector<double> length(d.start.size());
  for ([[maybe_unused]] const auto unused : state)
  {
#pragma omp parallel for schedule(static)
    for (std::size_t s = 0; s < d.start.size(); ++s)
      length[s] = (d.position[d.end[s]] - d.position[d.start[s]]).norm();
    benchmark::ClobberMemory();
  }
  report(state, length.size(), bytes_of_length);
}

void lengths(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const Data &d = data();
  std::vector<double> length(d.network.segment_capacity());
  for ([[maybe_unused]] const auto unused : state)
  {
    d.network.for_each_segment([&](SegmentIndex s, NodeIndex i, NodeIndex j)
                               { length[s.value] = (d.network.position(j) - d.network.position(i)).norm(); });
    benchmark::ClobberMemory();
  }
  report(state, length.size(), bytes_of_length);
}

// Sum of the Burgers vectors around a node: two arms with index and b, one result.
constexpr double bytes_of_node = 3 * sizeof(Vec3) + 3 * sizeof(std::uint32_t);

void arms_arrays(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  Data &d = data();
  std::vector<Vec3> sum(d.position.size());
  for ([[maybe_unused]] const auto unused : state)
  {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < d.position.size(); ++i)
    {
      Vec3 b = Vec3::Zero();
      for (std::uint32_t k = d.first_arm[i]; k < d.first_arm[i + 1]; ++k)
        b += d.start[d.arms[k]] == i ? d.burgers[d.arms[k]] : Vec3(-d.burgers[d.arms[k]]);
      sum[i] = b;
    }
    benchmark::ClobberMemory();
  }
  report(state, d.position.size(), bytes_of_node);
}

void arms(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(0)));
  Data &d = data();
  std::vector<Vec3> sum(d.network.node_capacity());
  for ([[maybe_unused]] const auto unused : state)
  {
    d.network.for_each_node_with_segments(
        [&](NodeIndex i, std::span<const SegmentIndex> segments)
        {
          Vec3 b = Vec3::Zero();
          for (const SegmentIndex s : segments)
            b += d.network.burgers_from(s, i);
          sum[i.value] = b;
        });
    benchmark::ClobberMemory();
  }
  report(state, d.network.n_nodes(), bytes_of_node);
}

BENCHMARK(triad)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(move_nodes_arrays)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(move_nodes)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(strain_arrays)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(strain)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(strain_for_each)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(lengths_arrays)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(lengths)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(arms_arrays)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
BENCHMARK(arms)->ArgName("threads")->Arg(1)->Arg(2)->MeasureProcessCPUTime();
} // namespace
