// The far field of a network kept over several evaluations of the forces.
#pragma once

#include "dd/forces/frozen_lines.h"
#include "dd/forces/multipole_field.h"

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ddfem
{
/// When what distant boxes add to the stress is computed again; what near ones add always is.
enum class FarFieldRefresh : std::uint8_t
{
  every_evaluation,
  adaptive,      ///< when an estimate of its error reaches the tolerance
  every_n_steps, ///< "partial" of Durocher (thesis, Bordeaux 2018)
  never,         ///< it is left out: "cut-off"
};

struct RefreshSettings
{
  FarFieldRefresh mode = FarFieldRefresh::adaptive;
  unsigned interval = 20; ///< steps, for every_n_steps
  /// Allowed error of a kept far field, relative to the tolerance of the summation.
  double share_of_tolerance = 0.5;
};

/// What compute_nodal_forces() needs the stress of, and where. The sources of the images need not be set.
struct FieldRequest
{
  const LineSystem &system;
  const Network &network; ///< whose lines the system has
  std::span<const Vec3> points;
  const fmm::MultipoleSettings &settings;
  PeriodicImages *images; ///< null without a periodic cell
  MPI_Comm comm;
};

/**
 * Keeps the tree and the local expansions of one time. Near fields are those of the lines as they are; local expansions are
 * evaluated where the points are, and extrapolated along the motion of the lines between the last two refreshes, which
 * use one tree as long as the lines stay near their boxes. The error grows in proportion to the displacement of the lines besides
 * that motion, by a factor that is measured at every refresh: in a sample of leaves, the stress by the kept and by
 * the new far field are compared. What is kept changes at the first evaluation after begin_step() only: others leave no trace, and equal
 * networks get equal forces within a step. An evaluation that what is kept is no longer good for does without it. Virtual rays
 * and periodic images beyond the neighbours belong to the far field and are kept with it.
 */
class FarFieldCache
{
public:
  explicit FarFieldCache(const RefreshSettings &refresh_settings) : settings(refresh_settings) {}

  /// The next evaluation is at the start of a step.
  void begin_step() { at_start_of_step = true; }
  /// What follows depends only on the networks that follow, as after the construction. For checkpoints, in the run that writes one
  /// and in the run that reads it.
  void forget();

  struct Field
  {
    std::shared_ptr<MultipoleField> field; ///< as it was summed, until the next evaluation
    std::vector<SymTensor> stress;         ///< at the points of this rank at least, see fmm::Recipient
  };
  /// Collective; the values do not depend on the number of ranks and threads.
  Field evaluate(const FieldRequest &request);

  /// What has been done so far.
  struct Counts
  {
    unsigned refreshed = 0, kept = 0, trees = 0;
    unsigned without = 0; ///< far field computed, but not kept
  };
  const Counts &counts() const { return n; }
  /// Largest error measured so far of a far field that could be used still.
  double largest_error() const { return largest; }
  /// Error of the kept far field when it was last measured, relative to its rms, and the displacement then, nm.
  double measured_error() const { return error; }
  double measured_displacement() const { return displacement; }

private:
  struct Placement
  {
    LinesInBoxes lines;
    std::vector<Vec3> points; ///< their images in the boxes
    std::vector<std::uint32_t> leaf_of_point;
  };
  /// Of the error of the far field with the displacement.
  struct Growth
  {
    double rate = 0;    ///< 1/nm; 0: not known
    double trusted = 0; ///< displacement up to which it is, nm

    double allowed(double tolerated) const;
    void learn(double tolerated, double error, double displacement);
  };
  struct Kept
  {
    std::shared_ptr<MultipoleField> field;
    FrozenLines lines;
    std::size_t n_lines;                                 ///< when the tree was made
    PeriodicImages::Coefficients images, earlier_images; ///< empty without
    double at_last_start = 0;                            ///< displacement when the last step began, nm
    unsigned n_steps = 0;                                ///< since the refresh
  };
  /// The kept field at some points before a refresh.
  struct Sample
  {
    std::vector<std::size_t> points;
    std::vector<SymTensor> far, all; ///< MPa, at all points; zero at others
    double displacement;             ///< nm
  };

  std::optional<Placement> place(const FieldRequest &request) const;
  double displacement_of(const Placement &placement) const;

  double tolerated_error(const FieldRequest &request) const;
  double allowed_displacement(const FieldRequest &request) const;
  bool is_due(const FieldRequest &request, const Placement &placement);
  bool is_allowed(const FieldRequest &request, const Placement &placement) const;
  bool tree_is_good(const std::optional<Placement> &placement, std::size_t n_lines) const;
  Field refresh(const FieldRequest &request, std::optional<Placement> placement);
  Field refresh_in_new_tree(const FieldRequest &request);
  Field refresh_in_same_tree(const FieldRequest &request, Placement placement);
  void move(const FieldRequest &request, const Placement &placement);
  void set_earlier(const FieldRequest &request);
  Sample sample(const FieldRequest &request, const Placement &placement);
  void learn(const FieldRequest &request, const Sample &before, const std::vector<SymTensor> &now);

  RefreshSettings settings;
  std::unique_ptr<Kept> kept;
  bool at_start_of_step = false;
  Growth growth;
  double error = 0, displacement = 0, largest = 0;
  Counts n;
};
} // namespace ddfem
