// The finite grain: superposition of the infinite-body field of the dislocations and the FEM correction.
#pragma once

#include "coupling/face_displacements.h"
#include "coupling/load_within_step.h"
#include "coupling/parameters.h"
#include "coupling/platen.h"
#include "dd/forces/line_system.h"
#include "dd/forces/segment_points.h"
#include "dd/forces/surface_images.h"
#include "dd/geometry/grain_shape.h"
#include "dd/topology/swept_area.h"
#include "fem/elastic_problem.h"
#include "fem/mesh.h"

#include <mpi.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace ddfem::coupling
{
/// What one solve of the boundary-value problem tells. Forces MPa nm^2 and moments MPa nm^3 act on the grain.
struct GrainSolution
{
  fem::TractionSummary tractions;                   ///< of the infinite field over the closed surface: must balance
  double force_imbalance = 0, moment_imbalance = 0; ///< see imbalance()
  fem::SolveInfo solve;
  bool solved = true;         ///< false: extrapolated, with tractions and balance of the last solve
  double load_at_rest = 0;    ///< Q of the dislocations with the platen at rest, see PlatenMotion
  double motion = 0;          ///< q of the platen
  double load = 0;            ///< Q = load_at_rest + q times the response to unit motion
  double fixed_reaction = 0;  ///< force along the outward normal of the fixed face, tension positive
  double platen_reaction = 0; ///< the same at the platen
  Vec3 platen_force = Vec3::Zero(), platen_moment = Vec3::Zero(); ///< moments about the centre of the platen face
  Vec3 fixed_force = Vec3::Zero(), fixed_moment = Vec3::Zero();   ///< moments about the centre of the fixed face
};

/// Vectors over the boundary nodes of this rank that the energies of the grain are made of.
struct BoundaryState
{
  std::vector<dealii::Tensor<1, 3>> load;       ///< f = -int N (sigma~ n) dS, images included, MPa nm^2
  std::vector<dealii::Tensor<1, 3>> reaction;   ///< of the held faces, total field, MPa nm^2
  std::vector<dealii::Tensor<1, 3>> correction; ///< u^, nm
  std::vector<dealii::Tensor<1, 3>> infinite;   ///< u~ since the reference, and images, nm
};

/// Mesh, boundary conditions and correction field of a finite grain. Collective over the communicator. Loading axis: the
/// outward normal of the platen face (x, y or z).
class FiniteGrain
{
public:
  /// Throws InputError for faces that do not exist or are not opposite each other along an axis.
  FiniteGrain(const GrainParameters &parameters, const IsotropicMedium &medium, MPI_Comm communicator);
  ~FiniteGrain();

  const GrainShape &shape() const { return *grain_shape; }
  Vec3 loading_axis() const { return Vec3::Unit(axis); }
  double height() const { return gauge_length; } ///< between the faces, nm
  double section() const { return platen_area; } ///< area of the platen face, nm^2
  double volume() const;                         ///< of the mesh, nm^3
  std::uint64_t n_dofs() const;
  /// Nominal stress per nominal strain (see Platen) of the grain under its own boundary conditions (one solve without
  /// dislocations), MPa; zero for a grain that is not held.
  double unit_load_modulus() const { return modulus; }
  /// Stress of a unit of nominal stress at the segments of the network. As the work of the stress of unit motion on swept area is minus the
  /// change of the load at rest, the nominal stress falls by load_per_motion stress_per_load^2 times the work of the unit field. Collective.
  UnitLoad unit_load(const Network &network) const;

  /// Takes the state of the network as the one that prescribed displacements are counted from: relaxed
  /// with all surfaces traction-free, or grown from nothing in a perfect crystal.
  void set_reference(const Network &network, const LineSystem &lines);
  /// Adds the displacement of the swept triangles to u~ at all boundary nodes; where it is prescribed, its best approximation on
  /// the face.
  void add_swept(const SweptArea &area);
  const Platen &platen() const { return *platen_motion; }
  /// Solves for the correction with the platen at rest.
  GrainSolution solve_at_rest(const LineSystem &lines);
  /// Moves the platen to q: adds the response to unit motion to the solution at rest, without a solve.
  void move_platen(GrainSolution &solution, double q);
  /// Both: the correction at the platen motion @p q.
  GrainSolution solve(const LineSystem &lines, double q);
  BoundaryState boundary_state() const;

  /// What the finite elements know of a solve at rest: unknowns and load, locally owned.
  struct ElementState
  {
    std::vector<double> unknowns, load;
  };
  ElementState element_state() const;
  /// Takes @p state instead of solving, with the images of @p lines, and adds as much of the response to unit motion as
  /// gives the load at rest @p load_at_rest (MPa nm^2, see PlatenMotion). Completes @p solution, that of the last solve.
  void extrapolate_to(const LineSystem &lines, const ElementState &state, double load_at_rest, GrainSolution &solution);
  /// Change of the load at rest by what lines have swept, exact but for the elements (Betti): minus the work of the stress of unit
  /// motion. Collective.
  double load_of_swept_area(const SweptArea &area) const;
  /// Depth (nm) of a point under the surface as far as the finite elements see it: under faces with images it is the depth of the
  /// images, or the distance from a held face if that is less.
  double depth_for_elements(const Vec3 &x) const;
  double element_size() const; ///< edge of the cube of the mean volume of the elements, nm
  const std::vector<ImagePlane> &planes_with_images() const { return planes_of_images; }
  double depth_of_images() const { return planes_of_images.empty() ? 0.0 : image_settings.depth; } ///< nm
  MPI_Comm mpi_communicator() const { return communicator; }
  /// Correction stress at points inside the grain, MPa: finite elements and images of the last solve; the same bits on all
  /// ranks.
  std::vector<SymTensor> correction_stress(const std::vector<Vec3> &points) const;
  /// The part of the finite elements in it.
  std::vector<SymTensor> stress_of_elements(const std::vector<Vec3> &points) const;
  /// All of it at the segments of a network, at points that are dense enough for the images near the surface.
  SegmentField correction_at_segments(const Network &network) const;
  /// u~ + u^ at the boundary nodes of this rank since the reference state, and these nodes, nm.
  std::vector<Vec3> boundary_displacement() const;
  std::vector<Vec3> boundary_nodes() const;
  /// Writes the deformed surface; returns the file written.
  std::string write(const std::string &directory, const std::string &name) const;

private:
  void find_platens(const GrainParameters &parameters);
  void build_shape(const GrainParameters &parameters);
  void describe_platen(const std::vector<PolyhedronShape::Facet> &facets);
  void relax(const LineSystem &lines);
  void set_unit_response();
  std::vector<dealii::Tensor<1, 3>> prescribed_at_rest() const;
  void project_where_held(const FaceDisplacement &field, std::vector<dealii::Tensor<1, 3>> &u) const;
  double platen_load() const;
  void find_image_planes(const std::vector<PolyhedronShape::Facet> &facets);
  void update_images(const LineSystem &lines);
  void add_images(const std::vector<Vec3> &points, std::vector<SymTensor> &stress) const;

  GrainParameters parameters;
  IsotropicMedium medium;
  MPI_Comm communicator;
  fem::TriangulationPointer mesh;
  std::map<dealii::types::boundary_id, std::string> face_names;
  dealii::types::boundary_id fixed_face = 0, platen_face = 0;
  int axis = 2;             ///< loading axis
  double platen_sign = 1.0; ///< outward normal of the platen along the axis
  double gauge_length = 0, platen_area = 0, modulus = 0;
  double face_resolution =
      0; ///< of displacements on the held faces: a twentieth of the mean edge of their elements, nm
  std::unique_ptr<GrainShape> grain_shape;
  std::unique_ptr<Platen> platen_motion;
  Vec3 fixed_centre = Vec3::Zero();
  std::unique_ptr<fem::ElasticProblem> problem;
  std::vector<dealii::Tensor<1, 3>> pattern; ///< displacement at the boundary nodes for q = 1, zero off the platen
  std::vector<double> unit_response,
      at_rest;                     ///< unknowns of this rank: of q = 1 without dislocations; of the last solve at rest
  std::vector<double> unit_stress; ///< recovered, of q = 1
  double load_per_motion = 0;      ///< Q per q
  std::vector<ImagePlane> planes_of_images;
  ImageSettings image_settings;
  SurfaceImages images;                                    ///< of the lines of the last solve
  std::vector<dealii::Tensor<1, 3>> image_displacement;    ///< of these, at the boundary nodes, nm
  std::vector<dealii::Tensor<1, 3>> reference_correction;  ///< u^(0), images included, at the boundary nodes
  std::vector<dealii::Tensor<1, 3>> infinite_displacement; ///< u~ since the reference, at the boundary nodes
};

/// Largest acceptable ratio of the net force (moment) of the infinite field's tractions to the integral of their magnitudes.
inline constexpr double max_imbalance = 1e-4;
/// The two ratios, force and moment. @p force_scale (MPa nm^2) and @p length_scale (nm): magnitudes below a millionth of them are
/// rounding, such as the field of a line on top of its own negative.
std::pair<double, double> imbalance(const fem::TractionSummary &t, double force_scale, double length_scale);
} // namespace ddfem::coupling
