// Lines in the boxes they were in when their far field was computed.
#pragma once

#include "dd/forces/frozen_rays.h"
#include "dd/forces/line_system.h"
#include "dd/forces/lines_in_boxes.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ddfem
{
/**
 * Lines of a network at one time, and their boxes. Later, a line that still exists stays in its box. Lines that have appeared,
 * gone, or jumped form patches of what shares nodes; the new ones go to one box of a gone one. The other gone lines of the patch are
 * taken over from their boxes: G in its old box and -G in the new one. Points near both see neither, those near the
 * old box only see G, which the new lines replace nowhere else, and those near the new box only see -G, which the expansions
 * still hold. Patches with a ray that is corrected, and such for which no box will do, are corrected like these (FrozenRays), but
 * not in periodic cells, whose images are too many.
 */
class FrozenLines
{
public:
  /// @p box: of @p lines, which are those of the network and pieces of the rays. @p before: null, or the lines at an earlier time,
  /// since when they have moved.
  FrozenLines(const Network &network, const LineSystem &system, std::span<const fmm::LineSource> lines,
              std::span<const std::uint32_t> box, const CutRays &cuts, const FrozenLines *before);

  void forget_motion();
  struct Earlier
  {
    std::vector<fmm::LineSource> lines; ///< and pieces of rays
    std::vector<fmm::RaySource> distant_rays;
  };
  /// All before their motion, in the order that the constructor was given; new ones have moved with their neighbours.
  Earlier earlier(const Network &network) const;

  /// Lines of the network as it is now in the boxes of @p tree; empty if one is too far from its box, or none that it came
  /// from is known. @p longest_jump: of the end of a line from where it was foreseen, in box sizes; longer ones are changes of topology. A
  /// line of another box that ends there is distant for some points for which this one is near: they see a gap.
  std::optional<LinesInBoxes> place(const Network &network, const LineSystem &system, const fmm::Octree &tree,
                                    double longest_jump) const;

private:
  struct Line
  {
    ObjectId id, start_node, end_node;
    StraightLine line;
    std::uint32_t box;
    Vec3 start_motion = Vec3::Zero(), end_motion = Vec3::Zero(); ///< before, nm
  };
  struct Motion
  {
    Vec3 start, end; ///< of the ends of a line, nm

    /// That @p line sweeps, nm^2: what its far field changes by. Motion along itself sweeps none.
    Vec3 area(const Vec3 &line) const { return 0.5 * (start + end).cross(line); }
  };
  struct Patch
  {
    std::vector<std::size_t> gone, appeared; ///< numbers of frozen lines, and of lines of the system
  };

  static Motion motion_of(const Line &old, const StraightLine &now, const PeriodicCell *cell);
  bool place_known(const std::vector<const Line *> &known, double longest_jump, const LineSystem &system,
                   const fmm::Octree &tree, LinesInBoxes &placed, std::vector<std::uint8_t> &is_here,
                   double &squares) const;
  void join_motion(std::span<const std::size_t> appeared, const LineSystem &system, const FrozenLines &before);
  const Line *find(const Network &network, SegmentIndex s) const;
  std::vector<Patch> patches(const Network &network, const std::vector<std::uint8_t> &is_here,
                             const LinesInBoxes &placed) const;
  bool place_patch(const Patch &patch, const LineSystem &system, const fmm::Octree &tree, LinesInBoxes &placed,
                   double &swept) const;
  void correct_patch(const Patch &patch, const LineSystem &system, const fmm::Octree &tree, LinesInBoxes &placed) const;
  bool has_node_of(const Patch &patch, const Network &network, const FrozenRays::Nodes &nodes) const;
  static StraightLine extrapolated(const Line &l, double ahead);
  double area_swept_by(const Patch &patch, const Line &host, const LineSystem &system, double ahead) const;
  bool fits(const Patch &patch, const Line &host, const LineSystem &system, const fmm::Octree &tree) const;

  std::vector<Line> frozen; ///< in the order of their ids
  FrozenRays rays;
};
} // namespace ddfem
