#include "dd/fmm/translation.h"

#include "dd/fmm/row_products.h"

#include <array>
#include <cmath>
#include <mutex>

namespace ddfem::fmm
{
namespace
{
using Blocks = std::shared_ptr<const std::vector<double>>;

/// Transposes every block of rotation_about_y().
std::vector<double> transposed(const int order, const std::vector<double> &blocks)
{
  std::vector<double> result;
  result.reserve(blocks.size());
  std::size_t begin = 0;
  for (int l = 0; l <= order; ++l)
    for (const int size : {l + 1, l})
    {
      const auto n = static_cast<std::size_t>(size);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          result.push_back(blocks[begin + j * n + i]);
      begin += n * n;
    }
  return result;
}

/// Both directions of a rotation; few angles occur, and all are kept. They are numbers of the angle and the order alone.
std::pair<Blocks, Blocks> rotation_pair(const int order, const double cos_theta, const double sin_theta)
{
  static std::map<std::pair<int, long>, std::pair<Blocks, Blocks>> known;
  static std::mutex access;
  const std::lock_guard lock(access);
  // Angles that differ by rounding share an entry; the first one is as good as the others.
  auto &entry = known[{order, std::lround(std::atan2(sin_theta, cos_theta) * 1e13)}];
  if (!entry.first)
  {
    const auto blocks = rotation_about_y(order, cos_theta, sin_theta);
    entry = {std::make_shared<const std::vector<double>>(blocks),
             std::make_shared<const std::vector<double>>(transposed(order, blocks))};
  }
  return entry;
}

/// sqrt(n!), up to the largest sum of two degrees.
struct RootFactorials
{
  std::array<double, 2 * max_order + 1> value{1.0};

  RootFactorials()
  {
    for (std::size_t n = 1; n < value.size(); ++n)
      value[n] = value[n - 1] * std::sqrt(static_cast<double>(n));
  }
};

double root_factorial(const int n)
{
  static const RootFactorials known;
  return known.value[static_cast<std::size_t>(n)];
}

double factorial(const int n)
{
  return root_factorial(n) * root_factorial(n);
}

/// The normalisation sqrt((l-m)! (l+m)!) that turns r^l P_l^m/(l+m)! into r^l C_lm.
double norm(const int l, const int m)
{
  return root_factorial(l - m) * root_factorial(l + m);
}

/// Element (to, from) of the translation along z (Greengard & Rokhlin 1997, eqs. 5.13-5.15, renormalised). @p power: of the
/// distance, or of its inverse for Shift::far.
double axial_element(const Shift kind, const int m, const int to, const int from, const std::vector<double> &power)
{
  const auto power_of = [&](int n) { return power[static_cast<std::size_t>(n)]; };
  switch (kind)
  {
    case Shift::far:
      return ((m + to) % 2 == 0 ? 1.0 : -1.0) * factorial(to + from) / (norm(to, m) * norm(from, m)) *
             power_of(to + from + 1);
    case Shift::child_to_parent:
      return from > to
                 ? 0.0
                 : norm(to, m) / (norm(from, m) * factorial(to - from)) * power_of(to - from) * std::ldexp(1.0, -from);
    case Shift::parent_to_child:
      return from < to ? 0.0
                       : norm(from, m) / (norm(to, m) * factorial(from - to)) * power_of(from - to) *
                             std::ldexp(1.0, -to - 1);
  }
  return 0.0;
}

/// Position in the order in which the matrices along the axis are contiguous: by m (cosines, then sines), then by l.
struct AxialOrder
{
  std::array<std::uint16_t, n_harmonics(max_order)> of_harmonic{};

  explicit AxialOrder(const int order)
  {
    std::uint16_t next = 0;
    for (int m = 0; m <= order; ++m)
      for (const int sign : {1, -1})
        if (m > 0 || sign > 0)
          for (int l = m; l <= order; ++l)
            of_harmonic[harmonic_index(l, sign * m)] = next++;
  }
};

const std::uint16_t *axial_order(const int order)
{
  static const std::vector<AxialOrder> all = []
  {
    std::vector<AxialOrder> orders;
    for (int p = 0; p <= max_order; ++p)
      orders.emplace_back(p);
    return orders;
  }();
  return all[static_cast<std::size_t>(order)].of_harmonic.data();
}

DDFEM_FMM_EVERY_PROCESSOR
void translate(const int order, const double *phase, const double *rotation, const double *axial,
               const double *backward, const std::uint16_t *axial_place, const Row *source, Row *target)
{
  alignas(row_size) Row a[n_harmonics(max_order)];
  alignas(row_size) Row b[n_harmonics(max_order)];
  turn_to_axis(order, phase, source, a);
  for (int l = 0; l <= order; ++l)
  {
    const std::size_t zero = harmonic_index(l, 0);
    const auto n = static_cast<std::size_t>(l);
    multiply(
        rotation, n + 1, n + 1, a, [zero](std::size_t j) { return zero + j; }, b,
        [zero, axial_place](std::size_t i) { return std::size_t{axial_place[zero + i]}; });
    rotation += (n + 1) * (n + 1);
    multiply(
        rotation, n, n, a, [zero](std::size_t j) { return zero - 1 - j; }, b,
        [zero, axial_place](std::size_t i) { return std::size_t{axial_place[zero - 1 - i]}; });
    rotation += n * n;
  }
  std::size_t begin = 0;
  for (int m = 0; m <= order; ++m)
  {
    const auto n = static_cast<std::size_t>(order + 1 - m);
    for (int part = 0; part < (m == 0 ? 1 : 2); ++part, begin += n)
    {
      const auto place = [begin](std::size_t j) { return begin + j; };
      multiply(axial, n, n, b, place, a, place);
    }
    axial += n * n;
  }
  for (int l = 0; l <= order; ++l)
  {
    const std::size_t zero = harmonic_index(l, 0);
    const auto n = static_cast<std::size_t>(l);
    multiply(
        backward, n + 1, n + 1, a, [zero, axial_place](std::size_t j) { return std::size_t{axial_place[zero + j]}; }, b,
        [zero](std::size_t i) { return zero + i; });
    backward += (n + 1) * (n + 1);
    multiply(
        backward, n, n, a, [zero, axial_place](std::size_t j) { return std::size_t{axial_place[zero - 1 - j]}; }, b,
        [zero](std::size_t i) { return zero - 1 - i; });
    backward += n * n;
  }
  add_turned_back(order, phase, b, target);
}
} // namespace

Translation::Translation(const Shift kind, const int order, const Vec3 &vector) : order_(order), vector_(vector)
{
  const double d = vector.norm(), phi = std::atan2(vector[1], vector[0]);
  for (int m = 0; m <= order; ++m)
  {
    phase.push_back(std::cos(m * phi));
    phase.push_back(std::sin(m * phi));
  }
  std::tie(rotation, backward) = rotation_pair(order, vector[2] / d, std::hypot(vector[0], vector[1]) / d);
  std::vector<double> power{1.0};
  for (int n = 0; n <= 2 * order; ++n)
    power.push_back(power.back() * (kind == Shift::far ? 1 / d : d));
  for (int m = 0; m <= order; ++m)
    for (int to = m; to <= order; ++to)
      for (int from = m; from <= order; ++from)
        axial.push_back(axial_element(kind, m, to, from, power));
}

void Translation::add(const Row *source, Row *target) const
{
  translate(order_, phase.data(), rotation->data(), axial.data(), backward->data(), axial_order(order_), source,
            target);
}
} // namespace ddfem::fmm
