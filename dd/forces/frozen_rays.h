// Virtual rays at the time when their far field was computed.
#pragma once

#include "dd/forces/lines_in_boxes.h"
#include "dd/forces/virtual_rays.h"

#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace ddfem
{
/**
 * Rays at one time, and the boxes of their pieces. Later, the ray of a node that still has one is cut at the same ways from its
 * origin, and its pieces stay in their boxes. Rays that have appeared, gone, turned, or jumped are corrected at all points for which
 * pieces are distant, in closed form: they reach through many boxes.
 */
class FrozenRays
{
public:
  /// @p box: of all pieces, in their order.
  FrozenRays(std::span<const VirtualRay> rays, const CutRays &cuts, std::span<const std::uint32_t> box);

  /// Origins move as the ends of lines do, @p motion_of (nm).
  void set_motion(const FrozenRays &before, const std::unordered_map<ObjectId, Vec3> &motion_of);
  void forget_motion();
  /// Appends pieces and distant parts before their motion, in the order that the constructor was given.
  void append_earlier(std::vector<fmm::LineSource> &lines, std::vector<fmm::RaySource> &distant) const;

  /// Which rays have not been followed, by their nodes.
  using Nodes = std::unordered_set<ObjectId>;
  /// Appends the rays @p now to @p placed; empty if one is too far from its boxes. @p longest_jump: see FrozenLines::place(). @p squares:
  /// adds the squares of the areas that first pieces have swept besides their motion, nm^4.
  std::optional<Nodes> place(std::span<const VirtualRay> now, const fmm::Octree &tree, double longest_jump,
                             LinesInBoxes &placed, double &squares) const;

private:
  struct Ray
  {
    ObjectId node;
    fmm::RaySource source;
    std::vector<double> ways;
    std::vector<std::uint32_t> box;
    std::size_t order; ///< in what the constructor was given
    Vec3 origin_motion = Vec3::Zero(), direction_motion = Vec3::Zero();

    fmm::RaySource moved(double times) const;
  };

  const Ray *find(const VirtualRay &ray) const;
  static bool has_jumped(const Ray &old, const fmm::RaySource &now, double ahead, const fmm::Octree &tree,
                         double longest_jump);
  void place_new(const fmm::RaySource &ray, const fmm::Octree &tree, LinesInBoxes &placed) const;

  std::vector<Ray> frozen; ///< in the order of their nodes
  fmm::RootGrid grid;
  double shortest;
};
} // namespace ddfem
