#include "coupling/finite_grain.h"

#include "coupling/convert.h"
#include "coupling/dislocation_tractions.h"
#include "coupling/face_displacements.h"
#include "coupling/grain_geometry.h"
#include "coupling/input_error.h"
#include "dd/topology/growth.h"
#include "fem/face_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ddfem::coupling
{
namespace
{
using FaceNames = std::map<dealii::types::boundary_id, std::string>;

dealii::types::boundary_id find_face(const FaceNames &names, const std::string &name, const std::string &entry)
{
  try
  {
    return fem::boundary_id_of(names, name);
  }
  catch (const std::invalid_argument &e)
  {
    throw InputError("Boundary conditions/" + entry + " = " + name + ": " + e.what());
  }
}

/// The plane that a face lies in, if it is perpendicular to a coordinate axis.
struct AxisPlane
{
  int axis;
  double position, sign; ///< coordinate (nm), and side of the grain it is on
};

AxisPlane plane_of_face(const std::vector<PolyhedronShape::Facet> &facets, const int id, const std::string &name)
{
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low, centre = Vec3::Zero();
  double n_all = 0;
  for (const auto &f : facets)
    for (const Vec3 &v : f.vertices)
    {
      centre += v;
      ++n_all;
      if (f.face_id == id)
      {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
      }
    }
  for (int c = 0; c < 3; ++c)
    if (high[c] - low[c] < 1e-6 * (high - low).norm())
      return {c, low[c], low[c] > centre[c] / n_all ? 1.0 : -1.0};
  throw InputError("Boundary conditions: the face '" + name + "' is not a plane perpendicular to x, y or z");
}
} // namespace

std::pair<double, double> imbalance(const fem::TractionSummary &t, const double force_scale, const double length_scale)
{
  constexpr double rounding = 1e-6;
  return {t.force.norm() / std::max(t.absolute_force, rounding * force_scale),
          t.moment.norm() / std::max(t.absolute_moment, rounding * force_scale * length_scale)};
}

FiniteGrain::FiniteGrain(const GrainParameters &grain_parameters, const IsotropicMedium &elastic_medium, MPI_Comm comm)
    : parameters(grain_parameters), medium(elastic_medium), communicator(comm)
{
  try
  {
    mesh = fem::make_mesh(communicator, parameters.mesh);
    face_names = fem::boundary_names(parameters.mesh);
    build_shape(parameters);
  }
  catch (const std::invalid_argument &e)
  {
    throw InputError(std::string("Domain: ") + e.what());
  }
  catch (const std::runtime_error &e)
  {
    throw InputError(std::string("Domain: ") + e.what());
  }
  find_platens(parameters);
  const bool clamped = parameters.clamped;
  problem = std::make_unique<fem::ElasticProblem>(
      *mesh, parameters.elasticity, fem::Moduli{medium.mu, medium.nu},
      std::vector<fem::DisplacementCondition>{{fixed_face, platen_motion->held_by_fixed_face(clamped)},
                                              {platen_face, platen_motion->held_by_platen(clamped)}});
  reference_correction.resize(problem->boundary_points().size());
  infinite_displacement.resize(problem->boundary_points().size());
  image_displacement.resize(problem->boundary_points().size());
  set_unit_response();
}

void FiniteGrain::set_unit_response()
{
  pattern.assign(problem->boundary_points().size(), {});
  for (std::size_t i = 0; i < pattern.size(); ++i)
  {
    const auto &ids = problem->boundary_ids()[i];
    if (std::find(ids.begin(), ids.end(), platen_face) != ids.end())
      pattern[i] = to_tensor(platen_motion->displacement(to_vec3(problem->boundary_points()[i])));
  }
  problem->solve(pattern);
  unit_response = problem->solution();
  unit_stress = problem->recovered_stress();
  load_per_motion = platen_load();
  modulus = load_per_motion * platen_motion->stress_per_load() / platen_motion->strain_per_motion();
  problem->set_start_vectors({}); // of no use for the field of the dislocations
}

/// Load that does work on the motion of the platen: the reactions are zero on what is not held.
double FiniteGrain::platen_load() const
{
  const auto reactions = problem->boundary_reactions();
  double load = 0;
  for (std::size_t i = 0; i < pattern.size(); ++i)
    load += reactions[i] * pattern[i];
  MPI_Allreduce(MPI_IN_PLACE, &load, 1, MPI_DOUBLE, MPI_SUM, communicator);
  return load;
}

FiniteGrain::~FiniteGrain() = default;

double FiniteGrain::volume() const
{
  return problem->volume();
}

std::uint64_t FiniteGrain::n_dofs() const
{
  return problem->n_dofs();
}

void FiniteGrain::build_shape(const GrainParameters &p)
{
  grain_shape = make_grain_shape(p.mesh, *mesh);
  for (const std::string &name : p.impenetrable_faces)
    grain_shape->set_face_kind(static_cast<int>(find_face(face_names, name, "Impenetrable faces")),
                               FaceKind::impenetrable);
}

void FiniteGrain::find_platens(const GrainParameters &p)
{
  const auto [usual_fixed, usual_platen] = usual_held_faces(p.mesh.shape);
  const auto name_or = [](const std::string &given, const std::string &usual, const std::string &entry)
  {
    if (given.empty() && usual.empty())
      throw InputError("Boundary conditions/" + entry + " = (empty): a mesh needs the name of a physical surface");
    return given.empty() ? usual : given;
  };
  const std::string fixed = name_or(p.fixed_face, usual_fixed, "Fixed face");
  const std::string platen = name_or(p.platen_face, usual_platen, "Platen face");
  fixed_face = find_face(face_names, fixed, "Fixed face");
  platen_face = find_face(face_names, platen, "Platen face");
  const auto facets = boundary_polygons(*mesh);
  const AxisPlane low = plane_of_face(facets, static_cast<int>(fixed_face), fixed);
  const AxisPlane high = plane_of_face(facets, static_cast<int>(platen_face), platen);
  if (low.axis != high.axis || low.sign == high.sign)
    throw InputError("Boundary conditions: the faces '" + fixed + "' and '" + platen + "' are not opposite each other");
  axis = high.axis;
  platen_sign = high.sign;
  gauge_length = std::abs(high.position - low.position);
  describe_platen(facets);
  find_image_planes(facets);
}

void FiniteGrain::describe_platen(const std::vector<PolyhedronShape::Facet> &facets)
{
  const unsigned degree = parameters.elasticity.degree;
  const fem::FaceSection section = fem::face_section(*mesh, platen_face, degree);
  platen_area = section.area;
  const auto n_elements =
      std::count_if(facets.begin(), facets.end(),
                    [&](const PolyhedronShape::Facet &f) { return f.face_id == static_cast<int>(platen_face); });
  face_resolution = 0.05 * std::sqrt(platen_area / static_cast<double>(n_elements));
  fixed_centre = to_vec3(fem::face_section(*mesh, fixed_face, degree).centre);
  double reach = 0;
  for (const auto &f : facets)
    for (const Vec3 &v : f.vertices)
      if (f.face_id == static_cast<int>(platen_face))
      {
        const Vec3 arm = v - to_vec3(section.centre);
        reach =
            std::max(reach, parameters.platen_motion == PlatenMotion::bending ? std::abs(arm[parameters.across_axis])
                                                                              : arm.norm());
      }
  try
  {
    platen_motion = std::make_unique<Platen>(parameters.platen_motion, axis, platen_sign, parameters.across_axis,
                                             section, gauge_length, reach);
  }
  catch (const std::invalid_argument &e)
  {
    throw InputError("Boundary conditions/Transverse axis = " + std::string(1, "xyz"[parameters.across_axis]) + ": " +
                     e.what());
  }
}

std::vector<dealii::Tensor<1, 3>> FiniteGrain::prescribed_at_rest() const
{
  std::vector<dealii::Tensor<1, 3>> values = reference_correction;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] -= infinite_displacement[i] + image_displacement[i];
  return values;
}

void FiniteGrain::set_reference(const Network &network, const LineSystem &lines)
{
  std::fill(infinite_displacement.begin(), infinite_displacement.end(), dealii::Tensor<1, 3>());
  std::fill(reference_correction.begin(), reference_correction.end(), dealii::Tensor<1, 3>());
  if (parameters.reference == ReferenceState::relaxed)
    relax(lines);
  else
    add_swept(grown_area(network, grain_shape.get(), parameters.ray_direction));
}

void FiniteGrain::relax(const LineSystem &lines)
{
  fem::ElasticProblem free_grain(*mesh, parameters.elasticity, fem::Moduli{medium.mu, medium.nu}, {});
  update_images(lines);
  free_grain.set_tractions(DislocationTractions(lines, &images, parameters.summation, communicator));
  free_grain.solve(std::vector<dealii::Tensor<1, 3>>(free_grain.boundary_points().size()));
  reference_correction = free_grain.boundary_displacements();
  for (std::size_t i = 0; i < reference_correction.size(); ++i)
    reference_correction[i] += image_displacement[i];
}

void FiniteGrain::add_swept(const SweptArea &area)
{
  const SweptLoops loops(area);
  const SweptSummation summation{parameters.summation, communicator};
  std::vector<dealii::Tensor<1, 3>> u;
  for (const Vec3 &value : swept_displacement(medium.nu, loops, boundary_nodes(), summation))
    u.push_back(to_tensor(value));
  const double reach = 1e3 * grain_shape->diameter();
  project_where_held(SweptDisplacement(loops, medium.nu, axis, reach, face_resolution, summation), u);
  for (std::size_t i = 0; i < u.size(); ++i)
    infinite_displacement[i] += u[i];
}

/// Replaces the prescribed components of @p u by the best approximation of the field on the held faces. Values at the nodes would
/// miss what a line nearer than an element does between them, and with it the mean, which is what the platen force is made of.
void FiniteGrain::project_where_held(const FaceDisplacement &field, std::vector<dealii::Tensor<1, 3>> &u) const
{
  const auto projected = problem->project_on_conditions(field);
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    const auto &ids = problem->boundary_ids()[i];
    const bool on_platen = std::find(ids.begin(), ids.end(), platen_face) != ids.end();
    for (unsigned c = 0; c < 3; ++c)
      if (problem->prescribed_components()[i][c])
        u[i][c] = (on_platen ? platen_sign : -platen_sign) * projected[i][c];
  }
}

GrainSolution FiniteGrain::solve_at_rest(const LineSystem &lines)
{
  GrainSolution solution;
  update_images(lines);
  solution.tractions = problem->set_tractions(DislocationTractions(lines, &images, parameters.summation, communicator));
  const double diameter = grain_shape->diameter();
  std::tie(solution.force_imbalance, solution.moment_imbalance) =
      imbalance(solution.tractions, medium.mu * medium.a * diameter, diameter);
  solution.solve = problem->solve(prescribed_at_rest());
  at_rest = problem->solution();
  solution.load_at_rest = platen_load();
  return solution;
}

void FiniteGrain::move_platen(GrainSolution &solution, const double q)
{
  std::vector<double> values = at_rest;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += q * unit_response[i];
  problem->set_solution(values);
  solution.motion = q;
  solution.load = solution.load_at_rest + q * load_per_motion;
  solution.platen_force = to_vec3(problem->reaction(platen_face));
  solution.fixed_force = to_vec3(problem->reaction(fixed_face));
  solution.platen_moment = to_vec3(problem->reaction_moment(platen_face, to_point(platen_motion->centre())));
  solution.fixed_moment = to_vec3(problem->reaction_moment(fixed_face, to_point(fixed_centre)));
  solution.platen_reaction = platen_sign * solution.platen_force[axis];
  solution.fixed_reaction = -platen_sign * solution.fixed_force[axis];
}

GrainSolution FiniteGrain::solve(const LineSystem &lines, const double q)
{
  GrainSolution solution = solve_at_rest(lines);
  move_platen(solution, q);
  return solution;
}

BoundaryState FiniteGrain::boundary_state() const
{
  std::vector<dealii::Tensor<1, 3>> analytic = infinite_displacement;
  for (std::size_t i = 0; i < analytic.size(); ++i)
    analytic[i] += image_displacement[i];
  return {problem->boundary_loads(), problem->boundary_reactions(), problem->boundary_displacements(), analytic};
}

std::vector<SymTensor> FiniteGrain::stress_of_elements(const std::vector<Vec3> &points) const
{
  std::vector<SymTensor> result;
  result.reserve(points.size());
  for (const auto &s : problem->stress_at(to_points(points)))
    result.push_back(to_sym_tensor(s));
  return result;
}

std::vector<SymTensor> FiniteGrain::correction_stress(const std::vector<Vec3> &points) const
{
  std::vector<SymTensor> stress = stress_of_elements(points);
  add_images(points, stress);
  return stress;
}

std::vector<Vec3> FiniteGrain::boundary_nodes() const
{
  return to_vectors(problem->boundary_points());
}

std::vector<Vec3> FiniteGrain::boundary_displacement() const
{
  std::vector<Vec3> u;
  const auto correction = problem->boundary_displacements();
  for (std::size_t i = 0; i < correction.size(); ++i)
    u.push_back(to_vec3(correction[i] + image_displacement[i] + infinite_displacement[i]));
  return u;
}

std::string FiniteGrain::write(const std::string &directory, const std::string &name) const
{
  // Displacements are counted from the reference state, like the prescribed ones.
  std::vector<dealii::Tensor<1, 3>> extra = image_displacement;
  for (std::size_t i = 0; i < extra.size(); ++i)
    extra[i] += infinite_displacement[i] - reference_correction[i];
  return problem->write_surface(directory, name, extra);
}
} // namespace ddfem::coupling
