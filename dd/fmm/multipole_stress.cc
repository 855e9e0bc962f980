#include "dd/fmm/multipole_stress.h"

#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/fmm/accuracy.h"
#include "dd/fmm/grids_and_rays.h"

namespace ddfem::fmm
{
namespace
{
/// A batch at points moved by @p shift (nm).
struct ShiftedBatch
{
  std::array<std::vector<double>, 3> x;
  StressBatch batch;

  ShiftedBatch(const StressBatch &given, const Vec3 &shift) : batch(given)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      for (std::size_t i = 0; i < given.n; ++i)
        x[c].push_back(given.x[c][i] + shift[static_cast<int>(c)]);
      batch.x[c] = x[c].data();
    }
  }
};
} // namespace

MultipoleStress::MultipoleStress(const IsotropicMedium &medium_, const MultipoleSettings &given, const RootGrid &grid,
                                 const std::span<const LineSource> lines, const std::span<const RaySource> distant_rays,
                                 const std::span<const Vec3> points)
    : MultipoleSum(given, grid, extents_of(lines), points, smallest_box(medium_.a, given.tolerance), 6),
      medium(medium_), rays(distant_rays.begin(), distant_rays.end())
{
  sources.reserve(lines.size());
  for (const std::uint32_t i : octree().line_order())
  {
    sources.push_back(lines[i]);
    line_table.add_segment(lines[i].start, lines[i].end, lines[i].burgers);
  }
  for (const RaySource &r : rays)
    ray_table.add_ray(r.origin, r.direction, r.burgers);
}

void MultipoleStress::add_own_moments(const Box &box, const ExpansionView &moments) const
{
  const std::span own(sources.data() + box.lines_begin, box.own_lines_end - box.lines_begin);
  add_moments(order(), 0.1 * tolerance(), octree().centre(box), octree().size(box), own, moments);
}

void MultipoleStress::add_distant(const Box &box, const ExpansionView &expansion) const
{
  if (box.level == level_of_distant_rays)
    add_local_of_rays(order(), octree().centre(box), octree().size(box), rays, expansion);
}

void MultipoleStress::add_far(const Box &leaf, const Row *const fields, const double *const q)
{
  LocalStress(medium, order(), octree().centre(leaf), octree().size(leaf), fields, q).add(batch_of<6>(leaf));
}

void MultipoleStress::add_near(const std::size_t leaf)
{
  const Octree &boxes = octree();
  std::vector<std::vector<unsigned>> near(boxes.image_shifts().size()); // by image
  boxes.for_each_near_link(leaf,
                           [&](const NearLink &link, const std::uint32_t begin, const std::uint32_t end)
                           {
                             for (std::uint32_t k = begin; k < end; ++k)
                               near[link.image].push_back(k);
                           });
  const StressBatch batch = batch_of<6>(boxes.boxes()[leaf]);
  add_segment_stress(medium, line_table, near[0], batch);
  for (std::size_t image = 1; image < near.size(); ++image)
    if (!near[image].empty())
      add_segment_stress(medium, line_table, near[image], ShiftedBatch(batch, -boxes.image_shifts()[image]).batch);
  if (boxes.boxes()[leaf].level < level_of_distant_rays)
    add_ray_stress(medium, ray_table, batch);
}

std::vector<SymTensor> MultipoleStress::stress(MPI_Comm comm, const Part part)
{
  compute(comm, part);
  return in_given_order<SymTensor>();
}
} // namespace ddfem::fmm
