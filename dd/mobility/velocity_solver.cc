#include "dd/mobility/velocity_solver.h"

#include <numeric>
#include <stdexcept>

namespace ddfem
{
namespace
{
/// Largest eigenvalue of the pencil of two symmetric matrices in the range of the projector @p p; @p a is positive there.
double largest_eigenvalue(const Mat3 &k, const Mat3 &a, const Mat3 &p)
{
  const Mat3 rest = Mat3::Identity() - p;
  const Mat3 stiffness = p * k * p, drag = p * a * p + a.trace() * rest;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Mat3>(stiffness, drag, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}
} // namespace

std::vector<Vec3> VelocitySolver::velocities(const Network &network, const std::vector<Vec3> &force,
                                             const GrainShape *shape)
{
  if (settings.method == VelocityMethod::local)
    return glide_velocities(network, force, *mobility, shape, settings.sliding_drag);
  if (last_clean != network.n_cleans())
    last.clear();
  last_clean = network.n_cleans();
  ConsistentVelocities system(network, *mobility, shape, settings.sliding_drag);
  last = system.solve(force, last);
  count = system.iterations();
  return last;
}

template <class StiffnessOfNode>
std::vector<double> VelocitySolver::rates(const Network &network, const GrainShape *shape,
                                          StiffnessOfNode &&stiffness_of) const
{
  std::vector<double> of_node(network.node_capacity(), 0.0);
  network.for_each_node(
      [&](const NodeIndex i)
      {
        const Mat3 directions = directions_of_motion(network, i, *mobility, shape);
        if (directions.isZero(0) || network.degree(i) == 0)
          return;
        const std::vector<NodalArm> arms = arms_of(network, i);
        Mat3 a = Mat3::Zero();
        for (const NodalArm &arm : arms)
        {
          const Mat3 along = arm.line.direction * arm.line.direction.transpose(), across = Mat3::Identity() - along;
          a += 0.5 * arm.length * mobility->drag(arm.line) * (across + settings.sliding_drag * along);
        }
        of_node[i.value] = (settings.method == VelocityMethod::consistent ? 3 : 1) *
                           largest_eigenvalue(stiffness_of(i, arms), a, directions);
      });
  return of_node;
}

Vec3 VelocitySolver::velocity_of_node(const Network &network, const NodeIndex i, const Vec3 &force,
                                      const GrainShape *shape) const
{
  if (settings.method == VelocityMethod::consistent)
    throw std::logic_error("consistent velocities are those of all nodes");
  return glide_velocity(network, i, force, *mobility, shape, settings.sliding_drag);
}

std::vector<double> VelocitySolver::drag_of_nodes(const Network &network) const
{
  std::vector<double> drag(network.node_capacity(), 0.0);
  for (const NodeIndex i : network.nodes())
    drag[i.value] = nodal_drag(network, i, *mobility);
  return drag;
}

std::vector<double> VelocitySolver::stiffness(const Network &network, const double tension,
                                              const GrainShape *shape) const
{
  return rates(network, shape,
               [&](NodeIndex, const std::vector<NodalArm> &arms)
               {
                 Mat3 k = Mat3::Zero();
                 for (const NodalArm &arm : arms)
                   k += tension / arm.length * (Mat3::Identity() - arm.line.direction * arm.line.direction.transpose());
                 return Mat3(2 * k);
               });
}

double VelocitySolver::largest_power(const Network &network, const std::vector<Vec3> &force,
                                     const GrainShape *shape) const
{
  const std::vector<double> of_node = rates(network, shape,
                                            [&](const NodeIndex i, const std::vector<NodalArm> &)
                                            { return Mat3(force[i.value] * force[i.value].transpose()); });
  return std::accumulate(of_node.begin(), of_node.end(), 0.0);
}
} // namespace ddfem
