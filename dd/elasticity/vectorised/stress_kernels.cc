#include "dd/elasticity/vectorised/stress_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/stress_kernels.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/line_stress-inl.h"
#include "dd/elasticity/vectorised/point_groups-inl.h"

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
namespace
{
/// The lines to be summed: numbers which[0] ... which[n - 1], or all if there is no list.
struct Sources
{
  const LineTable &lines;
  const unsigned *which;
  std::size_t n;
};

template <class TermsOf>
HWY_INLINE void add_lines(const IsotropicMedium &medium, const Sources &sources, const StressBatch &batch,
                          TermsOf &&terms_of)
{
  const StressConstants<Real> constants(medium);
  add_at_points(batch.n, batch.x, batch.value,
                [&](std::size_t, const Vector<Real> &x) HWY_ATTR
                {
                  StressSum<Real> sum{};
                  for (std::size_t k = 0; k < sources.n; ++k)
                  {
                    const Line<Real> line = line_of<Real>(sources.lines, sources.which ? sources.which[k] : k);
                    sum.add(terms_of(constants, line, x), line.t);
                  }
                  const Tensor<Real> s = sum.tensor(medium);
                  return std::array<Real, 6>{s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
                });
}

/// A block of lines in single precision, lengths in units of `unit` from `origin`.
struct SingleBlock
{
  float value[LineTable::n_rows][LineTable::block_size];

  SingleBlock(const LineTable::Block &block, const Vec3 &origin, const double unit)
  {
    for (std::size_t row = 0; row < LineTable::n_rows; ++row)
    {
      const bool is_place = row < LineTable::direction, is_length = is_place || row == LineTable::length;
      const double zero = is_place ? origin[static_cast<Eigen::Index>(row % 3)] : 0.0,
                   scale = is_length ? 1 / unit : 1.0;
      for (std::size_t l = 0; l < LineTable::block_size; ++l)
        value[row][l] = static_cast<float>((block.value[row][l] - zero) * scale);
    }
  }
};

/// The blocks of the lines in ascending order that are asked for, and the lines' first rows in them.
struct SingleLines
{
  std::vector<SingleBlock> blocks;
  std::vector<unsigned> place; ///< block times block_size, plus the position in it

  SingleLines(const Sources &s, const Vec3 &origin, const double unit)
  {
    std::size_t last = s.lines.n_blocks();
    place.reserve(s.n);
    blocks.reserve(s.n / 4);
    for (std::size_t k = 0; k < s.n; ++k)
    {
      const std::size_t block = s.which[k] / LineTable::block_size, lane = s.which[k] % LineTable::block_size;
      if (block != last)
        blocks.emplace_back(s.lines.block(block), origin, unit);
      last = block;
      place.push_back(static_cast<unsigned>((blocks.size() - 1) * LineTable::block_size + lane));
    }
  }

  HWY_INLINE Line<Single> line(const std::size_t k) const
  {
    const float *const p = &blocks[place[k] / LineTable::block_size].value[0][place[k] % LineTable::block_size];
    const auto row = [&](const std::size_t r) HWY_ATTR { return Single::all(p[r * LineTable::block_size]); };
    const auto vector = [&](const std::size_t r) HWY_ATTR { return Vector<Single>{row(r), row(r + 1), row(r + 2)}; };
    return {vector(LineTable::first_end), vector(LineTable::second_end), vector(LineTable::direction),
            vector(LineTable::burgers),   vector(LineTable::edge),       row(LineTable::length)};
  }
};
} // namespace

void add_segments(const IsotropicMedium &medium, const LineTable &lines, const unsigned *which, std::size_t n,
                  const StressBatch &batch)
{
  add_lines(medium, Sources{lines, which, n}, batch,
            [](const StressConstants<Real> &c, const Line<Real> &l, const Vector<Real> &x) HWY_ATTR
            { return segment_stress_terms(c, l, x); });
}

void add_distant_segments(const IsotropicMedium &medium, const LineTable &lines, const unsigned *which, std::size_t n,
                          const StressBatch &batch)
{
  add_lines(medium, Sources{lines, which, n}, batch,
            [](const StressConstants<Real> &c, const Line<Real> &l, const Vector<Real> &x) HWY_ATTR
            { return distant_stress_terms(c, l, x); });
}

void add_in_single_precision(const IsotropicMedium &medium, const LineTable &lines, const unsigned *which,
                             std::size_t n, const Vec3 &origin, const double unit, const StressBatch &batch)
{
  const SingleLines sources(Sources{lines, which, n}, origin, unit);
  const IsotropicMedium scaled{medium.mu / unit, medium.nu, medium.a / unit};
  const StressConstants<Single> constants(scaled);
  constexpr std::size_t width = n_lanes_of<float>;
  for (std::size_t i = 0; i < batch.n; i += width)
  {
    float x[3][width], value[width];
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t l = 0; l < width; ++l)
        x[c][l] = static_cast<float>((batch.x[c][std::min(i + l, batch.n - 1)] - origin[static_cast<Eigen::Index>(c)]) /
                                     unit);
    const Vector<Single> point{Single::load(x[0]), Single::load(x[1]), Single::load(x[2])};
    StressSum<Single> sum{};
    for (std::size_t k = 0; k < n; ++k)
    {
      const Line<Single> line = sources.line(k);
      sum.add(distant_stress_terms(constants, line, point), line.t);
    }
    const Tensor<Single> s = sum.tensor(scaled);
    const Single *const components[6] = {&s.xx, &s.yy, &s.zz, &s.xy, &s.xz, &s.yz};
    for (std::size_t c = 0; c < 6; ++c)
    {
      components[c]->store(value);
      for (std::size_t l = 0; l < std::min(width, batch.n - i); ++l)
        batch.value[c][i + l] += static_cast<double>(value[l]);
    }
  }
}

void add_rays(const IsotropicMedium &medium, const LineTable &lines, const unsigned *which, std::size_t n,
              const StressBatch &batch)
{
  add_lines(medium, Sources{lines, which, n}, batch,
            [](const StressConstants<Real> &c, const Line<Real> &l, const Vector<Real> &x) HWY_ATTR
            { return ray_stress_terms(c, l, x); });
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(add_segments);
HWY_EXPORT(add_distant_segments);
HWY_EXPORT(add_in_single_precision);
HWY_EXPORT(add_rays);

void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_segments)(medium, segments, nullptr, segments.size(), batch);
}

void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, const std::span<const unsigned> which,
                        const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_segments)(medium, segments, which.data(), which.size(), batch);
}

void add_distant_segment_stress(const IsotropicMedium &medium, const LineTable &segments,
                                const std::span<const unsigned> which, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_distant_segments)(medium, segments, which.data(), which.size(), batch);
}

void add_single_precision_stress(const IsotropicMedium &medium, const LineTable &segments,
                                 const std::span<const unsigned> which, const Vec3 &origin, const double unit,
                                 const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_in_single_precision)(medium, segments, which.data(), which.size(), origin, unit, batch);
}

void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_rays)(medium, rays, nullptr, rays.size(), batch);
}

void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const std::span<const unsigned> which,
                    const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_rays)(medium, rays, which.data(), which.size(), batch);
}
} // namespace ddfem
#endif
