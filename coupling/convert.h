// Between the tensor types of dd/ (Eigen) and fem/ (deal.II).
#pragma once

#include "dd/common/types.h"

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

namespace ddfem::coupling
{
inline Vec3 to_vec3(const dealii::Tensor<1, 3> &v)
{
  return {v[0], v[1], v[2]};
}

inline dealii::Tensor<1, 3> to_tensor(const Vec3 &v)
{
  dealii::Tensor<1, 3> t;
  t[0] = v[0];
  t[1] = v[1];
  t[2] = v[2];
  return t;
}

inline dealii::Point<3> to_point(const Vec3 &v)
{
  return {v[0], v[1], v[2]};
}

inline std::vector<Vec3> to_vectors(const std::span<const dealii::Point<3>> points)
{
  std::vector<Vec3> result;
  result.reserve(points.size());
  std::transform(points.begin(), points.end(), std::back_inserter(result), to_vec3);
  return result;
}

inline std::vector<dealii::Point<3>> to_points(const std::span<const Vec3> vectors)
{
  std::vector<dealii::Point<3>> result;
  result.reserve(vectors.size());
  std::transform(vectors.begin(), vectors.end(), std::back_inserter(result), to_point);
  return result;
}

inline SymTensor to_sym_tensor(const dealii::SymmetricTensor<2, 3> &s)
{
  SymTensor t;
  t << s[0][0], s[1][1], s[2][2], s[0][1], s[0][2], s[1][2];
  return t;
}

inline dealii::SymmetricTensor<2, 3> to_symmetric_tensor(const SymTensor &t)
{
  dealii::SymmetricTensor<2, 3> s;
  s[0][0] = t[0];
  s[1][1] = t[1];
  s[2][2] = t[2];
  s[0][1] = t[3];
  s[0][2] = t[4];
  s[1][2] = t[5];
  return s;
}
} // namespace ddfem::coupling
