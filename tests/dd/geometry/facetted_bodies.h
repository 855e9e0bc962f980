// Closed surfaces of facets, counter-clockwise seen from outside.
#pragma once

#include "dd/geometry/reentrant_shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace ddfem
{
using FacetList = std::vector<PolyhedronShape::Facet>;

/// Rectangle with the corner @p x and the edges @p u, @p v; outward normal u x v.
inline void add_rectangle(FacetList &facets, const Vec3 &x, const Vec3 &u, const Vec3 &v, const int id)
{
  facets.push_back({{x, x + u, x + u + v, x + v}, id});
}

inline FacetList facetted_box(const Vec3 &lower, const Vec3 &upper)
{
  FacetList facets;
  for (int c = 0; c < 3; ++c)
  {
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    const Vec3 u = (upper - lower)[d] * Vec3::Unit(d), v = (upper - lower)[e] * Vec3::Unit(e);
    add_rectangle(facets, lower, v, u, 2 * c);
    add_rectangle(facets, lower + (upper - lower)[c] * Vec3::Unit(c), u, v, 2 * c + 1);
  }
  return facets;
}

/// Surface of the voxels between the given coordinates that @p is_solid(i, j, k) names; all faces have id 0.
template <typename IsSolid>
FacetList facetted_voxels(const std::array<std::vector<double>, 3> &x, const IsSolid &is_solid)
{
  FacetList facets;
  const auto solid = [&](const std::array<int, 3> &i)
  {
    for (std::size_t d = 0; d < 3; ++d)
      if (i[d] < 0 || i[d] + 1 >= static_cast<int>(x[d].size()))
        return false;
    return is_solid(i[0], i[1], i[2]);
  };
  const auto at = [&](const std::size_t d, const int i) { return x[d][static_cast<std::size_t>(i)]; };
  std::array<int, 3> i{};
  for (i[0] = 0; i[0] + 1 < static_cast<int>(x[0].size()); ++i[0])
    for (i[1] = 0; i[1] + 1 < static_cast<int>(x[1].size()); ++i[1])
      for (i[2] = 0; i[2] + 1 < static_cast<int>(x[2].size()); ++i[2])
        for (std::size_t d = 0; solid(i) && d < 3; ++d)
          for (const int side : {0, 1})
          {
            std::array<int, 3> neighbour = i;
            neighbour[d] += side == 0 ? -1 : 1;
            if (solid(neighbour))
              continue;
            const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
            Vec3 corner(at(0, i[0]), at(1, i[1]), at(2, i[2]));
            corner[static_cast<int>(d)] = at(d, i[d] + side);
            const Vec3 u = (at(e, i[e] + 1) - at(e, i[e])) * Vec3::Unit(static_cast<int>(e)),
                       v = (at(f, i[f] + 1) - at(f, i[f])) * Vec3::Unit(static_cast<int>(f));
            side == 0 ? add_rectangle(facets, corner, v, u, 0) : add_rectangle(facets, corner, u, v, 0);
          }
  return facets;
}

inline FacetList facetted_cantilever(const Vec3 &lower, const Vec3 &beam, const Vec3 &block)
{
  const Vec3 margin = 0.5 * (block - beam);
  std::array<std::vector<double>, 3> x;
  x[0] = {lower[0], lower[0] + block[0], lower[0] + block[0] + beam[0]};
  for (int d = 1; d < 3; ++d)
    x[static_cast<std::size_t>(d)] = {lower[d], lower[d] + margin[d], lower[d] + margin[d] + beam[d],
                                      lower[d] + block[d]};
  return facetted_voxels(x, [](const int i, const int j, const int k) { return i == 0 || (j == 1 && k == 1); });
}

/// Pillar of @p n (a multiple of eight) sides; face ids as those of PillarShape.
inline FacetList facetted_pillar(const Vec3 &foot, const PillarDimensions &d, const int n)
{
  // Profile from the axis at the top to the foot of the fillet, as (radius, height).
  std::vector<std::pair<double, double>> profile{{d.top_radius, d.height}};
  const auto [rc, zc] = d.fillet_centre();
  const int n_arc = 16;
  for (int k = 0; k <= n_arc; ++k)
  {
    const double angle = d.taper + (std::numbers::pi / 2 - d.taper) * k / n_arc; // below the horizontal
    profile.emplace_back(rc - d.fillet_radius * std::cos(angle), zc - d.fillet_radius * std::sin(angle));
  }
  const Vec3 middle = foot + Vec3(0, 0, d.base_height);
  const auto on_circle = [&](const double r, const double z, const int k)
  {
    const double angle = 2 * std::numbers::pi * (k % n) / n;
    return Vec3(middle + Vec3(r * std::cos(angle), r * std::sin(angle), z));
  };
  const auto on_square = [&](const double z, const int k)
  {
    const double angle = 2 * std::numbers::pi * (k % n) / n, c = std::cos(angle), s = std::sin(angle);
    return Vec3(middle + 0.5 * d.base_width / std::max(std::abs(c), std::abs(s)) * Vec3(c, s, 0) + Vec3(0, 0, z));
  };
  FacetList facets;
  for (int k = 0; k < n; ++k)
  {
    facets.push_back({{middle + Vec3(0, 0, d.height), on_circle(d.top_radius, d.height, k),
                       on_circle(d.top_radius, d.height, k + 1)},
                      2});
    for (std::size_t p = 0; p + 1 < profile.size(); ++p)
    {
      const auto [r, z] = profile[p];
      const auto [r_next, z_next] = profile[p + 1];
      facets.push_back(
          {{on_circle(r, z, k), on_circle(r_next, z_next, k), on_circle(r_next, z_next, k + 1), on_circle(r, z, k + 1)},
           0});
    }
    const double r = profile.back().first, z = profile.back().second;
    facets.push_back({{on_circle(r, z, k), on_square(0, k), on_square(0, k + 1), on_circle(r, z, k + 1)}, 3});
    facets.push_back(
        {{on_square(0, k), on_square(-d.base_height, k), on_square(-d.base_height, k + 1), on_square(0, k + 1)}, 4});
    facets.push_back({{foot, on_square(-d.base_height, k + 1), on_square(-d.base_height, k)}, 1});
  }
  return facets;
}
} // namespace ddfem
