// From a list of stages to the strain and stress at every time.
#pragma once

#include "coupling/stages.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace ddfem::coupling
{
/// How a body answers to the loading in nominal quantities, linear at a given state of the lines:
///   stress = stress_at_rest + modulus strain.
/// A finite grain: reaction of the platen at rest and response to its unit displacement. A periodic cell: stress_at_rest = - E
/// times the axial plastic strain, modulus = E.
struct BodyResponse
{
  double stress_at_rest = 0; ///< MPa
  double modulus = 0;        ///< MPa; zero: nothing is prescribed, strain and stress stay zero
};

/// Nominal strain and stress (MPa) at a time (ns).
struct LoadState
{
  double time = 0, strain = 0, stress = 0;
};

/// Plays the stages. Displacement control, force control and a machine of finite stiffness are one scalar equation with the
/// response of the body:
///   strain prescribed:  k (e - strain) = stress,  e the strain of the machine's drive, k its stiffness in series (k -> inf: strain = e);
///   stress prescribed:  stress_at_rest + modulus strain = stress.
/// The drive starts every stage where it balances the state reached: nothing jumps unless a stage says so.
class Loading
{
public:
  struct Settings
  {
    std::vector<Stage> stages;
    /// Of the machine, nominal: force per section over displacement per height, MPa.
    double machine_stiffness = std::numeric_limits<double>::infinity();
    /// Ends that are not known beforehand are met to this fraction of the way of the stage.
    double tolerance = 1e-3;
  };

  Loading() = default; ///< at zero stress and strain until start()
  explicit Loading(Settings loading_settings) : settings(std::move(loading_settings)) {}

  /// Begins the first stage with the drive at zero.
  void start(double time, const BodyResponse &response);
  /// The equilibrium of the present stage at @p time. Throws std::runtime_error for a stage that cannot end.
  void update(double time, const BodyResponse &response);
  /// Whether the present stage is over, and another one follows.
  bool stage_over() const { return ended() && stage_number + 1 < settings.stages.size(); }
  /// Begins the next stage at the same time; returns after its equilibrium is found (the stress may jump).
  void next_stage(const BodyResponse &response);
  /// Whether the last stage is over.
  bool finished() const { return ended() && stage_number + 1 >= settings.stages.size(); }

  const LoadState &state() const { return present; }
  /// The equilibrium of the present stage at @p time with another response, without any change of state.
  LoadState state_at(double time, const BodyResponse &response) const;
  std::size_t stage() const { return stage_number; } ///< from 0
  double elastic_strain() const { return modulus == 0 ? 0.0 : present.stress / modulus; }
  double plastic_strain() const { return plastic_strain_of(present); }
  /// Longest step (ns) that does not pass the end of the stage: exact where the end is a time, or a value that is prescribed;
  /// otherwise an estimate from the elastic response and from the last step, of which half the remaining way is used.
  double time_left() const;
  /// Time (ns) until the magnitude of the strain reaches @p magnitude, if the strain is prescribed; infinity otherwise.
  double time_to_strain(double magnitude) const;

private:
  const Stage &current() const { return settings.stages[stage_number]; }
  void begin_stage();
  void solve(double time, const BodyResponse &response);
  bool rigid() const { return settings.machine_stiffness == std::numeric_limits<double>::infinity(); }
  bool stress_prescribed() const;
  bool ended() const;
  double plastic_strain_of(const LoadState &s) const;
  double end_quantity(const LoadState &s) const;
  double prescribed_rate() const;
  bool end_is_prescribed() const;

  Settings settings;
  std::size_t stage_number = 0;
  double modulus = 0;
  LoadState present, stage_start;
  double drive_start = 0, drive_rate = 0; ///< strain of the machine's drive at the start of the stage; its rate, 1/ns
  double last_rate = 0;                   ///< of end_quantity() in the last step, 1/ns
};
} // namespace ddfem::coupling
