// Shifts of multipole and local expansions in solid harmonics, by rotation to the z axis and back.
//
// Multipole coefficients about c: M_lm = s^-l sum q S_lm(y - c); local ones: potential sum q/R = 1/s sum L_lm S_lm((x - c)/s),
// with s the size of the box: translations between boxes of a level are then the same on every level. A translation costs
// O(p^3) instead of O(p^4) (White & Head-Gordon, J. Chem. Phys. 105 (1996) 5061; Greengard & Rokhlin, Acta Numerica 6
// (1997) 229, section 5).
#pragma once

#include "dd/common/types.h"
#include "dd/fmm/solid_harmonics.h"

#include <array>
#include <map>
#include <memory>
#include <vector>

namespace ddfem::fmm
{
enum class Shift : std::uint8_t
{
  child_to_parent, ///< multipole to multipole, of half the size to the whole; vector: child - parent centre
  far,             ///< multipole to local, boxes of one size; vector: target - source centre
  parent_to_child, ///< local to local; vector: child - parent centre
};

/// One translation; @p vector in units of the (parent) box size. Scalar: double or float.
template <class Scalar> class BasicTranslation
{
public:
  BasicTranslation(Shift kind, int order, const Vec3 &vector);

  /// Adds the translated expansions to @p target. @p source and @p target hold n_harmonics(order) rows: eight expansions side by
  /// side. Different source and target; safe to call from any thread.
  void add(const typename Precision<Scalar>::Narrow::Row *source,
           typename Precision<Scalar>::Narrow::Row *target) const;
  /// The same of two.
  void add_two(const std::array<const typename Precision<Scalar>::Narrow::Row *, 2> &source,
               const std::array<typename Precision<Scalar>::Narrow::Row *, 2> &target) const;
  /// The same of as many expansions as a wide row holds.
  void add_wide(const typename Precision<Scalar>::Wide::Row *source,
                typename Precision<Scalar>::Wide::Row *target) const;

  int order() const { return order_; }
  const Vec3 &vector() const { return vector_; } ///< in units of the box size

private:
  int order_;
  Vec3 vector_;
  std::vector<Scalar> phase;                                     ///< cos(m phi), sin(m phi)
  std::shared_ptr<const std::vector<Scalar>> rotation, backward; ///< to the axis and (transposed) back
  std::vector<Scalar> axial;                                     ///< one square matrix for every m >= 0
};
using Translation = BasicTranslation<double>;
} // namespace ddfem::fmm
