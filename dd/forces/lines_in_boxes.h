// Lines and rays as a tree made at another time takes them.
#pragma once

#include "dd/fmm/multipole_stress.h"
#include "dd/forces/virtual_rays.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ddfem
{
inline fmm::RaySource source_of(const VirtualRay &ray)
{
  return {ray.origin, ray.direction, ray.burgers};
}

/// Rays as segments up to the boundary of the root, and what is left of them.
struct CutRays
{
  fmm::RootGrid grid;
  double shortest = 0;                   ///< piece, nm
  std::vector<std::vector<double>> ways; ///< of each ray, see fmm::cuts_of()
};

/// Sources for a tree made at another time. Each acts exactly once: on near points directly, and on distant ones by what the expansions
/// of that time hold of it.
struct LinesInBoxes
{
  /// Those of the system in its order, pieces of its rays, then what corrects changes of topology.
  std::vector<fmm::LineSource> lines;
  std::vector<std::uint32_t> box;
  std::size_t n_of_system = 0; ///< pieces of rays included
  std::vector<fmm::RaySource> distant_rays;
  CutRays cuts;
  /// What the expansions hold of lines and rays that have gone, with -b, and do not hold of new ones.
  std::vector<fmm::PlacedLine> corrections;
  std::vector<fmm::RaySource> ray_corrections;
  /// Part of the motion of the lines before (see FrozenLines) that their motion since is nearest to.
  double ahead = 0;
  double displacement = 0; ///< rms, across the lines, of what `ahead` leaves of it, nm
  double curvature = 0;    ///< mean square of the motion before times ahead (1 + ahead), nm^2
  double jump = 0;         ///< displacement of all lines that acts as the changes of topology do, nm
  double farthest = 0;     ///< middle of a line outside its box, in box sizes; infinite if one has no box of its own

  fmm::MovedSources sources() const { return {lines, box, distant_rays, corrections, ray_corrections}; }
  bool has_corrections() const
  {
    return lines.size() > n_of_system || !corrections.empty() || !ray_corrections.empty();
  }
  /// For new moments, which hold every line of the system in its box.
  void drop_corrections();
  /// Notes how far the middle of a line lies outside its box; whether that is little.
  bool stays(const Vec3 &middle, std::uint32_t in_box, const fmm::Octree &tree);
  /// Box for a line that the expansions do not hold, and acts in closed form where that is distant.
  std::uint32_t box_of_new(const fmm::LineSource &line, const fmm::Octree &tree);
};
} // namespace ddfem
