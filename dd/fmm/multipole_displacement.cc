#include "dd/fmm/multipole_displacement.h"

#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "dd/fmm/displacement_expansion.h"
#include "dd/fmm/grids_and_rays.h"

namespace ddfem::fmm
{
namespace
{
std::vector<SourceExtent> extents_of(const std::span<const TriangularLoop> loops)
{
  std::vector<SourceExtent> extents;
  extents.reserve(loops.size());
  for (const TriangularLoop &l : loops)
    extents.push_back({l.middle(), 2 * l.radius()});
  return extents;
}
} // namespace

MultipoleDisplacement::MultipoleDisplacement(const double nu_, const MultipoleSettings &given,
                                             const std::span<const TriangularLoop> loops,
                                             const std::span<const Vec3> points)
    : MultipoleDisplacement(nu_, given, loops, extents_of(loops), points)
{
}

MultipoleDisplacement::MultipoleDisplacement(const double nu_, const MultipoleSettings &given,
                                             const std::span<const TriangularLoop> loops,
                                             const std::span<const SourceExtent> extents,
                                             const std::span<const Vec3> points)
    : MultipoleSum(given, enclosing_grid(extents, {}, points), extents, points, 0.0, 3), nu(nu_)
{
  sources.reserve(loops.size());
  for (const std::uint32_t i : octree().line_order())
    sources.push_back(loops[i]);
}

void MultipoleDisplacement::add_own_moments(const Box &box, const ExpansionView &moments) const
{
  const std::span own(sources.data() + box.lines_begin, box.own_lines_end - box.lines_begin);
  add_moments(order(), 0.1 * tolerance(), nu, octree().centre(box), octree().size(box), own, moments);
}

void MultipoleDisplacement::add_far(const Box &leaf, const Row *const fields, const double *const q)
{
  LocalDisplacement(nu, order(), octree().centre(leaf), octree().size(leaf), fields, q).add(batch_of<3>(leaf));
}

void MultipoleDisplacement::add_near(const std::size_t leaf)
{
  const DisplacementBatch batch = batch_of<3>(octree().boxes()[leaf]);
  octree().for_each_near_link(leaf,
                              [&](const NearLink &, const std::uint32_t begin, const std::uint32_t end) {
                                add_triangle_displacement(nu, std::span(sources).subspan(begin, end - begin), batch);
                              });
}

std::vector<Vec3> MultipoleDisplacement::displacement(MPI_Comm comm, const Part part)
{
  compute(comm, part);
  return take_in_given_order<Vec3>();
}
} // namespace ddfem::fmm
