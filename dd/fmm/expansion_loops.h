// The loops that the expansions of stress and displacement share. Internal to dd/fmm.
#pragma once

#include "dd/elasticity/point_batch.h"
#include "dd/fmm/solid_harmonics.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ddfem::fmm
{
/// Index of the component ab in xx yy zz xy xz yz.
inline constexpr std::size_t component[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/// Gauss points along a source of length @p longest (over the box size): the remainder of an n-point rule falls like longest^2n, and at
/// this order no more than order/2 + 1 points can be needed.
int n_points_along(int order, double tolerance, double longest);

/// sum += weight values: @p n rows.
void add_weighted(std::size_t n, double weight, const Row *values, Row *sum);

/// Adds the moments of eight sources: row k of @p source_moments holds moment k of each; @p strength: of the eight fields, a row per
/// source; @p q_strength: of Q.
void add_outer_products(std::size_t n, const Row *source_moments, const Row *strength, const Row *q_strength,
                        Row *fields, double *q);
/// The same without Q.
void add_outer_products(std::size_t n, const Row *source_moments, const Row *strength, Row *fields);

/// d/dx_axis of an expansion in regular harmonics.
RowBuffer derivative(const std::vector<GradientTerm> &terms, const RowBuffer &expansion);
/// gradient_terms(), kept.
const std::array<std::vector<GradientTerm>, 3> &known_gradient_terms(int order);

/// Eight points at once. @p coefficients: 24 numbers per harmonic, four groups c of six; @p y: (x - centre)/size; the result, six rows:
/// c_0 + y_0 c_1 + y_1 c_2 + y_2 c_3.
void contract_harmonics(std::size_t n, const Row *harmonics, const double *coefficients, const Row *y, Row *result);
/// Sixteen points in single precision.
void contract_harmonics(std::size_t n, const WideSingleRows::Row *harmonics, const float *coefficients,
                        const WideSingleRows::Row *y, WideSingleRows::Row *result);

/// A field in one box as contract_harmonics() evaluates it: three rows of coefficients per harmonic, first the components of the field, then
/// those that are multiplied by y_0, y_1 and y_2.
template <std::size_t n_values> class LocalExpansion
{
  static_assert(n_values <= 6);

public:
  /// Adds the field at the points of a batch.
  void add(const PointBatch<n_values> &batch) const { add_by<DoubleRows>(batch, coefficients.data()); }
  /// The same with expansions in single precision: six digits of the largest values.
  void add_in_single_precision(const PointBatch<n_values> &batch) const
  {
    const double *const from = coefficients.data();
    std::vector<float> single(coefficients.size() * row_width);
    for (std::size_t k = 0; k < single.size(); ++k)
      single[k] = static_cast<float>(from[k]);
    add_by<WideSingleRows>(batch, single.data());
  }

protected:
  /// Harmonics up to @p degree_ about @p centre_ (nm) in a box of @p size_ (nm), zero so far.
  LocalExpansion(const int degree_, const Vec3 &centre_, const double size_)
      : degree(degree_), centre(centre_), size(size_), coefficients(3 * n_harmonics(degree_))
  {
  }

private:
  template <class Rows> void add_by(const PointBatch<n_values> &batch, const typename Rows::Scalar *const numbers) const
  {
    using Scalar = typename Rows::Scalar;
    const std::size_t n = n_harmonics(degree);
    alignas(row_size) typename Rows::Row harmonics[n_harmonics(max_order)];
    for (std::size_t begin = 0; begin < batch.n; begin += Rows::width)
    {
      const std::size_t count = std::min(Rows::width, batch.n - begin);
      alignas(row_size) typename Rows::Row y[3] = {}, result[6];
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < count; ++i)
          y[c][i] = static_cast<Scalar>((batch.x[c][begin + i] - centre[static_cast<int>(c)]) / size);
      regular_harmonics(degree, y, harmonics);
      contract_harmonics(n, harmonics, numbers, y, result);
      for (std::size_t c = 0; c < n_values; ++c)
        for (std::size_t i = 0; i < count; ++i)
          batch.value[c][begin + i] += static_cast<double>(result[c][i]);
    }
  }

protected:
  int degree;
  Vec3 centre;
  double size;
  RowBuffer coefficients;
};
} // namespace ddfem::fmm
