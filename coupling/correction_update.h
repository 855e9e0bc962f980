// When the correction has to be solved anew, and what stands for it in between.
#pragma once

#include "coupling/finite_grain.h"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace ddfem::coupling
{
/// What changes the correction: small loops of swept area, as moments b (x) A (nm^3) at points (nm). Those in one cube of a grid
/// are merged in their centre, weighted by their magnitudes.
class ChangeSources
{
public:
  /// @p cube: edge of the cubes, nm.
  explicit ChangeSources(double cube) : edge(cube) {}
  void add(const Vec3 &x, const Mat3 &moment);
  struct Source
  {
    Vec3 position;
    Mat3 moment;
  };
  std::vector<Source> sources() const;

private:
  struct Sum
  {
    Vec3 weighted_position = Vec3::Zero();
    double weight = 0;
    Mat3 moment = Mat3::Zero();
  };
  double edge;
  std::map<std::array<int, 3>, Sum> cubes; // ordered: the same sums on all ranks
};

/// rms over the segments of the Peach-Koehler force of a stress (MPa, at the points of the segments) per length and Burgers vector, MPa.
double force_norm(const Network &network, const SegmentPoints &points, const std::vector<SymTensor> &stress);

/// Stands between the time loop and the solver, and lets a step do without a solve as long as the error that this makes in the
/// segment forces is estimated to be small (docs/theory.md, section 6).
///
/// The correction is linear in what the lines have swept. What was swept since the last solve is compared with what was swept
/// between the last two by the field of its mirror images, mu |b (x) A| / (2 pi (1-nu) R^3) at the segments, R being the distance to
/// the mirror image. The multiple theta of the latter that is nearest to the former, in the mean square over the segments, extrapolates the
/// solution of the finite elements; the rest is the error. Images under flat faces follow the lines in every step, and the load of
/// the platens at rest is corrected by Betti's theorem.
class CorrectionUpdate
{
public:
  struct Counts
  {
    unsigned solves = 0, skips = 0;
  };

  /// @p tolerance: allowed estimate of the error over the force scale; zero: every step solves. @p grain must outlive the object.
  CorrectionUpdate(FiniteGrain &grain, const IsotropicMedium &medium, double tolerance);

  /// Takes notice of a step's swept area. Collective.
  void add_swept(const SweptArea &area);
  /// The force scale, if steps may do without a solve: force_norm() of the correction, but at least mu b / diameter, the stress that bends a line as much as the
  /// grain.
  void set_scale(const Network &network, const SegmentField &correction);
  /// The correction with the platen at rest, solved or extrapolated. Collective.
  GrainSolution solve_at_rest(const LineSystem &lines, const Network &network);
  /// The next steps solve, as after the start: what they give depends only on lines, displacements and start vectors. For
  /// checkpoints, in the run that writes one and in the run that reads it.
  void forget();

  bool enabled() const { return tolerance > 0; }
  /// Of the last step: estimated error over the force scale; zero after a solve.
  double estimate() const { return last_estimate; }
  double force_scale() const { return scale; } ///< MPa
  const Counts &counts() const { return n; }

private:
  /// Segments with an image under a plane, and what they contribute to the sources when they gain or lose it.
  using ImageLines = std::map<std::pair<ObjectId, std::size_t>, ChangeSources::Source>;
  struct Prediction
  {
    double theta, error; ///< MPa
  };

  bool must_solve(const Network &network) const;
  Prediction predict(const Network &network, const ChangeSources &since) const;
  std::array<double, 3> products(const Network &network, const ChangeSources &since) const;
  ImageLines image_lines(const Network &network) const;
  ChangeSources all_since(const Network &network) const;
  GrainSolution solve(const LineSystem &lines, const Network &network);
  GrainSolution extrapolate(const LineSystem &lines, double theta);

  /// Both measured (docs/validation.md): a point sees the images under several faces, and the response of the platens, of which the
  /// estimate counts the nearest only; and fields of sources that agree here differ in truth.
  static constexpr double images_seen = 20, distrust = 0.1;
  static constexpr unsigned most_skips = 50;          ///< one after another
  static constexpr std::size_t most_receivers = 1000; ///< segments at which the error is estimated

  FiniteGrain &grain;
  IsotropicMedium medium;
  double tolerance, scale = 0, last_estimate = 0;
  std::vector<FiniteGrain::ElementState> states; ///< of the last two solves, the latest first
  ChangeSources since_last, between;
  ImageLines lines_with_image;   ///< at the last solve
  std::size_t surface_nodes = 0; ///< then
  GrainSolution last_solution;
  double load_change = 0; ///< of the load at rest since the last solve, by Betti's theorem
  unsigned skipped = 0;
  Counts n;
};
} // namespace ddfem::coupling
