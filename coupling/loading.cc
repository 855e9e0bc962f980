#include "coupling/loading.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace ddfem::coupling
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Part of a stage that rounding may leave over where the end is known beforehand.
constexpr double rounding = 1e-10;
} // namespace

void Loading::start(const double time, const BodyResponse &response)
{
  stage_number = 0;
  drive_start = drive_rate = last_rate = 0;
  modulus = response.modulus;
  // Before the first stage the drive is at rest at zero.
  const double k = settings.machine_stiffness;
  const double strain = rigid() || modulus == 0 ? 0.0 : -response.stress_at_rest / (modulus + k);
  present = {time, strain, response.stress_at_rest + modulus * strain};
  begin_stage();
  solve(time, response);
}

void Loading::next_stage(const BodyResponse &response)
{
  ++stage_number;
  begin_stage();
  solve(present.time, response);
}

void Loading::update(const double time, const BodyResponse &response)
{
  const LoadState before = present;
  solve(time, response);
  if (time > before.time && current().end != StageEnd::none)
    last_rate = (end_quantity(present) - end_quantity(before)) / (time - before.time);
}

void Loading::begin_stage()
{
  stage_start = present;
  last_rate = 0;
  drive_start = present.strain + (rigid() ? 0.0 : present.stress / settings.machine_stiffness);
  const Stage &s = current();
  const double way = s.end_value - end_quantity(present);
  drive_rate = 0;
  if (s.kind == StageKind::strain_rate)
    drive_rate = s.rate;
  if (s.kind == StageKind::unload)
    drive_rate = std::copysign(s.rate, way);
  if (end_is_prescribed() && s.end != StageEnd::duration && way != 0 && !(way * prescribed_rate() > 0))
    throw std::runtime_error("Loading/Stages: stage " + std::to_string(stage_number + 1) + " (" + name_of(s.kind) +
                             ") does not lead from the " + name_of(s.end) + " reached to that of its end");
}

bool Loading::stress_prescribed() const
{
  return current().kind == StageKind::stress_rate || current().kind == StageKind::constant_stress;
}

void Loading::solve(const double time, const BodyResponse &response)
{
  modulus = response.modulus;
  present = state_at(time, response);
}

LoadState Loading::state_at(const double time, const BodyResponse &response) const
{
  LoadState state{time, 0, 0};
  const Stage &s = current();
  if (response.modulus == 0)
    return state;
  if (stress_prescribed())
  {
    state.stress = s.jumps ? s.stress : stage_start.stress;
    if (s.kind == StageKind::stress_rate)
      state.stress += s.rate * (time - stage_start.time);
    state.strain = (state.stress - response.stress_at_rest) / response.modulus;
    return state;
  }
  const double drive = drive_start + drive_rate * (time - stage_start.time);
  const double k = settings.machine_stiffness;
  state.strain = rigid() ? drive : (k * drive - response.stress_at_rest) / (k + response.modulus);
  state.stress = response.stress_at_rest + response.modulus * state.strain;
  return state;
}

double Loading::plastic_strain_of(const LoadState &s) const
{
  return modulus == 0 ? 0.0 : s.strain - s.stress / modulus;
}

double Loading::end_quantity(const LoadState &s) const
{
  switch (current().end)
  {
    case StageEnd::duration: return s.time - stage_start.time;
    case StageEnd::strain: return s.strain;
    case StageEnd::stress: return s.stress;
    case StageEnd::plastic_strain: return plastic_strain_of(s);
    case StageEnd::none: break;
  }
  return 0;
}

double Loading::prescribed_rate() const
{
  switch (current().end)
  {
    case StageEnd::duration: return 1;
    case StageEnd::strain: return drive_rate;
    case StageEnd::stress: return current().rate;
    default: return 0;
  }
}

bool Loading::end_is_prescribed() const
{
  const StageEnd end = current().end;
  return end == StageEnd::duration || (end == StageEnd::strain && !stress_prescribed() && rigid()) ||
         (end == StageEnd::stress && current().kind == StageKind::stress_rate);
}

bool Loading::ended() const
{
  const Stage &s = current();
  if (s.end == StageEnd::none)
    return false;
  const double way = s.end_value - end_quantity(stage_start), left = s.end_value - end_quantity(present);
  const double tolerance = end_is_prescribed() ? rounding : settings.tolerance;
  return way == 0 || left / way <= tolerance;
}

double Loading::time_left() const
{
  const Stage &s = current();
  if (s.end == StageEnd::none || ended())
    return infinity;
  const double way = std::abs(s.end_value - end_quantity(stage_start));
  const double left = std::abs(s.end_value - end_quantity(present));
  if (end_is_prescribed())
    return left / std::abs(prescribed_rate());
  // Largest rate without plastic flow; plastic flow is seen one step late.
  const double k = settings.machine_stiffness;
  double elastic = 0;
  if (s.end == StageEnd::stress)
    elastic = std::abs(drive_rate) * (rigid() ? modulus : modulus * k / (modulus + k));
  if (s.end == StageEnd::strain)
    elastic = stress_prescribed() ? (s.kind == StageKind::stress_rate ? std::abs(s.rate) / modulus : 0.0)
                                  : std::abs(drive_rate) * k / (modulus + k);
  double dt = elastic > 0 ? left / elastic : infinity;
  if (last_rate != 0)
    dt = std::min(dt, std::max(left / 2, settings.tolerance * way) / std::abs(last_rate));
  return dt;
}

double Loading::time_to_strain(const double magnitude) const
{
  if (stress_prescribed() || !rigid() || drive_rate == 0)
    return infinity;
  return (std::copysign(magnitude, drive_rate) - present.strain) / drive_rate;
}
} // namespace ddfem::coupling
