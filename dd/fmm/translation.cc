#include "dd/fmm/translation.h"

#include "dd/fmm/row_products.h"

#include <array>
#include <cmath>
#include <mutex>

namespace ddfem::fmm
{
namespace
{
template <class Scalar> using Blocks = std::shared_ptr<const std::vector<Scalar>>;

template <class Scalar> std::vector<Scalar> in_precision(const std::vector<double> &numbers)
{
  std::vector<Scalar> result;
  result.reserve(numbers.size());
  for (const double x : numbers)
    result.push_back(static_cast<Scalar>(x));
  return result;
}

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
template <class Scalar>
std::pair<Blocks<Scalar>, Blocks<Scalar>> rotation_pair(const int order, const double cos_theta, const double sin_theta)
{
  static std::map<std::pair<int, long>, std::pair<Blocks<Scalar>, Blocks<Scalar>>> known;
  static std::mutex access;
  const std::lock_guard lock(access);
  // Angles that differ by rounding share an entry; the first one is as good as the others.
  auto &entry = known[{order, std::lround(std::atan2(sin_theta, cos_theta) * 1e13)}];
  if (!entry.first)
  {
    const auto blocks = rotation_about_y(order, cos_theta, sin_theta);
    entry = {std::make_shared<const std::vector<Scalar>>(in_precision<Scalar>(blocks)),
             std::make_shared<const std::vector<Scalar>>(in_precision<Scalar>(transposed(order, blocks)))};
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

/// The numbers of one translation.
template <class Scalar> struct Factors
{
  int order;
  const Scalar *phase, *rotation, *axial, *backward;
  const std::uint16_t *axial_place;
};

template <class Rows>
DDFEM_FMM_INLINE void translate_rows(const Factors<typename Rows::Scalar> &factors, const typename Rows::Row *source,
                                     typename Rows::Row *target)
{
  const int order = factors.order;
  const typename Rows::Scalar *const phase = factors.phase, *rotation = factors.rotation, *axial = factors.axial,
                                     *backward = factors.backward;
  const std::uint16_t *const axial_place = factors.axial_place;
  alignas(row_size) typename Rows::Row a[n_harmonics(max_order)];
  alignas(row_size) typename Rows::Row b[n_harmonics(max_order)];
  turn_to_axis<Rows>(order, phase, source, a);
  for (int l = 0; l <= order; ++l)
  {
    const std::size_t zero = harmonic_index(l, 0);
    const auto n = static_cast<std::size_t>(l);
    multiply<Rows>(
        rotation, n + 1, n + 1, a, [zero](std::size_t j) { return zero + j; }, b,
        [zero, axial_place](std::size_t i) { return std::size_t{axial_place[zero + i]}; });
    rotation += (n + 1) * (n + 1);
    multiply<Rows>(
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
      multiply<Rows>(axial, n, n, b, place, a, place);
    }
    axial += n * n;
  }
  for (int l = 0; l <= order; ++l)
  {
    const std::size_t zero = harmonic_index(l, 0);
    const auto n = static_cast<std::size_t>(l);
    multiply<Rows>(
        backward, n + 1, n + 1, a, [zero, axial_place](std::size_t j) { return std::size_t{axial_place[zero + j]}; }, b,
        [zero](std::size_t i) { return zero + i; });
    backward += (n + 1) * (n + 1);
    multiply<Rows>(
        backward, n, n, a, [zero, axial_place](std::size_t j) { return std::size_t{axial_place[zero - 1 - j]}; }, b,
        [zero](std::size_t i) { return zero - 1 - i; });
    backward += n * n;
  }
  add_turned_back<Rows>(order, phase, b, target);
}

DDFEM_FMM_EVERY_PROCESSOR
void translate(const Factors<double> &factors, const Row *source, Row *target)
{
  translate_rows<DoubleRows>(factors, source, target);
}

DDFEM_FMM_EVERY_PROCESSOR
void translate(const Factors<float> &factors, const SingleRows::Row *source, SingleRows::Row *target)
{
  translate_rows<SingleRows>(factors, source, target);
}

DDFEM_FMM_EVERY_PROCESSOR
void translate(const Factors<float> &factors, const WideSingleRows::Row *source, WideSingleRows::Row *target)
{
  translate_rows<WideSingleRows>(factors, source, target);
}

template <class Scalar>
Factors<Scalar> factors_of(const int order, const std::vector<Scalar> &phase, const std::vector<Scalar> &rotation,
                           const std::vector<Scalar> &axial, const std::vector<Scalar> &backward)
{
  return {order, phase.data(), rotation.data(), axial.data(), backward.data(), axial_order(order)};
}

/// Two expansions side by side.
DDFEM_FMM_EVERY_PROCESSOR
void translate_two(const Factors<float> &factors, const SingleRows::Row *const *source, SingleRows::Row *const *target)
{
  alignas(row_size) WideSingleRows::Row in[n_harmonics(max_order)];
  alignas(row_size) WideSingleRows::Row out[n_harmonics(max_order)];
  const std::size_t n = n_harmonics(factors.order);
  for (std::size_t k = 0; k < n; ++k)
  {
    const SingleRows::Row first = source[0][k], second = source[1][k];
    in[k] = __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    out[k] = WideSingleRows::Row{};
  }
  translate_rows<WideSingleRows>(factors, in, out);
  for (std::size_t k = 0; k < n; ++k)
  {
    const WideSingleRows::Row both = out[k];
    target[0][k] += __builtin_shufflevector(both, both, 0, 1, 2, 3, 4, 5, 6, 7);
    target[1][k] += __builtin_shufflevector(both, both, 8, 9, 10, 11, 12, 13, 14, 15);
  }
}

void translate_two(const Factors<double> &factors, const Row *const *source, Row *const *target)
{
  translate(factors, source[0], target[0]);
  translate(factors, source[1], target[1]);
}
} // namespace

template <class Scalar>
BasicTranslation<Scalar>::BasicTranslation(const Shift kind, const int order, const Vec3 &vector)
    : order_(order), vector_(vector)
{
  const double d = vector.norm(), phi = std::atan2(vector[1], vector[0]);
  for (int m = 0; m <= order; ++m)
  {
    phase.push_back(static_cast<Scalar>(std::cos(m * phi)));
    phase.push_back(static_cast<Scalar>(std::sin(m * phi)));
  }
  std::tie(rotation, backward) = rotation_pair<Scalar>(order, vector[2] / d, std::hypot(vector[0], vector[1]) / d);
  std::vector<double> power{1.0};
  for (int n = 0; n <= 2 * order; ++n)
    power.push_back(power.back() * (kind == Shift::far ? 1 / d : d));
  for (int m = 0; m <= order; ++m)
    for (int to = m; to <= order; ++to)
      for (int from = m; from <= order; ++from)
        axial.push_back(static_cast<Scalar>(axial_element(kind, m, to, from, power)));
}

template <class Scalar>
void BasicTranslation<Scalar>::add(const typename Precision<Scalar>::Narrow::Row *source,
                                   typename Precision<Scalar>::Narrow::Row *target) const
{
  translate(factors_of(order_, phase, *rotation, axial, *backward), source, target);
}

template <class Scalar>
void BasicTranslation<Scalar>::add_two(const std::array<const typename Precision<Scalar>::Narrow::Row *, 2> &source,
                                       const std::array<typename Precision<Scalar>::Narrow::Row *, 2> &target) const
{
  translate_two(factors_of(order_, phase, *rotation, axial, *backward), source.data(), target.data());
}

template <class Scalar>
void BasicTranslation<Scalar>::add_wide(const typename Precision<Scalar>::Wide::Row *source,
                                        typename Precision<Scalar>::Wide::Row *target) const
{
  translate(factors_of(order_, phase, *rotation, axial, *backward), source, target);
}

template class BasicTranslation<double>;
template class BasicTranslation<float>;
} // namespace ddfem::fmm
