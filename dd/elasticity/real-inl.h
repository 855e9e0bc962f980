// Numbers for formulas that are written once: a double, or as many as the processor holds in a vector register.
//
// Formulas are templates on the number T = double (scalar reference) or T = Real (vectorised). Highway compiles this file, and
// all other *-inl.h that include it, once for every instruction set, in a namespace of its own, and chooses at run time: hence
// the guard, which lets a file in once for each of them. Products and sums are contracted by the compiler.

#if defined(DDFEM_DD_ELASTICITY_REAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_REAL_INL_H
#undef DDFEM_DD_ELASTICITY_REAL_INL_H
#else
#define DDFEM_DD_ELASTICITY_REAL_INL_H
#endif

#include "dd/elasticity/line_table.h"

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// At most as many lanes as a block of a LineTable has lines.
using Lanes = hn::CappedTag<double, LineTable::block_size>;
using Register = hn::Vec<Lanes>;
constexpr std::size_t n_register_lanes = hn::MaxLanes(Lanes());
/// Narrow registers go in pairs: a formula is one long chain of operations that wait for each other, and two chains fill the
/// gaps of one.
constexpr std::size_t n_registers = n_register_lanes < LineTable::block_size ? 2 : 1;
constexpr std::size_t n_lanes = n_registers * n_register_lanes;

struct Mask
{
  hn::Mask<Lanes> m[n_registers];
};

/// A vector of doubles with the arithmetic of one.
struct Real
{
  Register v[n_registers];

  HWY_INLINE Real() : Real(0.0) {}
  HWY_INLINE Real(const double x)
  {
    for (Register &r : v)
      r = hn::Set(Lanes(), x);
  }

  static HWY_INLINE Real load(const double *const p)
  {
    Real x;
    for (std::size_t i = 0; i < n_registers; ++i)
      x.v[i] = hn::LoadU(Lanes(), p + i * n_register_lanes);
    return x;
  }
  HWY_INLINE void store(double *const p) const
  {
    for (std::size_t i = 0; i < n_registers; ++i)
      hn::StoreU(v[i], Lanes(), p + i * n_register_lanes);
  }

  HWY_INLINE Real &operator+=(const Real &y)
  {
    for (std::size_t i = 0; i < n_registers; ++i)
      v[i] = hn::Add(v[i], y.v[i]);
    return *this;
  }
};

HWY_INLINE Real operator+(const Real &x, const Real &y)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Add(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real operator-(const Real &x, const Real &y)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Sub(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real operator*(const Real &x, const Real &y)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Mul(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real operator/(const Real &x, const Real &y)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Div(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real min(const Real &x, const Real &y)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Min(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real max(const Real &x, const Real &y)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Max(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real operator-(const Real &x)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Neg(x.v[i]);
  return z;
}
HWY_INLINE Real sqrt(const Real &x)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Sqrt(x.v[i]);
  return z;
}
HWY_INLINE Real abs(const Real &x)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Abs(x.v[i]);
  return z;
}
HWY_INLINE Mask operator<(const Real &x, const Real &y)
{
  Mask z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.m[i] = hn::Lt(x.v[i], y.v[i]);
  return z;
}
HWY_INLINE Real select(const Mask &condition, const Real &yes, const Real &no)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::IfThenElse(condition.m[i], yes.v[i], no.v[i]);
  return z;
}
HWY_INLINE bool any(const Mask &x)
{
  bool found = false;
  for (std::size_t i = 0; i < n_registers; ++i)
    found = found || !hn::AllFalse(Lanes(), x.m[i]);
  return found;
}
HWY_INLINE double sum_of_lanes(const Real &x)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < n_registers; ++i)
    sum += hn::GetLane(hn::SumOfLanes(Lanes(), x.v[i]));
  return sum;
}

using std::abs;
using std::max;
using std::min;
using std::sqrt;
HWY_INLINE double select(const bool condition, const double yes, const double no)
{
  return condition ? yes : no;
}
HWY_INLINE bool any(const bool x)
{
  return x;
}

/// A vector in space.
template <class T> struct Vector
{
  T x, y, z;

  HWY_INLINE Vector &operator+=(const Vector &b)
  {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
};
template <class T> HWY_INLINE Vector<T> operator+(const Vector<T> &a, const Vector<T> &b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> HWY_INLINE Vector<T> operator-(const Vector<T> &a, const Vector<T> &b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> HWY_INLINE Vector<T> operator*(const T &s, const Vector<T> &a)
{
  return {s * a.x, s * a.y, s * a.z};
}
template <class T> HWY_INLINE T dot(const Vector<T> &a, const Vector<T> &b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T> HWY_INLINE Vector<T> cross(const Vector<T> &a, const Vector<T> &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T, class Condition>
HWY_INLINE Vector<T> select(const Condition &condition, const Vector<T> &yes, const Vector<T> &no)
{
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}
/// The same vector in every lane.
template <class T> HWY_INLINE Vector<T> vector_of(const Vec3 &v)
{
  return {T(v[0]), T(v[1]), T(v[2])};
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
