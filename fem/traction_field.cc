#include "fem/traction_field.h"

#include <algorithm>

namespace ddfem::fem
{
void TractionField::add_in_parallel(std::span<const unsigned> sources, double sign,
                                    std::span<const dealii::Point<3>> points,
                                    std::span<dealii::SymmetricTensor<2, 3>> values) const
{
  constexpr std::size_t portion = 64; // points that are evaluated together
#pragma omp parallel for schedule(dynamic)
  for (std::size_t first = 0; first < points.size(); first += portion)
  {
    const std::size_t n = std::min(portion, points.size() - first);
    std::vector<dealii::SymmetricTensor<2, 3>> stress(n);
    add_stress(sources, points.subspan(first, n), stress);
    for (std::size_t i = 0; i < n; ++i)
    {
      values[first + i] += sign * stress[i];
    }
  }
}

std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> TractionField::complete_sum(
    std::span<const BoundaryPoints> boundaries) const
{
  std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> result;
  for (const BoundaryPoints &b : boundaries)
  {
    auto &values = result.emplace_back(b.points.size());
    add_in_parallel(b.others, 1., b.points, values);
    add_in_parallel(b.vanishing, -1., b.points, values);
  }
  return result;
}
} // namespace ddfem::fem
