#include "coupling/parameters.h"

#include "coupling/input_error.h"
#include "coupling/microstructure_input.h"
#include "coupling/mobility_input.h"
#include "coupling/thermal_input.h"
#include "dd/common/units.h"
#include "dd/crystal/material.h"

#include <filesystem>
#include <numbers>

namespace ddfem::coupling
{
namespace
{
SymTensor to_tensor(const std::vector<double> &v)
{
  return SymTensor(v.data());
}

/// The number in the deck, or @p fallback where it is zero.
double number_or(const InputDeck &deck, const std::string &path, const double unit, const double fallback)
{
  const double value = deck.number(path);
  return value > 0 ? value * unit : fallback;
}

void read_material(const InputDeck &deck, Parameters &p)
{
  const Material *material = nullptr;
  try
  {
    material = &find_material(deck.text("Material/Name"));
  }
  catch (const std::invalid_argument &e)
  {
    deck.reject("Material/Name", e.what());
  }
  p.lattice = material->lattice;
  p.medium.mu = number_or(deck, "Material/Shear modulus", units::pascal, material->mu);
  p.medium.nu = number_or(deck, "Material/Poisson ratio", 1, material->nu);
  p.lattice_parameter = number_or(deck, "Material/Lattice parameter", units::metre, material->lattice_parameter);
  p.burgers_magnitude = burgers_magnitude(p.lattice, p.lattice_parameter);
  p.medium.a = number_or(deck, "Material/Core radius", units::metre, p.burgers_magnitude);
  p.core_cutoff_radius = number_or(deck, "Material/Core cutoff radius", units::metre, p.medium.a);
  p.pair_tolerance = deck.number("Forces/Pair tolerance");
  const std::string summation = deck.text("Forces/Summation");
  p.grain.summation.method = summation == "direct"      ? SummationMethod::direct
                             : summation == "multipole" ? SummationMethod::multipole
                                                        : SummationMethod::automatic;
  p.grain.summation.tolerance = deck.number("Forces/Far-field tolerance");
  const std::string refresh = deck.text("Forces/Far-field refresh");
  p.far_field.mode = refresh == "every evaluation" ? FarFieldRefresh::every_evaluation
                     : refresh == "every n steps"  ? FarFieldRefresh::every_n_steps
                     : refresh == "never"          ? FarFieldRefresh::never
                                                   : FarFieldRefresh::adaptive;
  p.far_field.interval = deck.integer("Forces/Far-field interval");
}

/// The cell of the named material, with c/a of the input if given.
UnitCell read_cell(const InputDeck &deck, const Lattice lattice)
{
  const std::string path = "Crystal/c over a";
  const double given = deck.number(path);
  if (lattice != Lattice::hcp)
  {
    if (given != 0)
      deck.reject(path,
                  std::string("this ") + name_of(lattice) + " crystal is cubic; only hcp crystals have a ratio c/a");
    return {};
  }
  try
  {
    return UnitCell::hexagonal(number_or(deck, path, 1, find_material(deck.text("Material/Name")).c_over_a.value()));
  }
  catch (const std::invalid_argument &e)
  {
    deck.reject(path, e.what());
  }
}

void read_crystal(const InputDeck &deck, Parameters &p)
{
  p.slip.bcc_123_planes = deck.flag("Crystal/Slip on 123 planes");
  if (p.slip.bcc_123_planes && p.lattice != Lattice::bcc)
    deck.reject("Crystal/Slip on 123 planes",
                std::string("allowed are bcc crystals; this one is ") + name_of(p.lattice));
  const auto direction = [&](const std::string &path)
  { return read_miller(deck, path, deck.text(path), IndicesOf::direction, p.lattice); };
  const Miller x = direction("Crystal/Direction along x"), z = direction("Crystal/Direction along z");
  const UnitCell cell = read_cell(deck, p.lattice);
  try
  {
    p.orientation = Orientation::from_axes(SampleAxis::x, x, SampleAxis::z, z, cell);
  }
  catch (const std::invalid_argument &e)
  {
    deck.reject("Crystal/Direction along x", e.what());
  }
}

void read_mesh(const InputDeck &deck, Parameters &p)
{
  auto &mesh = p.grain.mesh;
  const std::string shape = deck.text("Domain/Shape");
  mesh.shape = shape == "box"          ? fem::MeshParameters::Shape::box
               : shape == "cylinder"   ? fem::MeshParameters::Shape::cylinder
               : shape == "pillar"     ? fem::MeshParameters::Shape::pillar
               : shape == "cantilever" ? fem::MeshParameters::Shape::cantilever
                                       : fem::MeshParameters::Shape::gmsh;
  const Vec3 origin = to_vec3(deck.numbers("Domain/Origin", 3)) * units::metre;
  const Vec3 size = to_vec3(deck.numbers("Domain/Size", 3)) * units::metre;
  if ((size.array() <= 0).any())
    deck.reject("Domain/Size", "edge lengths must be positive");
  mesh.origin = {origin[0], origin[1], origin[2]};
  mesh.size = {size[0], size[1], size[2]};
  mesh.radius = deck.number("Domain/Radius") * units::metre;
  mesh.height = deck.number("Domain/Height") * units::metre;
  mesh.pillar = {mesh.radius,
                 mesh.height,
                 deck.number("Domain/Taper angle") * std::numbers::pi / 180,
                 deck.number("Domain/Fillet radius") * units::metre,
                 deck.number("Domain/Base width") * units::metre,
                 deck.number("Domain/Base height") * units::metre};
  const Vec3 block = to_vec3(deck.numbers("Domain/Root block", 3)) * units::metre;
  if ((block.array() <= 0).any())
    deck.reject("Domain/Root block", "edge lengths must be positive");
  mesh.block = {block[0], block[1], block[2]};
  const auto subdivisions = deck.numbers("Domain/Subdivisions", 3);
  for (std::size_t c = 0; c < 3; ++c)
    mesh.subdivisions[c] = static_cast<unsigned>(subdivisions[c]);
  mesh.refinements = deck.integer("Domain/Refinements");
  mesh.length_unit_nm = deck.number("Domain/Mesh unit") * units::metre;
  if (mesh.shape == fem::MeshParameters::Shape::gmsh)
  {
    if (deck.text("Domain/Mesh file").empty())
      deck.reject("Domain/Mesh file", "a grain of shape 'mesh' needs a file");
    mesh.file = (std::filesystem::path(deck.directory()) / deck.text("Domain/Mesh file")).string();
    if (!std::filesystem::is_regular_file(mesh.file))
      deck.reject("Domain/Mesh file", "there is no file " + mesh.file);
  }
  p.cell = {origin, size};
  if (p.mode != Mode::finite && mesh.shape != fem::MeshParameters::Shape::box)
    deck.reject("Domain/Shape", "a " + deck.text("Mode") + " body is a box");
}

void read_grain(const InputDeck &deck, Parameters &p)
{
  p.grain.elasticity.degree = deck.integer("Domain/Element degree");
  // The flat facets of linear elements lie inside a round side, on which lines end.
  if (p.grain.elasticity.degree == 1)
    p.grain.elasticity.outside_tolerance = 0.25;
  p.grain.elasticity.relative_tolerance = deck.number("Domain/Elastic tolerance");
  p.grain.elasticity.traction_tolerance = deck.number("Domain/Traction tolerance");
  const std::string solver = deck.text("Domain/Elastic solver");
  p.grain.elasticity.solver = solver == "automatic"   ? fem::Solver::automatic
                              : solver == "multigrid" ? fem::Solver::multigrid
                                                      : fem::Solver::direct;
  p.grain.correction_tolerance = deck.number("Domain/Correction tolerance");
  p.grain.image_depth = deck.number("Domain/Image depth");
  p.grain.fixed_face = deck.text("Boundary conditions/Fixed face");
  p.grain.platen_face = deck.text("Boundary conditions/Platen face");
  p.grain.clamped = deck.text("Boundary conditions/Platen contact") == "clamped";
  const std::string motion = deck.text("Boundary conditions/Platen motion");
  p.grain.platen_motion = motion == "axial"        ? PlatenMotion::axial
                          : motion == "transverse" ? PlatenMotion::transverse
                          : motion == "twist"      ? PlatenMotion::twist
                          : motion == "bending"    ? PlatenMotion::bending
                                                   : PlatenMotion::none;
  p.grain.across_axis = deck.text("Boundary conditions/Transverse axis")[0] - 'x';
  p.grain.impenetrable_faces = deck.items("Boundary conditions/Impenetrable faces");
  p.grain.reference = deck.text("Boundary conditions/Reference state") == "relaxed" ? ReferenceState::relaxed
                                                                                    : ReferenceState::perfect_crystal;
  p.grain.ray_direction =
      deck.text("Boundary conditions/Ray direction") == "normal" ? RayDirection::normal : RayDirection::radial;
}

/// The stages of Loading/Type; the simple types are lists of one.
std::vector<Stage> read_stages(const InputDeck &deck)
{
  const std::string type = deck.text("Loading/Type");
  const std::vector<std::string> items = deck.items("Loading/Stages");
  if (type != "stages" && !items.empty())
    deck.reject("Loading/Stages", "needs Loading/Type = stages; it is " + type);
  if (type == "strain rate")
    return {{.kind = StageKind::strain_rate, .rate = deck.number("Loading/Strain rate") * units::per_second}};
  if (type != "stages")
  {
    // A grain without load stays between its platens, a cell without load has no stress.
    if (deck.text("Mode") == "finite")
      return {{.kind = StageKind::hold}};
    return {{.kind = StageKind::constant_stress, .jumps = true}};
  }
  if (items.empty())
    deck.reject("Loading/Stages", "a loading by stages needs at least one");
  try
  {
    return parse_stages(items);
  }
  catch (const std::invalid_argument &e)
  {
    deck.reject("Loading/Stages", e.what());
  }
}

void check_loading(const InputDeck &deck, const Parameters &p)
{
  if (p.mode == Mode::finite && p.loading.type == LoadingType::tensor)
    deck.reject("Loading/Type", "a finite grain is loaded by 'strain rate', 'stages' or 'none'");
  if (p.mode == Mode::infinite)
    for (const Stage &s : p.loading.stages)
      if ((s.kind != StageKind::stress_rate && s.kind != StageKind::constant_stress) || s.end == StageEnd::strain)
        deck.reject("Loading/Type", "an infinite body has no strain to prescribe: it is loaded by 'stress', 'none', or "
                                    "stages of stress rate and constant stress that do not end at a strain");
  const PlatenMotion motion = p.grain.platen_motion;
  if (p.mode == Mode::finite && motion == PlatenMotion::none && deck.text("Loading/Type") != "none")
    deck.reject("Loading/Type", "a grain with Boundary conditions/Platen motion = none has no load: allowed is 'none'");
  if (p.loading.machine_stiffness > 0 &&
      (p.mode != Mode::finite || (motion != PlatenMotion::axial && motion != PlatenMotion::transverse)))
    deck.reject("Loading/Machine stiffness",
                "only a platen that pulls or pushes a finite grain has a machine behind it");
}

void read_loading(const InputDeck &deck, Parameters &p)
{
  p.loading.type = deck.text("Loading/Type") == "stress" ? LoadingType::tensor : LoadingType::stages;
  const Vec3 axis = to_vec3(deck.numbers("Loading/Axis", 3));
  if (axis.norm() == 0)
    deck.reject("Loading/Axis", "must not be zero");
  p.loading.axis = axis.normalized();
  p.loading.stages = read_stages(deck);
  p.loading.stage_tolerance = deck.number("Loading/Stage tolerance");
  p.loading.machine_stiffness = deck.number("Loading/Machine stiffness") * units::newton_per_metre;
  p.loading.stress = to_tensor(deck.numbers("Loading/Stress", 6)) * units::pascal;
  p.loading.stress_rate = to_tensor(deck.numbers("Loading/Stress rate", 6)) * units::pascal / units::second;
  check_loading(deck, p);
}

void read_discretisation(const InputDeck &deck, Parameters &p)
{
  auto &t = p.topology;
  t.min_segment = deck.number("Discretisation/Minimum segment") * units::metre;
  t.max_segment = deck.number("Discretisation/Maximum segment") * units::metre;
  t.collision_radius = number_or(deck, "Discretisation/Collision radius", units::metre, t.min_segment / 8);
  t.min_area =
      number_or(deck, "Discretisation/Minimum area", units::metre * units::metre, 0.01 * t.min_segment * t.min_segment);
  t.max_area =
      number_or(deck, "Discretisation/Maximum area", units::metre * units::metre, 0.2 * t.max_segment * t.max_segment);
  t.collisions = deck.text("Discretisation/Collision algorithm") == "continuous" ? CollisionAlgorithm::continuous
                                                                                 : CollisionAlgorithm::proximity;
  if (t.max_segment < 2 * t.min_segment)
    deck.reject("Discretisation/Maximum segment", "must be at least twice the minimum segment");
  if (t.min_segment < 2 * p.medium.a)
    deck.reject("Discretisation/Minimum segment", "must be at least two core radii");
  if (t.collision_radius > 0.5 * t.min_segment)
    deck.reject("Discretisation/Collision radius", "must not exceed half the minimum segment");
  if (p.mode == Mode::periodic && t.max_segment > p.cell.lengths.minCoeff() / 5)
    deck.reject("Discretisation/Maximum segment", "must not exceed a fifth of the shortest edge of the periodic cell");
}

void read_time_stepping(const InputDeck &deck, Parameters &p)
{
  const std::string method = deck.text("Time stepping/Integrator");
  for (std::size_t k = 0; k < n_integrators; ++k)
    if (method == name_of(static_cast<IntegratorKind>(k)))
      p.method = static_cast<IntegratorKind>(k);
  if (p.method == IntegratorKind::subcycling && p.velocities.method == VelocityMethod::consistent)
    deck.reject("Time stepping/Integrator",
                "subcycling moves single nodes: it needs Mobility/Velocities = local, or take another integrator");
  p.near_distance = number_or(deck, "Time stepping/Near distance", units::metre, 3 * p.topology.min_segment);
  auto &i = p.integrator;
  i.error_tolerance = number_or(deck, "Time stepping/Position tolerance", units::metre, p.topology.min_segment / 50);
  i.relative_tolerance = deck.number("Time stepping/Relative tolerance");
  i.max_displacement = number_or(deck, "Time stepping/Maximum displacement", units::metre, p.topology.min_segment / 2);
  i.max_step = deck.number("Time stepping/Maximum step") * units::second;
  i.initial_step = deck.number("Time stepping/Initial step") * units::second;
  i.max_stages = deck.integer("Time stepping/Maximum stages");
  i.max_deviation = p.topology.collision_radius;
  if (i.initial_step > i.max_step)
    deck.reject("Time stepping/Initial step", "must not exceed the maximum step");
  p.stop.final_time = deck.number("Time stepping/Final time") * units::second;
  p.stop.max_steps = deck.integer("Time stepping/Maximum steps");
  p.stop.final_strain = deck.number("Time stepping/Final strain");
  p.stop.final_plastic_strain = deck.number("Time stepping/Final plastic strain");
  p.stop.equilibrium_speed = deck.number("Time stepping/Equilibrium speed") * units::metre_per_second;
  p.output = {deck.integer("Output/History interval"), deck.integer("Output/Frame interval"),
              deck.flag("Output/Check network")};
}
} // namespace

Parameters interpret(const InputDeck &deck)
{
  Parameters p;
  const std::string mode = deck.text("Mode");
  p.mode = mode == "finite" ? Mode::finite : mode == "periodic" ? Mode::periodic : Mode::infinite;
  read_material(deck, p);
  read_crystal(deck, p);
  read_mobility(deck, p);
  read_thermal(deck, p);
  read_mesh(deck, p);
  read_grain(deck, p);
  read_loading(deck, p);
  read_discretisation(deck, p);
  read_microstructure(deck, p);
  read_time_stepping(deck, p);
  return p;
}
} // namespace ddfem::coupling
