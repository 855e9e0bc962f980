// Everything that makes up the infinite-body field: the network's segments, virtual rays, periodic images.
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/line_table.h"
#include "dd/forces/open_lines.h"
#include "dd/forces/periodic_images.h"
#include "dd/forces/virtual_rays.h"
#include "dd/geometry/periodic_cell.h"
#include "dd/network/network.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace ddfem
{
/// Who makes the lines of a system the sources of its periodic images.
enum class ImageSources : std::uint8_t
{
  set_at_once,
  set_by_user ///< of the system, with PeriodicImages::set_sources(); they may stay those of another time
};

/// Snapshot of the sources of the `infinite` field. In a periodic cell `lines` are shifted so that their mid-points lie
/// in the primary cell, and `far_images` holds the field of all images beyond the 26 neighbours.
class LineSystem
{
public:
  /// @p shape: the finite grain, or null; @p images: the periodic cell's image operator, or null (it is updated).
  LineSystem(const IsotropicMedium &medium, const Network &network, const GrainShape *shape, RayDirection rule,
             const PeriodicCell *cell, PeriodicImages *images, ImageSources sources = ImageSources::set_at_once);

  /// Adds @p open with opposite Burgers vectors: the sources of the field become closed lines (see OpenLines).
  void close(const OpenLines &open);

  const IsotropicMedium &medium() const { return elastic_medium; }
  /// In the order of Network::segments(), followed by what close() has added.
  const std::vector<StraightLine> &lines() const { return straight_lines; }
  const std::vector<VirtualRay> &rays() const { return virtual_ray_list; }
  /// lines() as the vectorised kernels read them, made by the first call. Safe to call from any thread.
  const LineTable &segment_table() const;
  /// rays() likewise.
  const LineTable &ray_table() const { return rays_in_table; }
  /// Shifts of the near images (zero first); a single zero without periodicity.
  const std::vector<Vec3> &image_shifts() const { return shifts; }
  const PeriodicImages *far_images() const { return images; }
  const PeriodicCell *cell() const { return periodic_cell; }
  /// Lattice vector that takes @p x into the cell; zero without one, nm.
  Vec3 shift_into_cell(const Vec3 &x) const
  {
    return periodic_cell ? periodic_cell->shift_into_cell(x) : Vec3(Vec3::Zero());
  }

  /// Infinite-body stress (dislocations only, no applied stress) at a point, MPa.
  SymTensor stress(const Vec3 &x) const;
  /// The same at many points, threaded; independent of the number of threads.
  std::vector<SymTensor> stress(std::span<const Vec3> points) const;
  /// Distance from @p x to the nearest line or ray, nm (infinity without lines); images not considered.
  double distance(const Vec3 &x) const;

private:
  void add_ray(const VirtualRay &ray);
  /// Adds the stress at the points, in one thread.
  void add_stress(std::span<const Vec3> points, std::span<SymTensor> values) const;

  /// Sums by multipoles do without it, and it is larger than the lines.
  struct SegmentTable
  {
    std::once_flag is_made;
    LineTable table;
  };

  IsotropicMedium elastic_medium;
  std::vector<StraightLine> straight_lines;
  std::vector<VirtualRay> virtual_ray_list;
  std::shared_ptr<SegmentTable> segments =
      std::make_shared<SegmentTable>(); ///< shared by copies, which have the same lines
  LineTable rays_in_table;
  std::vector<Vec3> shifts;
  const PeriodicCell *periodic_cell;
  const PeriodicImages *images;
};
} // namespace ddfem
