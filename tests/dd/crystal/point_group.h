// Point groups of the crystals, generated from their generators.
#pragma once

#include "dd/common/types.h"
#include "dd/crystal/lattice.h"

#include <numbers>
#include <vector>

namespace ddfem::test
{
/// All products of @p generators (Cartesian crystal frame), the identity included.
inline std::vector<Mat3> generated_group(const std::vector<Mat3> &generators)
{
  std::vector<Mat3> group = {Mat3::Identity()};
  for (std::size_t k = 0; k < group.size(); ++k)
    for (const Mat3 &g : generators)
    {
      const Mat3 product = g * group[k];
      bool known = false;
      for (const Mat3 &member : group)
        known = known || (member - product).cwiseAbs().maxCoeff() < 1e-9;
      if (!known)
        group.push_back(product);
    }
  return group;
}

inline Mat3 rotation_about(const Vec3 &axis, const double degrees)
{
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
}

/// m-3m of fcc and bcc: fourfold [001], threefold [111], inversion. 6/mmm of hcp: sixfold c, twofold a1, inversion.
/// (The structure hcp has that point group too, its sixfold axis being a screw axis.)
inline std::vector<Mat3> point_group(const Lattice lattice)
{
  const Mat3 inversion = -Mat3::Identity();
  if (lattice == Lattice::hcp)
    return generated_group({rotation_about(Vec3::UnitZ(), 60), rotation_about(Vec3::UnitX(), 180), inversion});
  return generated_group({rotation_about(Vec3::UnitZ(), 90), rotation_about(Vec3(1, 1, 1), 120), inversion});
}
} // namespace ddfem::test
