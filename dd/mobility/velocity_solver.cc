#include "dd/mobility/velocity_solver.h"

#include <algorithm>

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

double VelocitySolver::stiffness(const Network &network, const double tension, const GrainShape *shape) const
{
  std::vector<double> of_node(network.node_capacity(), 0.0);
  network.for_each_node(
      [&](const NodeIndex i)
      {
        const Mat3 directions = directions_of_motion(network, i, *mobility, shape);
        if (directions.isZero(0) || network.degree(i) == 0)
          return;
        Mat3 k = Mat3::Zero(), a = Mat3::Zero();
        for (const NodalArm &arm : arms_of(network, i))
        {
          const Mat3 along = arm.line.direction * arm.line.direction.transpose(), across = Mat3::Identity() - along;
          k += tension / arm.length * across;
          a += 0.5 * arm.length * mobility->drag(arm.line) * (across + settings.sliding_drag * along);
        }
        of_node[i.value] = 2 * largest_eigenvalue(k, a, directions);
      });
  const double largest = of_node.empty() ? 0.0 : *std::max_element(of_node.begin(), of_node.end());
  return settings.method == VelocityMethod::consistent ? 3 * largest : largest;
}
} // namespace ddfem
