// A number that counts the operations done with it: how many floating-point operations a formula takes.
#pragma once

#include <cmath>

namespace ddfem::benchmarks
{
/// Additions, multiplications, divisions and square roots count one each; comparisons, signs and choices nothing.
struct Counted
{
  double v;
  static inline long n = 0;

  explicit Counted(const double x = 0.0) : v(x) {}
  Counted &operator+=(const Counted &y)
  {
    ++n;
    v += y.v;
    return *this;
  }
};

inline Counted counted(const double x)
{
  ++Counted::n;
  return Counted(x);
}
inline Counted operator+(const Counted &x, const Counted &y)
{
  return counted(x.v + y.v);
}
inline Counted operator-(const Counted &x, const Counted &y)
{
  return counted(x.v - y.v);
}
inline Counted operator*(const Counted &x, const Counted &y)
{
  return counted(x.v * y.v);
}
inline Counted operator/(const Counted &x, const Counted &y)
{
  return counted(x.v / y.v);
}
inline Counted operator-(const Counted &x)
{
  return Counted(-x.v);
}
inline bool operator<(const Counted &x, const Counted &y)
{
  return x.v < y.v;
}
inline Counted sqrt(const Counted &x)
{
  return counted(std::sqrt(x.v));
}
inline Counted abs(const Counted &x)
{
  return Counted(std::abs(x.v));
}
inline Counted select(const bool condition, const Counted &yes, const Counted &no)
{
  return condition ? yes : no;
}
} // namespace ddfem::benchmarks
