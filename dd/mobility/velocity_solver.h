// From nodal forces to nodal velocities.
#pragma once

#include "dd/mobility/consistent_velocities.h"
#include "dd/mobility/local_velocities.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace ddfem
{
enum class VelocityMethod
{
  local,      ///< node by node: glide_velocities()
  consistent, ///< all nodes at once: ConsistentVelocities
};

struct VelocitySettings
{
  VelocityMethod method = VelocityMethod::local;
  /// Drag on the sliding of nodes along their lines, in parts of the drag across them. It has no physical meaning: a junction whose end slides
  /// along it only grows. Nodes of three and more arms and ends of junctions feel it, discretisation nodes do not slide.
  double sliding_drag = 0.1;
};

/// The velocities of a network by either method, from one evaluation to the next: the consistent ones start from the last.
class VelocitySolver
{
public:
  explicit VelocitySolver(MobilityPointer law, const VelocitySettings &velocity_settings = {})
      : mobility(std::move(law)), settings(velocity_settings)
  {
  }

  /// Velocities, nm/ns, by NodeIndex::value, for nodal forces @p force, MPa nm^2. @p shape: null without a surface.
  std::vector<Vec3> velocities(const Network &network, const std::vector<Vec3> &force, const GrainShape *shape);

  /// Velocity (nm/ns) of one node under the force @p force (MPa nm^2). Throws std::logic_error for consistent velocities, of which no node has one
  /// of its own.
  Vec3 velocity_of_node(const Network &network, NodeIndex i, const Vec3 &force, const GrainShape *shape) const;
  /// nodal_drag(), MPa ns nm, by NodeIndex::value.
  std::vector<double> drag_of_nodes(const Network &network) const;

  /// Upper bounds by node, 1/ns, of the spectral radius of d(velocity)/d(position) for lines of tension @p tension, MPa nm^2. With K_i = T sum (1/L)
  /// (1 - xi xi) and A_i = sum (L/2) B (1 - xi xi + beta xi xi) over the arms of node i, in the directions in which it can
  /// move, local velocities have 2 lambda(A_i^-1 K_i), since a segment's stiffness T/L [1 -1; -1 1] is not more than twice its
  /// diagonal. Consistent ones have three times as much: B L [1/3 1/6; 1/6 1/3] is not less than B L/6.
  std::vector<double> stiffness(const Network &network, double tension, const GrainShape *shape) const;

  /// Power of nodal forces (MPa nm^2) on the velocities that they alone would give with the drag() of the lines, MPa nm^3/ns: sum of f . A_i^-1 f;
  /// for consistent velocities three times that, an upper bound.
  double largest_power(const Network &network, const std::vector<Vec3> &force, const GrainShape *shape) const;

  /// What the last call took; zero for local velocities.
  const VelocityIterations &iterations() const { return count; }
  /// Lets the next call start from rest, as after a restart.
  void forget() { last.clear(); }

  const MobilityLaw &law() const { return *mobility; }

private:
  /// Largest eigenvalues, node by node, of A_i^-1 times a matrix of the node and its arms.
  template <class StiffnessOfNode>
  std::vector<double> rates(const Network &network, const GrainShape *shape, StiffnessOfNode &&stiffness_of) const;

  MobilityPointer mobility;
  VelocitySettings settings;
  std::vector<Vec3> last;
  std::size_t last_clean = 0; ///< Network::n_cleans() to which `last` belongs
  VelocityIterations count;
};
} // namespace ddfem
