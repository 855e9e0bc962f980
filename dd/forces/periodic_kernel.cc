#include "dd/forces/periodic_kernel.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr double pi = std::numbers::pi;
constexpr double inverse_sqrt_pi = std::numbers::inv_sqrtpi;

// exp(-38.5) = 2e-17: both Ewald sums stop where the Gaussian is below rounding.
constexpr double gaussian_exponent_limit = 38.5;

// For a radial f with D1 = f'/R, D2 = D1'/R, D3 = D2'/R:
// d_ijk f = D3 x_i x_j x_k + D2 (delta_ij x_k + delta_ik x_j + delta_jk x_i).
void add_radial(const Vec3 &r, double d2, double d3, ThirdDerivatives &sum)
{
  const double x = r[0], y = r[1], z = r[2];
  sum[0] += x * (d3 * x * x + 3 * d2);
  sum[1] += y * (d3 * x * x + d2);
  sum[2] += z * (d3 * x * x + d2);
  sum[3] += x * (d3 * y * y + d2);
  sum[4] += d3 * x * y * z;
  sum[5] += x * (d3 * z * z + d2);
  sum[6] += y * (d3 * y * y + 3 * d2);
  sum[7] += z * (d3 * y * y + d2);
  sum[8] += y * (d3 * z * z + d2);
  sum[9] += z * (d3 * z * z + 3 * d2);
}

struct BoysPair
{
  double first, second;
};

// Boys functions F_n(t) = int_0^1 s^(2n) exp(-t s^2) ds for n = 1, 2. Small t: the all-positive series of F_2 and the
// downward recursion; large t: upward from F_0, where 1/t is small enough for the differences to be harmless.
BoysPair boys_functions(double t)
{
  const double gaussian = std::exp(-t);
  if (t > 6.0)
  {
    const double zeroth = 0.5 * std::sqrt(pi / t) * std::erf(std::sqrt(t));
    const double first = (zeroth - gaussian) / (2 * t);
    return {first, (3 * first - gaussian) / (2 * t)};
  }
  double term = 0.2, second = term;
  for (double n = 7; term > 1e-17 * second; n += 2)
  {
    term *= 2 * t / n;
    second += term;
  }
  second *= gaussian;
  return {(2 * t * second + gaussian) / 3, second};
}

bool in_positive_half_space(int nx, int ny, int nz)
{
  return nx > 0 || (nx == 0 && (ny > 0 || (ny == 0 && nz > 0)));
}

// Calls f(nx, ny, nz) for all |n_i| <= limit_i in lexicographic order.
template <typename Function> void for_each_index(const std::array<int, 3> &limit, const Function &f)
{
  for (int nx = -limit[0]; nx <= limit[0]; ++nx)
    for (int ny = -limit[1]; ny <= limit[1]; ++ny)
      for (int nz = -limit[2]; nz <= limit[2]; ++nz)
        f(nx, ny, nz);
}

std::array<int, 3> limits(const Vec3 &bounds)
{
  return {static_cast<int>(std::ceil(bounds[0])), static_cast<int>(std::ceil(bounds[1])),
          static_cast<int>(std::ceil(bounds[2]))};
}
} // namespace

std::vector<Vec3> near_image_shifts(const Vec3 &lengths)
{
  std::vector<Vec3> shifts{Vec3::Zero()};
  for_each_index({1, 1, 1},
                 [&](int nx, int ny, int nz)
                 {
                   if (nx != 0 || ny != 0 || nz != 0)
                     shifts.emplace_back(Vec3(nx, ny, nz).cwiseProduct(lengths));
                 });
  return shifts;
}

PeriodicKernel::PeriodicKernel(const Vec3 &lengths, double alpha) : edges(lengths)
{
  if (!(lengths.minCoeff() > 0) || !lengths.allFinite())
    throw std::invalid_argument("the edge lengths of a periodic cell must be positive");
  if (!(alpha >= 0))
    throw std::invalid_argument("the Ewald splitting parameter must not be negative");
  const double volume = lengths.prod();
  splitting = alpha > 0 ? alpha : 1 / (std::cbrt(volume) * inverse_sqrt_pi);
  cutoff = std::sqrt(gaussian_exponent_limit) / splitting;

  const double largest_wave = 2 * splitting * std::sqrt(gaussian_exponent_limit);
  for_each_index(limits(largest_wave / (2 * pi) * lengths),
                 [&](int nx, int ny, int nz)
                 {
                   const Vec3 k = 2 * pi * Vec3(nx, ny, nz).cwiseQuotient(edges);
                   const double k2 = k.squaredNorm(), q = k2 / (4 * splitting * splitting);
                   if (in_positive_half_space(nx, ny, nz) && q < gaussian_exponent_limit)
                     waves.push_back({k, -16 * pi / (volume * k2 * k2) * (1 + q) * std::exp(-q)});
                 });
}

ThirdDerivatives PeriodicKernel::operator()(const Vec3 &x) const
{
  ThirdDerivatives sum{};
  add_removed_images(x, sum);
  add_short_range_images(x, sum);
  add_waves(x, sum);
  return sum;
}

// S - R = -W of the 27 boxes that are summed in closed form elsewhere. W' / R = erf(alpha R) / R is
// 2 alpha/sqrt(pi) F_0(alpha^2 R^2), and each further (1/R) d/dR turns F_n into -2 alpha^2 F_(n+1).
void PeriodicKernel::add_removed_images(const Vec3 &x, ThirdDerivatives &sum) const
{
  const double alpha2 = splitting * splitting, factor = 4 * splitting * alpha2 * inverse_sqrt_pi;
  for_each_index({1, 1, 1},
                 [&](int nx, int ny, int nz)
                 {
                   const Vec3 r = x - Vec3(nx, ny, nz).cwiseProduct(edges);
                   const BoysPair boys = boys_functions(alpha2 * r.squaredNorm());
                   add_radial(r, factor * boys.first, -2 * factor * alpha2 * boys.second, sum);
                 });
}

void PeriodicKernel::add_short_range_images(const Vec3 &x, ThirdDerivatives &sum) const
{
  const Vec3 reach = (x.cwiseAbs() + Vec3::Constant(cutoff)).cwiseQuotient(edges);
  for_each_index(limits(reach),
                 [&](int nx, int ny, int nz)
                 {
                   if (std::abs(nx) <= 1 && std::abs(ny) <= 1 && std::abs(nz) <= 1)
                     return;
                   const Vec3 r = x - Vec3(nx, ny, nz).cwiseProduct(edges);
                   const double r2 = r.squaredNorm();
                   if (r2 > cutoff * cutoff)
                     return;
                   const double distance = std::sqrt(r2), u = splitting * distance, complement = std::erfc(u);
                   const double gaussian = 2 * u * inverse_sqrt_pi * std::exp(-u * u);
                   const double d2 = -(complement + gaussian) / (r2 * distance);
                   add_radial(r, d2, (3 * complement + (3 + 2 * u * u) * gaussian) / (r2 * r2 * distance), sum);
                 });
}

// d_ijk of 2 W cos(k.x) is 2 W k_i k_j k_k sin(k.x).
void PeriodicKernel::add_waves(const Vec3 &x, ThirdDerivatives &sum) const
{
  for (const Wave &wave : waves)
    add_radial(wave.k, 0.0, wave.coefficient * std::sin(wave.k.dot(x)), sum);
}
} // namespace ddfem
