// The finite grain: superposition of the infinite-body field of the dislocations and the FEM correction.
#pragma once

#include "coupling/parameters.h"
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
/// What one solve of the boundary-value problem tells.
struct GrainSolution
{
  fem::TractionSummary tractions;                   ///< of the infinite field over the closed surface: must balance
  double force_imbalance = 0, moment_imbalance = 0; ///< see imbalance()
  fem::SolveInfo solve;
  double fixed_reaction =
      0; ///< force on the grain along the outward normal of the fixed face, MPa nm^2; tension positive
  double platen_reaction = 0; ///< the same at the platen
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
  /// Nominal stress per nominal strain of the grain under its own boundary conditions (one solve without dislocations), MPa.
  double unit_load_modulus() const { return modulus; }

  /// Takes the state of the network as the one that prescribed displacements are counted from: relaxed
  /// with all surfaces traction-free, or grown from nothing in a perfect crystal.
  void set_reference(const Network &network, const LineSystem &lines);
  /// Adds the displacement of the swept triangles to u~ at all boundary nodes.
  void add_swept(const SweptArea &area);
  /// Solves for the correction at platen displacement @p u (nm, along the outward normal of the platen).
  GrainSolution solve(const LineSystem &lines, double u);
  /// Correction stress at points inside the grain, MPa: finite elements and images of the last solve; the same bits on all
  /// ranks.
  std::vector<SymTensor> correction_stress(const std::vector<Vec3> &points) const;
  /// The same at the segments of a network, at points that are dense enough for the images near the surface.
  SegmentField correction_at_segments(const Network &network) const;
  /// u~ + u^ at the boundary nodes of this rank since the reference state, and these nodes, nm.
  std::vector<Vec3> boundary_displacement() const;
  std::vector<Vec3> boundary_nodes() const;
  /// Writes the deformed surface; returns the file written.
  std::string write(const std::string &directory, const std::string &name) const;

private:
  void find_platens(const GrainParameters &parameters);
  void build_shape(const GrainParameters &parameters);
  void relax(const LineSystem &lines);
  void find_image_planes();
  void update_images(const LineSystem &lines);
  std::vector<dealii::Tensor<1, 3>> image_displacement() const;
  std::vector<dealii::Tensor<1, 3>> prescribed(double u) const;

  GrainParameters parameters;
  IsotropicMedium medium;
  MPI_Comm communicator;
  fem::TriangulationPointer mesh;
  std::map<dealii::types::boundary_id, std::string> face_names;
  dealii::types::boundary_id fixed_face = 0, platen_face = 0;
  int axis = 2;             ///< loading axis
  double platen_sign = 1.0; ///< outward normal of the platen along the axis
  double gauge_length = 0, platen_area = 0, modulus = 0;
  std::unique_ptr<GrainShape> grain_shape;
  std::unique_ptr<fem::ElasticProblem> problem;
  std::vector<ImagePlane> planes_of_images;
  ImageSettings image_settings;
  SurfaceImages images;                                    ///< of the lines of the last solve
  std::vector<dealii::Tensor<1, 3>> reference_correction;  ///< u^(0), images included, at the boundary nodes
  std::vector<dealii::Tensor<1, 3>> infinite_displacement; ///< u~ since the reference, at the boundary nodes
};

/// Largest acceptable ratio of the net force (moment) of the infinite field's tractions to the integral of their magnitudes.
inline constexpr double max_imbalance = 1e-4;
/// The two ratios, force and moment. @p force_scale (MPa nm^2) and @p length_scale (nm): magnitudes below a millionth of them are
/// rounding, such as the field of a line on top of its own negative.
std::pair<double, double> imbalance(const fem::TractionSummary &t, double force_scale, double length_scale);
} // namespace ddfem::coupling
