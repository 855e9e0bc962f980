#include "coupling/dislocation_tractions.h"

#include "coupling/convert.h"

#include <algorithm>
#include <cmath>

namespace ddfem::coupling
{
double DislocationTractions::smooth_length(const dealii::Point<3> &centre, const double radius) const
{
  const double d = std::max(0.0, line_system.distance(to_vec3(centre)) - radius);
  return std::hypot(d, line_system.medium().a);
}

void DislocationTractions::smooth_lengths(const std::vector<dealii::Point<3>> &centres,
                                          const std::vector<double> &radii, std::vector<double> &lengths) const
{
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < centres.size(); ++i)
    lengths[i] = smooth_length(centres[i], radii[i]);
}

void DislocationTractions::stress(const std::vector<dealii::Point<3>> &points,
                                  std::vector<dealii::SymmetricTensor<2, 3>> &values) const
{
  std::vector<Vec3> positions(points.size());
  std::transform(points.begin(), points.end(), positions.begin(), [](const auto &p) { return to_vec3(p); });
  const std::vector<SymTensor> stresses = line_system.stress(positions);
  std::transform(stresses.begin(), stresses.end(), values.begin(),
                 [](const SymTensor &s) { return to_symmetric_tensor(s); });
}
} // namespace ddfem::coupling
