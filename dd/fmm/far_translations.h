// The translations that the pairs of distant boxes of a tree need. Internal to dd/fmm.
#pragma once

#include "dd/fmm/accuracy.h"
#include "dd/fmm/far_passes.h"
#include "dd/fmm/half_line_translation.h"
#include "dd/fmm/translation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

namespace ddfem::fmm
{
/// One translation for every offset between boxes that occurs, of an order that its distance allows.
template <class Scalar> class FarTranslations
{
public:
  FarTranslations(const Octree &tree, const RootGrid &grid, const ExpansionOrders &orders_) : orders(orders_)
  {
    const Vec3 edges = grid.edges / grid.edges.maxCoeff();
    for (std::size_t root = 0; root < tree.levels()[1]; ++root)
      for (const FarLink &l : tree.far_links(root))
        for (const std::int16_t o : l.offset)
          largest_offset = std::max(largest_offset, std::abs(o));
    const int n = 2 * largest_offset + 1, volume = n * n * n;
    numbers.assign(static_cast<std::size_t>(volume), std::numeric_limits<std::uint32_t>::max());
    std::uint32_t n_translations = 0;
    for (std::size_t box = 0; box < tree.boxes().size(); ++box)
      for (const FarLink &l : tree.far_links(box))
        if (std::uint32_t &known = numbers[place(l.offset)]; known == std::numeric_limits<std::uint32_t>::max())
        {
          known = n_translations++;
          const Vec3 shift = -edges.cwiseProduct(Vec3(l.offset[0], l.offset[1], l.offset[2]));
          add(shift, distance_in_cubes(shift, edges));
        }
  }

  std::size_t size() const { return std::max(translations.size(), with_integrals.size()); }
  std::uint32_t number(const std::array<std::int16_t, 3> &offset) const { return numbers[place(offset)]; }
  const BasicTranslation<Scalar> &translation(std::uint32_t number) const { return translations[number]; }
  /// Instead, with antiderivatives.
  const HalfLineTranslation &integrals(std::uint32_t number) const { return with_integrals[number]; }

private:
  std::size_t place(const std::array<std::int16_t, 3> &offset) const
  {
    const int n = 2 * largest_offset + 1;
    const int k = ((offset[0] + largest_offset) * n + offset[1] + largest_offset) * n + offset[2] + largest_offset;
    return static_cast<std::size_t>(k);
  }

  void add(const Vec3 &shift, const double distance)
  {
    if (orders.n_antiderivatives == 0)
    {
      const int order = std::min(order_at_distance(orders.of_cubes, distance), orders.multipole);
      translations.emplace_back(Shift::far, order, shift);
      return;
    }
    // Boxes are cubes here, and shifts whole numbers.
    const long rho_squared = std::lround(shift[0] * shift[0] + shift[1] * shift[1]), z = std::lround(shift[2]);
    const int target_order = order_at_distance(orders.local(), shift.norm());
    with_integrals.emplace_back(
        half_line_matrices(orders.n_antiderivatives, orders.multipole, target_order, rho_squared, z), shift);
  }

  ExpansionOrders orders;
  int largest_offset = 3;
  std::vector<std::uint32_t> numbers; ///< by offset, a cube
  std::vector<BasicTranslation<Scalar>> translations;
  std::vector<HalfLineTranslation> with_integrals;
};
} // namespace ddfem::fmm
