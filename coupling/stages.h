// A loading history as a list of stages.
#pragma once

#include <string>
#include <vector>

namespace ddfem::coupling
{
/// What is prescribed during a stage. Strain and stress are nominal, along the loading (see Loading).
enum class StageKind
{
  strain_rate,     ///< rate of the nominal strain (of the machine, if it is not rigid)
  stress_rate,     ///< rate of the nominal stress
  constant_stress, ///< the stress reached, or a given one that is jumped to: creep; zero: no load
  hold,            ///< the displacement reached
  unload           ///< strain rate towards the stress that ends the stage
};

/// What ends a stage; time counts from the start of the stage, everything else from the start of the run.
enum class StageEnd
{
  none,
  duration,
  strain,
  stress,
  plastic_strain ///< strain minus stress / modulus
};

struct Stage
{
  StageKind kind = StageKind::hold;
  double rate = 0; ///< 1/ns; MPa/ns for stress_rate; magnitude for unload
  bool jumps = false;
  double stress = 0; ///< of a constant stress that is jumped to, MPa
  StageEnd end = StageEnd::none;
  double end_value = 0; ///< ns, MPa or 1
};

/// Reads stages of the form 'KIND [NUMBER] [until END NUMBER]', SI units. KIND: 'strain rate R', 'stress rate R', 'constant
/// stress [S]', 'free', 'hold', 'unload R'; END: 'duration', 'strain', 'stress', 'plastic strain'. Only the last stage may lack
/// an end. Throws std::invalid_argument with one line for anything else, and for an end that the kind cannot reach.
std::vector<Stage> parse_stages(const std::vector<std::string> &items);

/// "strain rate", "plastic strain", ...
std::string name_of(StageKind kind);
std::string name_of(StageEnd end);
} // namespace ddfem::coupling
