#include "dd/fmm/multipole_stress.h"

#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/fmm/accuracy.h"
#include "dd/fmm/grids_and_rays.h"
#include "dd/fmm/shifted_batch.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace ddfem::fmm
{
namespace
{
/// Lines nearer than this to the points of a leaf, in box sizes, are summed in double precision in any case.
constexpr double single_precision_distance = 0.12;

/// Which lines are so far from all points of a batch that the short form of their stress holds.
class NearnessToPoints
{
public:
  NearnessToPoints(const StressBatch &batch, const double distance_) : distance(distance_)
  {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < batch.n; ++i)
      {
        low[c] = std::min(low[c], batch.x[c][i]);
        high[c] = std::max(high[c], batch.x[c][i]);
      }
  }

  /// Of a line in sphere number @p k, moved by @p shift (nm).
  bool is_distant(const LineSpheres &s, const std::size_t k, const Vec3 &shift) const
  {
    const double x[3] = {s.x[k] + shift[0], s.y[k] + shift[1], s.z[k] + shift[2]};
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      const double outside = std::max({low[c] - x[c], x[c] - high[c], 0.0});
      square += outside * outside;
    }
    const double needed = s.radius[k] + std::max(distance, s.radius[k]);
    return square > needed * needed;
  }

private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  double distance; ///< nm
  double low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
};

/// Boxes whose lines act directly on the points of a leaf.
class DirectBoxes
{
public:
  DirectBoxes(const Octree &tree_, const std::size_t leaf) : tree(tree_), linked(tree.boxes().size(), none)
  {
    tree.for_each_near_link(leaf, [&](const NearLink &link, std::uint32_t, std::uint32_t)
                            { linked[link.box] = std::max(linked[link.box], link.own_only ? own : all); });
  }

  /// Whether @p box does with the lines that it holds itself.
  bool hold_lines_of(std::uint32_t box) const
  {
    if (linked[box] != none)
      return true;
    while (tree.boxes()[box].level > 0)
    {
      box = tree.boxes()[box].parent;
      if (linked[box] == all)
        return true;
    }
    return false;
  }

private:
  enum Link : std::uint8_t
  {
    none,
    own,
    all
  };
  const Octree &tree;
  std::vector<Link> linked;
};
} // namespace

MultipoleStress::MultipoleStress(const IsotropicMedium &medium_, const MultipoleSettings &given, const RootGrid &grid,
                                 const std::span<const LineSource> lines, const std::span<const RaySource> distant_rays,
                                 const std::span<const Vec3> points)
    : MultipoleSum(given, grid, extents_of(lines), points, smallest_box(medium_.a, given.tolerance), 6), medium(medium_)
{
  line_table = in_order_of_tree(lines);
  take_rays(distant_rays);
}

LineTable MultipoleStress::in_order_of_tree(const std::span<const LineSource> lines) const
{
  LineTable table;
  table.reserve(lines.size());
  for (const std::uint32_t i : octree().line_order())
    table.add_segment(lines[i].start, lines[i].end, lines[i].burgers);
  return table;
}

void MultipoleStress::take_rays(const std::span<const RaySource> distant_rays)
{
  rays.assign(distant_rays.begin(), distant_rays.end());
  ray_table = {};
  for (const RaySource &r : rays)
    ray_table.add_ray(r.origin, r.direction, r.burgers);
}

void MultipoleStress::move(const MovedSources &moved, const std::span<const Vec3> points,
                           const std::span<const std::uint32_t> leaf_of_point)
{
  MultipoleSum::move(extents_of(moved.lines), moved.box_of_line, points, leaf_of_point);
  line_table = in_order_of_tree(moved.lines);
  take_rays(moved.distant_rays);
  corrections = ray_corrections = {};
  box_of_correction.clear();
  for (const PlacedLine &c : moved.corrections)
  {
    corrections.add_segment(c.line.start, c.line.end, c.line.burgers);
    box_of_correction.push_back(c.box);
  }
  for (const RaySource &r : moved.ray_corrections)
    ray_corrections.add_ray(r.origin, r.direction, r.burgers);
}

void MultipoleStress::add_own_moments(const Box &box, const ExpansionView &moments) const
{
  std::vector<LineSource> own;
  own.reserve(box.own_lines_end - box.lines_begin);
  for (std::size_t k = box.lines_begin; k < box.own_lines_end; ++k)
    own.push_back(line(k));
  add_moments(order(), 0.1 * tolerance(), octree().centre(box), octree().size(box), own, moments);
}

void MultipoleStress::add_distant(const Box &box, const ExpansionView &expansion) const
{
  add_local_of_rays(order(), octree().centre(box), octree().size(box), rays, expansion);
}

void MultipoleStress::add_far(const Box &leaf, const Row *const fields, const double *const q)
{
  const LocalStress local(medium, order(), octree().centre(leaf), octree().size(leaf), fields, q);
  if (single_precision())
    local.add_in_single_precision(batch_of<6>(leaf));
  else
    local.add(batch_of<6>(leaf));
}

void MultipoleStress::add_near(const std::size_t leaf)
{
  const Octree &boxes = octree();
  const Box &box = boxes.boxes()[leaf];
  const StressBatch batch = batch_of<6>(box);
  const NearnessToPoints nearness(batch, single_precision() ? single_precision_distance * boxes.size(box) : 0.0);
  struct Lines
  {
    std::vector<unsigned> near, distant;
  };
  std::vector<Lines> of_image(boxes.image_shifts().size());
  boxes.for_each_near_link(
      leaf,
      [&](const NearLink &link, const std::uint32_t begin, const std::uint32_t end)
      {
        Lines &lines = of_image[link.image];
        for (std::uint32_t k = begin; k < end; ++k)
          (nearness.is_distant(boxes.line_spheres(), k, boxes.image_shifts()[link.image]) ? lines.distant : lines.near)
              .push_back(k);
      });
  for (std::size_t image = 0; image < of_image.size(); ++image)
    if (const Lines &lines = of_image[image]; !lines.near.empty() || !lines.distant.empty())
      add_near_lines(lines.near, lines.distant, box,
                     image == 0 ? batch : ShiftedBatch(batch, -boxes.image_shifts()[image]).batch,
                     boxes.image_shifts()[image]);
  add_ray_stress(medium, box.level < level_of_distant_rays ? ray_table : ray_corrections, batch);
  if (corrections.size() > 0)
    add_corrections(leaf, batch);
}

void MultipoleStress::add_corrections(const std::size_t leaf, const StressBatch &batch) const
{
  const DirectBoxes direct(octree(), leaf);
  std::vector<unsigned> distant;
  for (unsigned i = 0; i < corrections.size(); ++i)
    if (!direct.hold_lines_of(box_of_correction[i]))
      distant.push_back(i);
  add_segment_stress(medium, corrections, distant, batch);
}

void MultipoleStress::add_near_lines(const std::span<const unsigned> near, const std::span<const unsigned> distant,
                                     const Box &box, const StressBatch &batch, const Vec3 &shift) const
{
  add_segment_stress(medium, line_table, near, batch);
  if (single_precision())
    add_single_precision_stress(medium, line_table, distant, octree().centre(box) - shift, octree().size(box), batch);
  else
    add_distant_segment_stress(medium, line_table, distant, batch);
}

std::vector<SymTensor> MultipoleStress::stress(MPI_Comm comm, const Part part, const Recipient recipient,
                                               const LocalExpansions local)
{
  compute(comm, part, recipient, local);
  return take_in_given_order<SymTensor>(recipient);
}

std::vector<SymTensor> MultipoleStress::stress_with_kept_far_field(MPI_Comm comm, const KeptExpansions &use)
{
  evaluate(comm, use);
  return take_in_given_order<SymTensor>(use.recipient);
}

std::vector<SymTensor> MultipoleStress::stress_with_new_far_field(MPI_Comm comm)
{
  compute_again(comm);
  return take_in_given_order<SymTensor>();
}

void MultipoleStress::set_earlier(const std::span<const LineSource> lines, std::vector<RaySource> distant_rays)
{
  LineTable earlier = in_order_of_tree(lines);
  std::swap(line_table, earlier);
  rays.swap(distant_rays);
  compute_earlier();
  std::swap(line_table, earlier);
  rays.swap(distant_rays);
}
} // namespace ddfem::fmm
