#include "fem/pillar.h"

#include "fem/disc.h"

#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace ddfem::fem
{
namespace
{
constexpr dealii::types::manifold_id side_manifold = 0, floor_manifold = 1;

/// Cylindrical coordinates about the axis through a point, made straight by the profile of the pillar.
class ProfileManifold : public dealii::ChartManifold<3, 3, 3>
{
public:
  enum class Part
  {
    side, ///< (radius / that of the profile at this height, angle, height)
    floor ///< (radius, angle, height over the profile at this radius)
  };
  ProfileManifold(const Part which, const PillarGeometry &pillar, const dealii::Point<3> &axis)
      : dealii::ChartManifold<3, 3, 3>(dealii::Tensor<1, 3>({0., 2. * std::numbers::pi, 0.})), part(which),
        geometry(pillar), middle(axis)
  {
  }

  std::unique_ptr<dealii::Manifold<3, 3>> clone() const override
  {
    return std::make_unique<ProfileManifold>(part, geometry, middle);
  }

  dealii::Point<3> pull_back(const dealii::Point<3> &x) const override
  {
    const dealii::Tensor<1, 3> d = x - middle;
    const double r = std::hypot(d[0], d[1]);
    double angle = std::atan2(d[1], d[0]);
    angle += angle < 0. ? 2. * std::numbers::pi : 0.;
    return part == Part::side ? dealii::Point<3>(r / geometry.radius_at(d[2]), angle, d[2])
                              : dealii::Point<3>(r, angle, d[2] - geometry.floor_at(r));
  }

  dealii::Point<3> push_forward(const dealii::Point<3> &chart) const override
  {
    const double r = part == Part::side ? chart[0] * geometry.radius_at(chart[2]) : chart[0];
    const double z = part == Part::side ? chart[2] : chart[2] + geometry.floor_at(r);
    return middle + dealii::Tensor<1, 3>({r * std::cos(chart[1]), r * std::sin(chart[1]), z});
  }

private:
  Part part;
  PillarGeometry geometry;
  dealii::Point<3> middle; ///< of the upper face of the base
};

/// Centre of the fillet's circle: radius, height.
std::array<double, 2> fillet_centre(const PillarGeometry &g)
{
  const double side = g.top_radius + (g.height - g.fillet_radius) * std::tan(g.taper);
  return {side + g.fillet_radius / std::cos(g.taper), g.fillet_radius};
}

/// Angle of the middle of the fillet below the horizontal, seen from its centre.
double middle_angle(const PillarGeometry &g)
{
  return 0.5 * (g.taper + 0.5 * std::numbers::pi);
}

/// A column of the mesh of the base: place and height of its upper end.
struct Column
{
  dealii::Point<2> place;
  double top;
};

/// Plan of the base: the disc under the pillar, one ring under the lower half of the fillet, rings to the square.
struct Plan
{
  std::vector<Column> columns;
  std::vector<std::array<unsigned, 4>> quads; ///< those of the disc first
};

unsigned cells_for(const double length, const double size)
{
  return std::max(1u, static_cast<unsigned>(std::lround(length / size)));
}

Plan make_plan(const PillarGeometry &g, const Disc &disc, const unsigned n_base)
{
  Plan plan;
  const double middle = g.fillet_middle(), foot = g.foot_radius();
  const double radius = g.fillet_radius > 0. ? fillet_centre(g)[0] - g.fillet_radius * std::cos(middle_angle(g)) : foot;
  for (const auto &p : disc.points)
  {
    plan.columns.push_back({radius * p, middle});
  }
  plan.quads = disc.quads;
  std::vector<unsigned> inner = disc.rim;
  const std::size_t n = inner.size();
  const auto add_ring = [&](const auto &radius_at)
  {
    std::vector<unsigned> outer;
    for (std::size_t k = 0; k < n; ++k)
    {
      const double angle = std::numbers::pi * (2. * static_cast<double>(k) / static_cast<double>(n) - 0.25);
      const double r = radius_at(angle);
      outer.push_back(static_cast<unsigned>(plan.columns.size()));
      plan.columns.push_back({dealii::Point<2>(r * std::cos(angle), r * std::sin(angle)), 0.});
    }
    for (std::size_t k = 0; k < n; ++k)
    {
      plan.quads.push_back({inner[k], outer[k], inner[(k + 1) % n], outer[(k + 1) % n]});
    }
    inner = outer;
  };
  if (g.fillet_radius > 0.)
  {
    add_ring([foot](double) { return foot; });
  }
  const unsigned n_rings = cells_for(0.5 * g.base_width - foot, g.base_height / n_base);
  for (unsigned ring = 1; ring <= n_rings; ++ring)
  {
    const double w = static_cast<double>(ring) / n_rings;
    add_ring(
        [&](const double angle)
        {
          const double square = 0.5 * g.base_width / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
          return (1. - w) * foot + w * square;
        });
  }
  return plan;
}

/// Heights of the layers of the pillar above the base, from the middle of the fillet to the top; one is the end of the fillet.
std::vector<double> layer_heights(const PillarGeometry &g, const unsigned n_along)
{
  std::vector<double> heights{g.fillet_middle()};
  unsigned n_straight = n_along;
  if (g.fillet_radius > 0.)
  {
    const unsigned n =
        std::min(std::max(1u, n_along - 1), cells_for(n_along * (g.fillet_top() - heights[0]), g.height));
    for (unsigned k = 1; k <= n; ++k)
    {
      const double angle = middle_angle(g) + (g.taper - middle_angle(g)) * k / n;
      heights.push_back(g.fillet_radius * (1. - std::sin(angle)));
    }
    n_straight = std::max(1u, n_along - n);
  }
  const double start = heights.back();
  for (unsigned k = 1; k <= n_straight; ++k)
  {
    heights.push_back(start + (g.height - start) * k / n_straight);
  }
  return heights;
}

void add_cells(std::vector<dealii::CellData<3>> &cells, const std::vector<std::array<unsigned, 4>> &quads,
               const std::size_t n_quads, const unsigned below, const unsigned above)
{
  for (std::size_t q = 0; q < n_quads; ++q)
  {
    dealii::CellData<3> cell(8);
    for (unsigned v = 0; v < 4; ++v)
    {
      cell.vertices[v] = quads[q][v] + below;
      cell.vertices[v + 4] = quads[q][v] + above;
    }
    cells.push_back(cell);
  }
}

/// Boundary and manifold ids from the places of the vertices; z counts from the bottom of the base.
void mark_boundary(dealii::Triangulation<3> &triangulation, const PillarGeometry &g)
{
  const double tolerance = 1e-6 * g.top_radius;
  for (const auto &face : triangulation.active_face_iterators())
  {
    if (!face->at_boundary())
    {
      continue;
    }
    const auto all = [&](const auto &holds)
    { return holds(face->vertex(0)) && holds(face->vertex(1)) && holds(face->vertex(2)) && holds(face->vertex(3)); };
    const auto all_at = [&](const unsigned d, const double value)
    { return all([&](const dealii::Point<3> &x) { return std::abs(x[d] - value) < tolerance; }); };
    const double w = 0.5 * g.base_width;
    if (all_at(2, 0.))
      face->set_boundary_id(1);
    else if (all_at(2, g.base_height + g.height))
      face->set_boundary_id(2);
    else if (all_at(2, g.base_height))
      face->set_boundary_id(3);
    else if (all_at(0, -w) || all_at(0, w) || all_at(1, -w) || all_at(1, w))
      face->set_boundary_id(4);
    else
    {
      face->set_boundary_id(0);
      const double begin = g.base_height + g.fillet_middle() - tolerance;
      face->set_all_manifold_ids(all([&](const dealii::Point<3> &x) { return x[2] > begin; }) ? side_manifold
                                                                                              : floor_manifold);
    }
  }
}
} // namespace

double PillarGeometry::foot_radius() const
{
  return fillet_centre(*this)[0];
}

double PillarGeometry::fillet_top() const
{
  return fillet_radius * (1. - std::sin(taper));
}

double PillarGeometry::fillet_middle() const
{
  return fillet_radius * (1. - std::sin(middle_angle(*this)));
}

double PillarGeometry::radius_at(const double z) const
{
  if (z >= fillet_top())
  {
    return top_radius + (height - z) * std::tan(taper);
  }
  const auto [r, h] = fillet_centre(*this);
  return r - std::sqrt(std::max(0., fillet_radius * fillet_radius - (h - z) * (h - z)));
}

double PillarGeometry::floor_at(const double r) const
{
  const auto [centre, h] = fillet_centre(*this);
  return r >= centre ? 0. : h - std::sqrt(std::max(0., fillet_radius * fillet_radius - (centre - r) * (centre - r)));
}

void make_pillar(dealii::Triangulation<3> &triangulation, const PillarGeometry &geometry, const PillarCells &n)
{
  const Disc disc = make_disc(n.across);
  const Plan plan = make_plan(geometry, disc, n.base);
  std::vector<dealii::Point<3>> vertices;
  std::vector<dealii::CellData<3>> cells;
  const auto plan_size = static_cast<unsigned>(plan.columns.size());
  for (unsigned k = 0; k <= n.base; ++k)
  {
    for (const Column &c : plan.columns)
    {
      vertices.emplace_back(c.place[0], c.place[1], (geometry.base_height + c.top) * k / n.base);
    }
    if (k > 0)
    {
      add_cells(cells, plan.quads, plan.quads.size(), (k - 1) * plan_size, k * plan_size);
    }
  }
  const std::vector<double> heights = layer_heights(geometry, n.along);
  unsigned below = n.base * plan_size; // the upper ends of the disc's columns come first there
  for (std::size_t k = 1; k < heights.size(); ++k)
  {
    const auto above = static_cast<unsigned>(vertices.size());
    const double radius = geometry.radius_at(heights[k]);
    for (const auto &p : disc.points)
    {
      vertices.emplace_back(radius * p[0], radius * p[1], geometry.base_height + heights[k]);
    }
    add_cells(cells, plan.quads, disc.quads.size(), below, above);
    below = above;
  }
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
  mark_boundary(triangulation, geometry);
  attach_pillar_manifolds(triangulation, geometry, dealii::Point<3>());
}

void attach_pillar_manifolds(dealii::Triangulation<3> &triangulation, const PillarGeometry &geometry,
                             const dealii::Point<3> &base)
{
  const dealii::Point<3> middle = base + dealii::Tensor<1, 3>({0., 0., geometry.base_height});
  triangulation.set_manifold(side_manifold, ProfileManifold(ProfileManifold::Part::side, geometry, middle));
  triangulation.set_manifold(floor_manifold, ProfileManifold(ProfileManifold::Part::floor, geometry, middle));
}
} // namespace ddfem::fem
