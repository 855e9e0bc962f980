// Lines in the boxes they were in when their far field was computed.
#pragma once

#include "dd/fmm/octree.h"
#include "dd/forces/line_system.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ddfem
{
/// Lines for a tree made at another time. Each acts exactly once: on near points directly, and on distant ones by what the expansions
/// of that time hold of it.
struct LinesInBoxes
{
  std::vector<fmm::LineSource> lines; ///< those of the system in its order, then what corrects changes of topology
  std::vector<std::uint32_t> box;
  /// Part of the motion of the lines before (see FrozenLines) that their motion since is nearest to.
  double ahead = 0;
  double displacement = 0;     ///< rms, across the lines, of what `ahead` leaves of it, nm
  double curvature = 0;        ///< mean square of the motion before times ahead (1 + ahead), nm^2
  double jump = 0;             ///< displacement of all lines that acts as the changes of topology do, nm
  double farthest = 0;         ///< middle of a line outside its box, in box sizes
  bool in_system_frame = true; ///< all lines are the images that the system has

  bool has_corrections(const std::size_t n_lines) const { return lines.size() > n_lines; }
  /// For new moments, which hold every one of the @p n_lines lines of the system in its box.
  void drop_corrections(const std::size_t n_lines)
  {
    lines.resize(n_lines);
    box.resize(n_lines);
  }
};

/**
 * Lines of a network at one time, and their boxes. Later, a line that still exists stays in its box. Lines that have appeared,
 * gone, or jumped form patches of what shares nodes; the new ones go to one box of a gone one. The other gone lines of the patch are
 * taken over from their boxes: G in its old box and -G in the new one. Points near both see neither, those near the
 * old box only see G, which the new lines replace nowhere else, and those near the new box only see -G, which the expansions
 * still hold.
 */
class FrozenLines
{
public:
  /// @p lines of the network in boxes @p box. @p before: null, or the lines at an earlier time, since when they have moved.
  FrozenLines(const Network &network, std::span<const fmm::LineSource> lines, std::span<const std::uint32_t> box,
              const FrozenLines *before, const PeriodicCell *cell);

  void forget_motion();
  /// @p lines before their motion, in the order that the constructor was given; new ones have moved with their neighbours.
  std::vector<fmm::LineSource> earlier(const Network &network, std::span<const fmm::LineSource> lines) const;

  /// Lines of the network as it is now in the boxes of @p tree; empty if one is too far from its box, or none that it came
  /// from is known.
  std::optional<LinesInBoxes> place(const Network &network, const LineSystem &system, const fmm::Octree &tree) const;

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
  bool place_known(const std::vector<const Line *> &known, double limit, const LineSystem &system,
                   const fmm::Octree &tree, LinesInBoxes &placed, std::vector<std::uint8_t> &is_here,
                   double &squares) const;
  void join_motion(std::span<const std::size_t> appeared);
  const Line *find(const Network &network, SegmentIndex s) const;
  std::vector<Patch> patches(const Network &network, const std::vector<std::uint8_t> &is_here,
                             const LinesInBoxes &placed) const;
  bool place_patch(const Patch &patch, const LineSystem &system, const fmm::Octree &tree, LinesInBoxes &placed,
                   double &swept) const;
  static StraightLine extrapolated(const Line &l, double ahead);
  double area_swept_by(const Patch &patch, const Line &host, const LineSystem &system, double ahead) const;
  bool fits(const Patch &patch, const Line &host, const LineSystem &system, const fmm::Octree &tree) const;

  std::vector<Line> frozen; ///< in the order of their ids
};
} // namespace ddfem
