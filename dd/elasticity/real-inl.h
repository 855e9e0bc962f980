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
/// At most as many lanes as a block of a LineTable has lines.
using Lanes = hwy::HWY_NAMESPACE::CappedTag<double, LineTable::block_size>;
using Register = hwy::HWY_NAMESPACE::Vec<Lanes>;
constexpr std::size_t n_lanes = hwy::HWY_NAMESPACE::MaxLanes(Lanes());

struct Mask
{
  hwy::HWY_NAMESPACE::Mask<Lanes> m;
};

/// A vector of doubles with the arithmetic of one.
struct Real
{
  Register v;

  HWY_INLINE Real() : v(hwy::HWY_NAMESPACE::Zero(Lanes())) {}
  HWY_INLINE Real(const Register x) : v(x) {}
  HWY_INLINE Real(const double x) : v(hwy::HWY_NAMESPACE::Set(Lanes(), x)) {}

  static HWY_INLINE Real load(const double *const p) { return hwy::HWY_NAMESPACE::LoadU(Lanes(), p); }
  HWY_INLINE void store(double *const p) const { hwy::HWY_NAMESPACE::StoreU(v, Lanes(), p); }

  HWY_INLINE Real &operator+=(const Real &y)
  {
    v = hwy::HWY_NAMESPACE::Add(v, y.v);
    return *this;
  }
  HWY_INLINE Real &operator*=(const Real &y)
  {
    v = hwy::HWY_NAMESPACE::Mul(v, y.v);
    return *this;
  }
};

HWY_INLINE Real operator+(const Real &x, const Real &y)
{
  return hwy::HWY_NAMESPACE::Add(x.v, y.v);
}
HWY_INLINE Real operator-(const Real &x, const Real &y)
{
  return hwy::HWY_NAMESPACE::Sub(x.v, y.v);
}
HWY_INLINE Real operator*(const Real &x, const Real &y)
{
  return hwy::HWY_NAMESPACE::Mul(x.v, y.v);
}
HWY_INLINE Real operator/(const Real &x, const Real &y)
{
  return hwy::HWY_NAMESPACE::Div(x.v, y.v);
}
HWY_INLINE Real operator-(const Real &x)
{
  return hwy::HWY_NAMESPACE::Neg(x.v);
}
HWY_INLINE Mask operator<(const Real &x, const Real &y)
{
  return {hwy::HWY_NAMESPACE::Lt(x.v, y.v)};
}
HWY_INLINE Mask operator&(const Mask &x, const Mask &y)
{
  return {hwy::HWY_NAMESPACE::And(x.m, y.m)};
}
HWY_INLINE Real sqrt(const Real &x)
{
  return hwy::HWY_NAMESPACE::Sqrt(x.v);
}
HWY_INLINE Real abs(const Real &x)
{
  return hwy::HWY_NAMESPACE::Abs(x.v);
}
HWY_INLINE Real min(const Real &x, const Real &y)
{
  return hwy::HWY_NAMESPACE::Min(x.v, y.v);
}
HWY_INLINE Real max(const Real &x, const Real &y)
{
  return hwy::HWY_NAMESPACE::Max(x.v, y.v);
}
HWY_INLINE Real select(const Mask &condition, const Real &yes, const Real &no)
{
  return hwy::HWY_NAMESPACE::IfThenElse(condition.m, yes.v, no.v);
}
HWY_INLINE bool any(const Mask &x)
{
  return !hwy::HWY_NAMESPACE::AllFalse(Lanes(), x.m);
}
HWY_INLINE bool all(const Mask &x)
{
  return hwy::HWY_NAMESPACE::AllTrue(Lanes(), x.m);
}
HWY_INLINE double sum_of_lanes(const Real &x)
{
  return hwy::HWY_NAMESPACE::GetLane(hwy::HWY_NAMESPACE::SumOfLanes(Lanes(), x.v));
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
HWY_INLINE bool all(const bool x)
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
