// Cost of nodal velocities, local and consistent, for given forces.
#include "dd/crystal/slip_systems.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/friction_glide.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/velocity_solver.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace
{
using namespace ddfem;

/// 1000 Frank-Read sources of 30 segments of 5 to 15 nm on all slip systems of fcc, bowed out.
Network bowed_sources()
{
  const SlipSystems systems(Lattice::fcc, 0.405);
  Network network;
  for (int k = 0; k < 1000; ++k)
  {
    const SlipSystem &system = systems[static_cast<std::size_t>(k) % systems.size()];
    const Vec3 centre(500.0 * (k % 10), 500.0 * (k / 10 % 10), 500.0 * (k / 100.0));
    const Vec3 along = system.burgers.normalized(), across = system.normal.cross(along);
    const Vec3 t = std::cos(0.1 * k) * along + std::sin(0.1 * k) * across, bow = system.normal.cross(t);
    const PlaneIndex plane = network.planes().find_or_insert(system.plane_miller, system.normal, centre);
    std::vector<Vec3> points;
    for (int m = 0; m <= 30; ++m)
    {
      const double x = (m - 15) / 15.0 + 0.02 * std::sin(7.0 * m + k);
      points.push_back(centre + 150 * x * t + 40 * (1 - x * x) * bow);
    }
    add_line(network, points, system.burgers, plane, false, NodeConstraint::pinned);
  }
  network.clean();
  return network;
}

/// Forces of a uniform stress with a tenth of noise.
struct Sources
{
  Network network = bowed_sources();
  std::vector<Vec3> force;

  Sources() : force(network.node_capacity(), Vec3::Zero())
  {
    Mat3 stress;
    stress << 20, 35, -10, 35, -30, 15, -10, 15, 10; // MPa
    for (const SegmentIndex s : network.segments())
      for (const NodeIndex i : {network.start(s), network.end(s)})
        force[i.value] += 0.5 * (stress * network.burgers(s)).cross(network.direction(s));
    for (const NodeIndex i : network.nodes())
      force[i.value] *= 1 + 0.1 * std::sin(12.9898 * i.value);
  }
};

const Sources &sources()
{
  static const Sources s;
  return s;
}

enum class Law
{
  linear,
  friction, ///< with a largest speed
  limited   ///< largest speed only
};

MobilityPointer make(const Law law)
{
  const MobilityPointer linear = linear_glide(0.02, 0.05);
  if (law == Law::linear)
    return linear;
  return std::make_shared<FrictionGlide>(linear, FrictionSettings{law == Law::friction ? 10.0 : 0.0, 2000});
}

void velocities(benchmark::State &state, const Law law, const VelocityMethod method, const bool warm)
{
  const Sources &s = sources();
  VelocitySolver solver(make(law), {.method = method});
  std::vector<Vec3> later = s.force;
  for (Vec3 &f : later)
    f *= 1 + 1e-3;
  solver.velocities(s.network, s.force, nullptr);
  const std::vector<Vec3> *next = &later; // forces alternate, by as much as a step may change them
  for (auto _ : state)
  {
    if (!warm)
      solver.forget();
    benchmark::DoNotOptimize(solver.velocities(s.network, *next, nullptr));
    next = next == &later ? &s.force : &later;
  }
  state.counters["us/node"] =
      benchmark::Counter(1e-6 * static_cast<double>(s.network.n_nodes()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["newton"] = solver.iterations().newton;
  state.counters["gradients"] = solver.iterations().gradients;
}

BENCHMARK_CAPTURE(velocities, local_linear, Law::linear, VelocityMethod::local, true)->UseRealTime();
BENCHMARK_CAPTURE(velocities, consistent_linear_cold, Law::linear, VelocityMethod::consistent, false)->UseRealTime();
BENCHMARK_CAPTURE(velocities, consistent_linear_warm, Law::linear, VelocityMethod::consistent, true)->UseRealTime();
BENCHMARK_CAPTURE(velocities, local_limited, Law::limited, VelocityMethod::local, true)->UseRealTime();
BENCHMARK_CAPTURE(velocities, local_friction, Law::friction, VelocityMethod::local, true)->UseRealTime();
BENCHMARK_CAPTURE(velocities, consistent_limited_cold, Law::limited, VelocityMethod::consistent, false)->UseRealTime();
BENCHMARK_CAPTURE(velocities, consistent_limited_warm, Law::limited, VelocityMethod::consistent, true)->UseRealTime();
} // namespace
