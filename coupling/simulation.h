// The time loop.
#pragma once

#include "coupling/correction_update.h"
#include "coupling/energy_balance.h"
#include "coupling/finite_grain.h"
#include "coupling/initial_network.h"
#include "coupling/loading.h"
#include "coupling/parameters.h"
#include "coupling/run_output.h"
#include "coupling/timing.h"
#include "dd/forces/nodal_forces.h"
#include "dd/integrators/brownian_chebyshev.h"
#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/topology_context.h"

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace ddfem::coupling
{
/// Why a run ended.
enum class RunEnd
{
  finished,
  interrupted ///< by SIGINT or SIGTERM
};

/// A network in its surroundings, and its motion. The network is replicated on all ranks of the communicator and changed
/// identically everywhere.
class Simulation
{
public:
  /// Builds network and grain. Throws InputError for input that contradicts itself.
  Simulation(const Parameters &parameters, MPI_Comm communicator);

  /// Runs to a stop criterion. Throws std::runtime_error for numerical failure.
  RunEnd run(RunOutput &output);

  /// Takes the initial network as the reference state and solves its boundary-value problem (finite mode; nothing otherwise).
  void start();

  /// Nodal forces of the present state, with contributions.
  NodalForces forces();
  /// Infinite-body and correction stress (zero outside finite mode) at points, MPa.
  std::vector<SymTensor> infinite_stress(const std::vector<Vec3> &points);
  std::vector<SymTensor> correction_stress(const std::vector<Vec3> &points) const;

  /// What can be known before the run, in a few lines.
  std::string summary() const;

  const Network &network() const { return dislocations; }
  const FiniteGrain *grain() const { return finite_grain.get(); }
  const TopologyCounts &topology_counts() const { return counts; }
  const SymTensor &plastic_strain() const { return total_plastic_strain; }
  double current_time() const { return time; } ///< ns
  /// Nominal strain and stress along the loading; zero strain for a stress given as a tensor.
  LoadState load_state() const;
  double nominal_strain() const { return load_state().strain; }
  std::size_t stage() const { return loading.stage(); } ///< of the loading, from 0
  const EnergyBalance &energy_balance() const { return energy; }
  /// Null outside finite mode.
  const CorrectionUpdate *correction_update() const { return update.get(); }
  const GrainSolution &grain_solution() const { return solution; }
  /// Called after the correction of each step, extrapolated or solved, with the sources of the boundary-value problem.
  using Observer = std::function<void(FiniteGrain &, const LineSystem &)>;
  void observe_correction(Observer called) { observer = std::move(called); }
  /// Stress that acts on the dislocations besides their own fields in periodic and infinite mode, MPa.
  SymTensor applied_stress() const;

private:
  LineSystem line_system();
  /// The sources of the boundary-value problem: with open lines closed by their initial position.
  LineSystem closed_line_system();
  ForceEnvironment environment();
  TopologyContext topology_context(std::vector<Vec3> displacement);
  void solve_lines();
  void update_correction(const LineWork &lines);
  void read_correction();
  void start_loading();
  void update_loading(const LineWork &lines);
  void apply_load(const LineWork &lines);
  void balance_energy();
  Energies energies() const { return energy.energies_with(platen_work_since_balance, work_since_balance); }
  BodyResponse body_response() const;
  LoadWithinStep load_within_step() const;
  LineWork work_of_step(const IntegratorStep &step) const;
  double work_on_swept_area() const;
  IntegratorStep move_lines();
  void change_topology(TopologyContext &context, const IntegratorStep &step);
  /// For the step that begins: random numbers are those of its number. @p drag: of the nodes, MPa ns nm.
  BrownianMotion brownian_motion(VelocityFunction velocity, const std::vector<double> &drag) const;
  std::vector<SymTensor> total_stress(const std::vector<Vec3> &points);
  void cross_slip_lines(TopologyContext &context, double dt);
  void book(LineWork &work);
  double axial_plastic_strain() const;
  double reference_volume() const;
  double time_left() const;
  bool must_stop(const IntegratorStep &step) const;
  void check_consistency() const;
  HistoryRow history_row(const IntegratorStep &step) const;
  void report(RunOutput &output, const IntegratorStep &step, bool last);
  std::string status_line(const IntegratorStep &step) const;
  std::string energy_line() const;
  std::string far_field_line() const;
  std::string images_line() const;

  Parameters parameters;
  MPI_Comm communicator;
  Network dislocations;
  std::unique_ptr<FiniteGrain> finite_grain;
  std::unique_ptr<PeriodicImages> images;
  FarFieldCache far_field;
  std::shared_ptr<fmm::WorkCosts> costs = std::make_shared<fmm::WorkCosts>(); ///< of the forces
  OpenLines initial_open_lines;
  ProductPlane product_plane;
  VelocitySolver velocities;
  std::unique_ptr<Integrator> integrator;
  BrownianChebyshev brownian_integrator;
  SegmentField correction; ///< of the last solve, at the segments
  std::unique_ptr<CorrectionUpdate> update;
  GrainSolution solution;
  Observer observer;
  LineWork work_since_balance;          ///< of steps whose correction was extrapolated
  double platen_work_since_balance = 0; ///< in these, MPa nm^3
  std::pair<double, double> last_load;  ///< load and motion of the platen when it moved last
  Loading loading;
  LoadWithinStep load_in_step; ///< of the present step
  EnergyBalance energy;
  std::vector<Vec3> forces_at_start; ///< of the lines in the last step, MPa nm^2, by NodeIndex::value
  NodalForces forces_at_end;         ///< likewise
  CandidateList candidates;
  SweptArea swept;
  TopologyCounts counts;
  SymTensor total_plastic_strain = SymTensor::Zero();
  double time = 0; ///< ns
  unsigned step_number = 0;
  Timing timing;
};

/// Lets SIGINT and SIGTERM end runs at the next step instead of killing the program.
void install_signal_handlers();
} // namespace ddfem::coupling
