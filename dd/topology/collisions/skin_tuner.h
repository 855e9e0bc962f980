// How much room a Verlet list should leave for motion before it is rebuilt.
#pragma once

#include <array>
#include <cstddef>

namespace ddfem
{
/// Chooses the skin of a list of candidate pairs: a wide skin makes builds rare, but each of them and the list longer.
/// Minimised is the cost of a step,
///   (build_cost n + test_cost T(skin) + enter_cost m) / steps(skin) + pair_cost P(skin)
/// for n segments, T sphere tests of a build, m segments entered between two builds, and P pairs. P is known from the
/// last build for smaller skins (a histogram of the distances found) and continued as a power of the reach for larger
/// ones; T grows as the square of the cell width (lines in space: between that of one line and that of filled space);
/// steps = skin / (2 drift), where the drift per step is what the nodes show. Counts, no times: the choice is the same
/// on every machine and with any number of threads.
class SkinTuner
{
public:
  /// Costs in ns of one core, measured (docs/benchmarks.md); only their ratios matter.
  static constexpr double build_cost = 300;  ///< per segment: references, spheres, sorting
  static constexpr double test_cost = 1.5;   ///< per pair of spheres compared
  static constexpr double enter_cost = 2500; ///< per segment entered one by one
  static constexpr double pair_cost = 60;    ///< per pair and step: exact detection
  /// A list is made for drifts this much larger than expected.
  static constexpr double safety = 1.05;

  static constexpr std::size_t n_bins = 16;
  /// What a build has found.
  struct Build
  {
    double n_segments = 0, sphere_tests = 0;
    double reach = 0; ///< largest distance of the centres of two candidate spheres with a skin of zero, nm
    double skin = 0;  ///< nm
    /// Pairs by the skin that they need: bin k counts those between k and k + 1 parts of n_bins of this one, bin 0 also
    /// those that are candidates without a skin.
    std::array<std::size_t, n_bins> pairs{};
  };
  void record(const Build &build) { last_ = build; }

  /// A list has served @p steps steps, in which @p entered segments were entered. @p expired: nodes have left their
  /// skin (otherwise it was given up for another reason). @p displacement: of typical fast nodes in the coming step,
  /// nm.
  void retire(std::size_t steps, std::size_t entered, bool expired, double displacement);

  /// Skin (nm) for the next list, enough for at least one step of @p displacement. @p reach as in Build.
  double choose(double displacement, double reach) const;

  /// Expected cost of a step with the skin @p skin, by the last build.
  double cost(double skin) const;

private:
  double pairs(double skin) const;

  Build last_;
  double entered_ = 0;
  double drift_ = -1; ///< nm per step, negative: unknown
};
} // namespace ddfem
