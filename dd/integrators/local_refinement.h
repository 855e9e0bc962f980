// Integration of the near forces over a step, with shorter steps for the nodes that need them.
#pragma once

#include "dd/integrators/far_forces.h"
#include "dd/integrators/node_paths.h"
#include "dd/integrators/split_forces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ddfem
{
/// Solves dx/dt = v(near forces + far forces of the step) by the strategy of Savcenco, Hundsdorfer & Verwer, BIT 47 (2007) 137: a step for
/// all nodes; those whose estimated error is too large take it again in parts, together with their neighbours, while the others follow the path that
/// they have, and so on. The step is that of Runge-Kutta-Chebyshev (ChebyshevSteps).
///
/// Stages follow the stiffness of most nodes of a set. The few that are stiffer are slowed down to what these stages bear, lambda_i -> the bound
/// of stability / h, which leaves them more than fast enough to follow the others, and are then integrated again as they are.
///
/// Results do not depend on the number of threads.
class LocalRefinement
{
public:
  /// All refer to what must outlive the object. Positions of @p network are used for the work and left anywhere.
  /// @p stiffness: bound of the spectral radius by node, 1/ns. @p tolerance: nm. Both by NodeIndex::value.
  LocalRefinement(Network &network, const SplitForces &forces, const NearForces &near,
                  const std::vector<double> &stiffness, const std::vector<double> &tolerance, double step);

  /// From @p positions at the start of the step to its end; false if the shortest steps do not suffice.
  bool solve(const FarForces &far, const std::vector<Vec3> &positions);
  /// The same once more, with other far forces, for the nodes @p changed, their neighbours, and those with shorter steps. All others keep their path.
  bool solve_again(const FarForces &far_forces, const std::vector<Vec3> &positions, std::vector<NodeIndex> changed);
  /// Positions at the end of the step, nm, by NodeIndex::value.
  const std::vector<Vec3> &positions() const { return y; }

  /// So far: evaluations of single segments, nodes that took shorter steps at least once.
  std::size_t segment_evaluations() const { return n_evaluated; }
  std::size_t refined_nodes() const;
  /// Where nodes with shorter steps have been within the last step.
  const NodePaths &paths() const { return way; }

private:
  /// Cubic path of a node over an interval.
  struct Path
  {
    double begin = 0, duration = 0; ///< ns; no duration: at rest
    Vec3 start = Vec3::Zero(), displacement = Vec3::Zero();
    Vec3 velocity_at_start = Vec3::Zero(), velocity_at_end = Vec3::Zero();
    Vec3 at(double time) const;
  };
  struct Interval
  {
    double begin, duration; ///< ns
  };
  /// Nodes that are integrated together, what acts on them, and the nodes on whose paths that depends.
  struct Group
  {
    std::vector<NodeIndex> nodes, boundary;
    std::vector<SegmentIndex> segments;
    std::vector<std::uint32_t> first_arm, arms; ///< of each node, in `segments`
  };
  struct Outcome
  {
    std::vector<NodeIndex> inaccurate, slowed;
    double worst = 0; ///< error in tolerances
  };
  Group group_of(std::vector<NodeIndex> nodes);
  std::vector<NodeIndex> with_neighbours(const std::vector<NodeIndex> &among, const std::vector<NodeIndex> &nodes);
  std::vector<NodeIndex> moving_nodes() const;
  void place_boundary(const Group &group, double time);
  std::vector<Vec3> velocities(const Group &group, double time, double fastest);
  Outcome step(const Group &group, const Interval &interval, unsigned n_stages);
  bool advance(const Group &group, const Interval &interval, unsigned depth, bool all_stages);
  bool advance_in_parts(const Group &group, const Interval &interval, unsigned depth, double worst);
  double stiffness_of(const Group &group, bool of_most) const;
  void restore(const Group &group, const std::vector<Vec3> &places);

  Network &network;
  const SplitForces &forces;
  const NearForces &near;
  const std::vector<double> &stiffness, &tolerance;
  const double whole; ///< step, ns
  const FarForces *far = nullptr;
  std::vector<Vec3> y; ///< where the last step of each node has ended
  std::vector<Path> path_of;
  NodePaths way;
  std::vector<std::uint32_t> node_mark, segment_mark; ///< == mark: belongs to the set being made
  std::vector<std::uint32_t> number;                  ///< in that set
  std::uint32_t mark = 0;
  std::vector<std::uint8_t> is_refined;
  std::size_t n_evaluated = 0;
};
} // namespace ddfem
