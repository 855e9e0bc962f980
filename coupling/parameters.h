// The input in internal units (nm, ns, MPa), checked as a whole.
#pragma once

#include "coupling/parameter_table.h"
#include "coupling/platen.h"
#include "coupling/stages.h"
#include "dd/crystal/orientation.h"
#include "dd/crystal/slip_systems.h"
#include "dd/elasticity/isotropic.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/nodal_forces.h"
#include "dd/geometry/periodic_cell.h"
#include "dd/integrators/make_integrator.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/velocity_solver.h"
#include "dd/topology/cross_slip.h"
#include "dd/topology/topology_context.h"
#include "fem/elastic_problem.h"
#include "fem/mesh.h"

#include <string>
#include <vector>

namespace ddfem::coupling
{
enum class Mode
{
  finite,
  periodic,
  infinite
};

enum class ReferenceState
{
  relaxed,
  perfect_crystal
};

/// Finite grain: mesh, held faces, surfaces.
struct GrainParameters
{
  fem::MeshParameters mesh;
  fem::ElasticProblem::Parameters elasticity;
  std::string fixed_face, platen_face; ///< names; empty: the lowest and highest along z
  bool clamped = true;
  PlatenMotion platen_motion = PlatenMotion::axial;
  int across_axis = 0; ///< see Platen
  std::vector<std::string> impenetrable_faces;
  ReferenceState reference = ReferenceState::relaxed;
  RayDirection ray_direction = RayDirection::normal;
  double correction_tolerance = 0; ///< see CorrectionUpdate
  SummationSettings summation;     ///< of fields and forces
  double image_depth = 4;          ///< lines nearer than this many elements to a flat free face get analytic images
};

enum class LoadingType
{
  stages, ///< along the axis
  tensor  ///< a stress tensor and its rate; periodic and infinite only
};

struct LoadingParameters
{
  LoadingType type = LoadingType::stages;
  Vec3 axis = Vec3::UnitZ();
  std::vector<Stage> stages;
  double stage_tolerance = 1e-3;
  double machine_stiffness = 0;              ///< MPa nm; 0: rigid
  SymTensor stress = SymTensor::Zero();      ///< MPa
  SymTensor stress_rate = SymTensor::Zero(); ///< MPa/ns
};

struct ThermalParameters
{
  double temperature = 300; ///< K
  bool motion = false;      ///< Langevin forces on the lines
  std::uint64_t seed = 1;   ///< of all random numbers of the run
};

struct StopCriteria
{
  double final_time = 0; ///< ns
  unsigned max_steps = 0;
  double final_strain = 0; ///< 0: not used, as below
  double final_plastic_strain = 0;
  double equilibrium_speed = 0; ///< nm/ns
};

struct OutputParameters
{
  unsigned history_interval = 1;
  unsigned frame_interval = 50;
  bool check_network = true;
};

struct Parameters
{
  Mode mode = Mode::finite;
  IsotropicMedium medium;
  Lattice lattice = Lattice::fcc;
  double burgers_magnitude = 0; ///< of the principal slip, nm
  double lattice_parameter = 0; ///< nm
  SlipSystemOptions slip;
  Orientation orientation; ///< with the unit cell, that is c/a
  MobilityPointer mobility;
  VelocitySettings velocities;
  ThermalParameters thermal;
  CrossSlipSettings cross_slip;
  GrainParameters grain;
  PeriodicCell cell; ///< of the periodic mode; its volume is the reference volume of the infinite mode
  LoadingParameters loading;
  std::vector<FrankReadSource> sources;
  std::vector<PolygonLoop> loops;
  std::string network_file;    ///< absolute; empty: none
  bool cut_at_surface = false; ///< what the initial lines reach out of the grain
  TopologySettings topology;
  double core_cutoff_radius = 0; ///< nm
  double pair_tolerance = 0;
  RefreshSettings far_field;
  IntegratorKind method = IntegratorKind::stabilised;
  IntegratorSettings integrator;
  double near_distance = 0; ///< of segments whose forces subcycling integrates with shorter steps, nm
  StopCriteria stop;
  OutputParameters output;

  ForceSettings force_settings() const
  {
    return {medium, core_cutoff_radius, pair_tolerance, grain.ray_direction, grain.summation};
  }
  SlipSystems slip_systems() const { return {lattice, lattice_parameter, orientation, slip}; }
};

/// Turns the deck into parameters. Throws InputError for entries that contradict each other or make no sense.
Parameters interpret(const InputDeck &deck);
} // namespace ddfem::coupling
