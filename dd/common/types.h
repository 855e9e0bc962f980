// Vectors, stresses and small tensor helpers shared by everything below dd/.
#pragma once

#include <Eigen/Dense>

#include <cstdint>

namespace ddfem
{
/// A point or vector in the sample frame; lengths in nm.
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Symmetric second-order tensor stored as xx yy zz xy xz yz (stresses in MPa).
using SymTensor = Eigen::Matrix<double, 6, 1>;

/// Persistent identifier of a node or segment: never reused, independent of memory order, threads and ranks.
using ObjectId = std::uint64_t;

/// The full 3x3 matrix of @p s.
inline Mat3 to_matrix(const SymTensor &s)
{
  Mat3 m;
  m << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  return m;
}

/// Symmetric part of @p m in the order xx yy zz xy xz yz.
inline SymTensor symmetric_part(const Mat3 &m)
{
  SymTensor s;
  s << m(0, 0), m(1, 1), m(2, 2), 0.5 * (m(0, 1) + m(1, 0)), 0.5 * (m(0, 2) + m(2, 0)), 0.5 * (m(1, 2) + m(2, 1));
  return s;
}

/// Contraction s . v of a symmetric tensor with a vector, e.g. the traction of a stress on a plane of unit normal v.
inline Vec3 contract(const SymTensor &s, const Vec3 &v)
{
  return {s[0] * v[0] + s[3] * v[1] + s[4] * v[2], s[3] * v[0] + s[1] * v[1] + s[5] * v[2],
          s[4] * v[0] + s[5] * v[1] + s[2] * v[2]};
}

/// Double contraction a : b of two symmetric tensors.
inline double double_contract(const SymTensor &a, const SymTensor &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}
} // namespace ddfem
