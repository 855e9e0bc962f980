// Numbers for formulas that are written once: a double, or as many as the processor holds in a vector register.
//
// Formulas are templates on the number T = double (scalar reference) or T = Real or Single (vectorised). Highway compiles this file, and
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

/// Numbers of type @p Scalar that are computed together: as many bytes as a block of a LineTable has for one row of doubles.
template <class Scalar> using LanesOf = hn::CappedTag<Scalar, LineTable::block_size * sizeof(double) / sizeof(Scalar)>;
template <class Scalar> constexpr std::size_t n_register_lanes = hn::MaxLanes(LanesOf<Scalar>());
/// Narrow registers go in pairs: a formula is one long chain of operations that wait for each other, and two chains fill the
/// gaps of one.
constexpr std::size_t n_registers = n_register_lanes<double> < LineTable::block_size ? 2 : 1;
template <class Scalar> constexpr std::size_t n_lanes_of = n_registers *n_register_lanes<Scalar>;

template <class Scalar> struct Mask
{
  hn::Mask<LanesOf<Scalar>> m[n_registers];

  friend HWY_INLINE bool any(const Mask &x)
  {
    bool found = false;
    for (std::size_t i = 0; i < n_registers; ++i)
      found = found || !hn::AllFalse(LanesOf<Scalar>(), x.m[i]);
    return found;
  }
};

/// A vector of numbers with the arithmetic of one.
template <class Scalar> struct Lanewise
{
  using Lanes = LanesOf<Scalar>;
  static constexpr std::size_t width = n_register_lanes<Scalar>;
  hn::Vec<Lanes> v[n_registers];

  HWY_INLINE Lanewise() : Lanewise(0.0) {}
  HWY_INLINE Lanewise(const double x)
  {
    for (auto &r : v)
      r = hn::Set(Lanes(), static_cast<Scalar>(x));
  }

  /// @p x in every lane.
  static HWY_INLINE Lanewise all(const Scalar x)
  {
    return each([&](std::size_t) HWY_ATTR { return hn::Set(Lanes(), x); });
  }
  static HWY_INLINE Lanewise load(const Scalar *const p)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::LoadU(Lanes(), p + i * width); });
  }
  HWY_INLINE void store(Scalar *const p) const
  {
    for (std::size_t i = 0; i < n_registers; ++i)
      hn::StoreU(v[i], Lanes(), p + i * width);
  }

  HWY_INLINE Lanewise &operator+=(const Lanewise &y) { return *this = *this + y; }

  friend HWY_INLINE Lanewise operator+(const Lanewise &x, const Lanewise &y)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Add(x.v[i], y.v[i]); });
  }
  friend HWY_INLINE Lanewise operator-(const Lanewise &x, const Lanewise &y)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Sub(x.v[i], y.v[i]); });
  }
  friend HWY_INLINE Lanewise operator*(const Lanewise &x, const Lanewise &y)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Mul(x.v[i], y.v[i]); });
  }
  friend HWY_INLINE Lanewise operator/(const Lanewise &x, const Lanewise &y)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Div(x.v[i], y.v[i]); });
  }
  friend HWY_INLINE Lanewise operator-(const Lanewise &x)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Neg(x.v[i]); });
  }
  friend HWY_INLINE Lanewise min(const Lanewise &x, const Lanewise &y)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Min(x.v[i], y.v[i]); });
  }
  friend HWY_INLINE Lanewise max(const Lanewise &x, const Lanewise &y)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Max(x.v[i], y.v[i]); });
  }
  friend HWY_INLINE Lanewise sqrt(const Lanewise &x)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Sqrt(x.v[i]); });
  }
  friend HWY_INLINE Lanewise abs(const Lanewise &x)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::Abs(x.v[i]); });
  }
  friend HWY_INLINE Mask<Scalar> operator<(const Lanewise &x, const Lanewise &y)
  {
    Mask<Scalar> z;
    for (std::size_t i = 0; i < n_registers; ++i)
      z.m[i] = hn::Lt(x.v[i], y.v[i]);
    return z;
  }
  friend HWY_INLINE Lanewise select(const Mask<Scalar> &condition, const Lanewise &yes, const Lanewise &no)
  {
    return each([&](const std::size_t i) HWY_ATTR { return hn::IfThenElse(condition.m[i], yes.v[i], no.v[i]); });
  }
  friend HWY_INLINE double sum_of_lanes(const Lanewise &x)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < n_registers; ++i)
      sum += hn::GetLane(hn::SumOfLanes(Lanes(), x.v[i]));
    return sum;
  }

private:
  /// Register by register.
  template <class Function> static HWY_INLINE Lanewise each(Function &&f)
  {
    Lanewise z(Unset{});
    for (std::size_t i = 0; i < n_registers; ++i)
      z.v[i] = f(i);
    return z;
  }
  struct Unset
  {
  };
  explicit HWY_INLINE Lanewise(Unset) {}
};

using Real = Lanewise<double>;
using Single = Lanewise<float>; ///< twice as many numbers, for fields where seven digits suffice
using Lanes = LanesOf<double>;
constexpr std::size_t n_lanes = n_lanes_of<double>;

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
