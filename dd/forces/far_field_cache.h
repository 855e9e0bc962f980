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

/// What compute_nodal_forces() needs the stress of, and where.
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
 * Keeps the tree and the local expansions of one time. Near fields are those of the lines as they are, local expansions are
 * evaluated where the points are. The error of a kept far field grows in proportion to the displacement of the lines since, by a
 * factor that is measured at every refresh: in a sample of leaves, the stress by the kept and by the new far field are compared.
 * What is kept changes at the first evaluation after begin_step() only: others leave no trace, and equal networks get
 * equal forces within a step. An evaluation that what is kept is no longer good for does without it.
 *
 * Virtual rays are not followed: with any, the far field is computed at every evaluation.
 */
class FarFieldCache
{
public:
  explicit FarFieldCache(const RefreshSettings &refresh_settings) : settings(refresh_settings) {}

  /// The next evaluation is at the start of a step.
  void begin_step() { at_start_of_step = true; }

  struct Field
  {
    std::shared_ptr<MultipoleField> field; ///< as it was summed, until the next evaluation
    std::vector<SymTensor> stress;         ///< at the points
  };
  /// Collective; all ranks get all values, which do not depend on the number of ranks and threads.
  Field evaluate(const FieldRequest &request);

  /// What has been done so far.
  struct Counts
  {
    unsigned refreshed = 0, kept = 0;
    unsigned without = 0; ///< far field computed, but not kept
  };
  const Counts &counts() const { return n; }
  /// Error of the kept far field at the last refresh, relative to its rms, and rms displacement of the lines until then, nm.
  double measured_error() const { return error; }
  double measured_displacement() const { return displacement; }

private:
  struct Placement
  {
    LinesInBoxes lines;
    std::vector<std::uint32_t> leaf_of_point;
  };
  struct Kept
  {
    std::shared_ptr<MultipoleField> field;
    FrozenLines lines;
    double at_last_start = 0; ///< displacement when the last step began, nm
    unsigned n_steps = 0;     ///< since
  };

  std::optional<Placement> place(const FieldRequest &request) const;
  bool is_due(const Placement &placement);
  bool is_allowed(const Placement &placement) const;
  Field refresh(const FieldRequest &request, const std::optional<Placement> &placement);
  void measure(const FieldRequest &request, const Placement &placement, const std::vector<SymTensor> &exact);
  void move(const FieldRequest &request, const Placement &placement);

  RefreshSettings settings;
  std::unique_ptr<Kept> kept;
  bool at_start_of_step = false;
  double allowed_displacement = 0; ///< of the lines from where they were at the refresh, nm
  double error = 0, displacement = 0;
  Counts n;
};
} // namespace ddfem
