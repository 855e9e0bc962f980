#include "dd/fmm/multipole_images.h"

#include "dd/common/place_key.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/fmm/accuracy.h"
#include "dd/fmm/grids_and_rays.h"

#include <algorithm>
#include <map>

namespace ddfem::fmm
{
namespace
{
/// Sources lie below the surface even where it has a node on itself.
SourceExtent extent_at(Vec3 middle, const double length, const double core_radius)
{
  constexpr double smallest = 1e-6; // nm
  middle[2] = std::min(middle[2], -std::max(core_radius, smallest));
  return {middle, length};
}

std::vector<SourceExtent> extents_of(const std::span<const ImageSource> images, const double core_radius)
{
  struct
  {
    double a;
    SourceExtent operator()(const SegmentImage &i) const
    {
      return extent_at(0.5 * (i.parameters().start + i.parameters().end), i.parameters().length, a);
    }
    SourceExtent operator()(const LegImage &i) const { return extent_at(i.parameters().origin, 0.0, a); }
    SourceExtent operator()(const PiercingImage &i) const { return extent_at(i.parameters().origin, 0.0, a); }
  } extent{core_radius};
  std::vector<SourceExtent> extents;
  extents.reserve(images.size());
  for (const ImageSource &image : images)
    extents.push_back(std::visit(extent, image));
  return extents;
}

/// Root cube whose middle plane is the surface.
RootGrid grid_about_surface(const std::span<const SourceExtent> sources, const std::span<const Vec3> points)
{
  RootGrid grid = enclosing_grid(sources, {}, points);
  const double top = grid.origin[2] + grid.edges[2];
  const double half = std::max({0.5 * grid.edges[0], top, -grid.origin[2]});
  grid.origin += Vec3(0.5 * grid.edges[0] - half, 0.5 * grid.edges[1] - half, 0.0);
  grid.origin[2] = -half;
  grid.edges = Vec3::Constant(2 * half);
  return grid;
}

/// Displacements vary less than stresses: measured errors were 1/15 to 1/100 of the tolerance.
MultipoleSettings settings_of(const MultipoleImages::Field field, MultipoleSettings settings)
{
  if (field == MultipoleImages::Field::displacement)
    settings.tolerance = std::min(10 * settings.tolerance, 0.1);
  return settings;
}
} // namespace

MultipoleImages::MultipoleImages(const IsotropicMedium &medium_, const Field which, const MultipoleSettings &given,
                                 const std::span<const ImageSource> images, const std::span<const Vec3> points)
    : MultipoleImages(medium_, which, given, images, extents_of(images, medium_.a), points)
{
}

MultipoleImages::MultipoleImages(const IsotropicMedium &medium_, const Field which, const MultipoleSettings &given,
                                 const std::span<const ImageSource> images, const std::span<const SourceExtent> extents,
                                 const std::span<const Vec3> points)
    : MultipoleSum(settings_of(which, given), grid_about_surface(extents, points), extents, points,
                   smallest_box(medium_.a, given.tolerance), which == Field::stress ? 6 : 3, n_image_antiderivatives),
      medium(medium_), field(which)
{
  sources.reserve(images.size());
  for (const std::uint32_t i : octree().line_order())
    sources.push_back(images[i]);
  if (field == Field::stress)
    find_nodes();
}

void MultipoleImages::find_nodes()
{
  std::map<std::array<long long, 3>, std::uint32_t> numbers;
  const auto node_at = [&](const Vec3 &position)
  {
    const auto [entry, is_new] = numbers.try_emplace(place_key(position), static_cast<std::uint32_t>(nodes.size()));
    if (is_new)
      nodes.push_back(position);
    return entry->second;
  };
  for (const ImageSource &source : sources)
    if (const auto *const segment = std::get_if<SegmentImage>(&source))
    {
      const SegmentImageData &d = segment->parameters();
      ends_of.push_back({LegEnd{node_at(d.start), -d.burgers}, LegEnd{node_at(d.end), d.burgers}});
    }
    else
    {
      // The stress of these includes their mirrored leg.
      const auto [origin, b] = std::holds_alternative<LegImage>(source)
                                   ? std::pair(std::get<LegImage>(source).parameters().origin,
                                               std::get<LegImage>(source).parameters().burgers)
                                   : std::pair(std::get<PiercingImage>(source).parameters().origin,
                                               std::get<PiercingImage>(source).parameters().burgers);
      const std::uint32_t node = node_at(origin);
      ends_of.push_back({LegEnd{node, -b}, LegEnd{node, Vec3::Zero()}});
    }
}

void MultipoleImages::add_own_moments(const Box &box, const ExpansionView &moments) const
{
  const std::span own(sources.data() + box.lines_begin, box.own_lines_end - box.lines_begin);
  add_image_moments(order(), 0.1 * tolerance(), medium, field == Field::stress ? medium.a : 0.0, octree().centre(box),
                    octree().size(box), own, moments);
}

void MultipoleImages::add_far(const Box &leaf, const Row *const fields, const double *const q)
{
  const Vec3 centre = octree().centre(leaf);
  const double size = octree().size(leaf);
  if (field == Field::stress)
    LocalDisplacementStress(medium, local_order(), centre, size, fields, q).add(batch_of<6>(leaf));
  else
    LocalDisplacement(medium.nu, local_order(), centre, size, fields, q).add(batch_of<3>(leaf));
}

void MultipoleImages::add_near(const std::size_t leaf)
{
  std::vector<std::uint32_t> near;
  octree().for_each_near_link(leaf,
                              [&](const NearLink &, const std::uint32_t begin, const std::uint32_t end)
                              {
                                for (std::uint32_t k = begin; k < end; ++k)
                                  near.push_back(k);
                              });
  const Box &box = octree().boxes()[leaf];
  if (field == Field::stress)
    add_near_stress(near, batch_of<6>(box));
  else
    for (const std::uint32_t k : near)
      std::visit([&](const auto &image) { image.add_displacement(batch_of<3>(box)); }, sources[k]);
}

void MultipoleImages::add_near_stress(const std::span<const std::uint32_t> near, const StressBatch &batch) const
{
  std::vector<LegEnd> ends;
  for (const std::uint32_t k : near)
  {
    std::visit([&](const auto &image) { image.add_stress(batch); }, sources[k]);
    ends.insert(ends.end(), ends_of[k].begin(), ends_of[k].end());
  }
  std::sort(ends.begin(), ends.end(), [](const LegEnd &a, const LegEnd &b) { return a.node < b.node; });
  // Most of them cancel: only the legs of pieces whose neighbours are far remain.
  constexpr double closed = 1e-9; // nm
  LineTable legs;
  for (std::size_t i = 0; i < ends.size();)
  {
    Vec3 burgers = Vec3::Zero();
    const std::uint32_t node = ends[i].node;
    for (; i < ends.size() && ends[i].node == node; ++i)
      burgers += ends[i].burgers;
    if (burgers.norm() > closed)
      legs.add_ray(nodes[node], -Vec3::UnitZ(), burgers);
  }
  add_ray_stress(medium, legs, batch);
}

std::vector<SymTensor> MultipoleImages::stress(MPI_Comm comm, const Part part)
{
  compute(comm, part);
  return take_in_given_order<SymTensor>();
}

std::vector<Vec3> MultipoleImages::displacement(MPI_Comm comm, const Part part)
{
  compute(comm, part);
  return take_in_given_order<Vec3>();
}
} // namespace ddfem::fmm
