// Analytic images of the lines near flat free faces of the grain.
//
// Finite elements cannot resolve the correction field within about three elements of the surface. There, the exact
// image field of each segment under the plane of a near face is added to the infinite-body field, and with it the
// superposition carries no traction on that face any more: what is left for the finite elements is smooth.
//
// A plane must have the whole grain on one side, so that the mirror images lie outside. Where a line leaves the range of
// the images (at `depth`, or through another face) the flux of its Burgers vector is closed by a leg into the depth
// (half_space_image.h), whose image is added too, so that the sum of the images is in equilibrium in the whole grain. The
// tractions of these legs remain on the face, with opposite sign.
//
// Within the last quarter of the range images fade out: a segment that comes from the depth gets its image little by little, since what the
// finite elements solve for should change as smoothly from step to step as the lines move.
#pragma once

#include "dd/elasticity/half_space_image.h"
#include "dd/fmm/multipole_sum.h"
#include "dd/forces/line_system.h"
#include "dd/geometry/ball_blocks.h"

#include <mpi.h>

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace ddfem
{
/// Plane of a flat traction-free face.
struct ImagePlane
{
  int face_id;
  Vec3 point;   ///< on the plane, nm
  Vec3 outward; ///< unit normal; the grain lies on the other side
};

struct ImageSettings
{
  /// Segments with an end nearer to a plane than this have an image, nm; 0: no images. Lines outside have none. From three quarters of it
  /// on images are those of a part of the Burgers vector.
  double depth = 0;
  double tolerance = 1e-6; ///< relative error of the image of a segment; balance and reactions are as good as this
};

/// Image fields of one state of the lines. Adding them to the infinite field of the same lines leaves, on each plane,
/// only the tractions of segments without an image, of the rest of segments with a fading one, and of minus the legs.
class SurfaceImages
{
public:
  SurfaceImages() = default;
  SurfaceImages(const LineSystem &lines, std::span<const ImagePlane> planes, const ImageSettings &settings);

  /// Stress at a point of the grain, MPa.
  SymTensor stress(const Vec3 &x) const;
  /// The same at many points, threaded; independent of the number of threads.
  std::vector<SymTensor> stress(std::span<const Vec3> points) const;
  /// Displacement at points of the grain, nm, single-valued; up to a rigid translation where lines pierce a face.
  std::vector<Vec3> displacement(std::span<const Vec3> points) const;

  /// stress(points) by fast multipoles, with a relative error of @p settings. @p faces: of the points, unless empty; a point gets no images under the
  /// plane of its own face. Collective: every rank of @p comm has all points and gets all values.
  std::vector<SymTensor> multipole_stress(std::span<const Vec3> points, const fmm::MultipoleSettings &settings,
                                          MPI_Comm comm, std::span<const int> faces = {}) const;
  /// displacement(points) likewise.
  std::vector<Vec3> multipole_displacement(std::span<const Vec3> points, const fmm::MultipoleSettings &settings,
                                           MPI_Comm comm) const;

  bool empty() const { return pieces.empty(); }

  /// Whether the images cancel the tractions of a line (ray), numbered as in LineSystem, on a face, but for those of fading_lines().
  bool is_freed_of_line(std::size_t line, int face_id) const { return is_freed(planes_of_line, line, face_id); }
  bool is_freed_of_ray(std::size_t ray, int face_id) const { return is_freed(planes_of_ray, ray, face_id); }

  std::size_t n_images() const { return pieces.size(); }
  int face_of_image(std::size_t image) const { return planes[pieces[image].plane].face_id; }
  /// Stress of some of the images, in ascending order, MPa.
  SymTensor stress(std::span<const unsigned> images, const Vec3 &x) const;
  /// Adds the same at many points to @p values, in one thread.
  void add_stress(std::span<const unsigned> images, std::span<const Vec3> points, std::span<SymTensor> values) const;
  /// Adds the displacement of some of the images, in ascending order, at points, nm, in one thread.
  void add_displacement(std::span<const unsigned> images, std::span<const Vec3> points, std::span<Vec3> values) const;
  /// Around the singularities of each image that are nearest to the grain.
  std::vector<Ball> bounding_balls() const;
  /// Lower bound of the distance of a point of the grain from the singularities of one image, nm.
  double image_distance(std::size_t image, const Vec3 &x) const;

  /// Legs whose tractions remain, with the sign with which they do: rays with the face that they act on.
  struct RemainingLeg
  {
    VirtualRay ray;
    int face_id;
  };
  const std::vector<RemainingLeg> &remaining_legs() const { return legs; }

  /// What fading images leave of the tractions of their lines, by the rest of the Burgers vector.
  struct FadingLine
  {
    StraightLine line;
    int face_id;
  };
  const std::vector<FadingLine> &fading_lines() const { return fading; }

private:
  /// Local frame of a plane: z into the grain, origin on the plane.
  struct Frame
  {
    int face_id;
    Vec3 point, outward;
    Mat3 to_local;
    /// Negative z: outside.
    Vec3 unlimited(const Vec3 &x) const { return to_local * (x - point); }
    /// Rounding must not put a point of the surface outside.
    Vec3 local(const Vec3 &x) const
    {
      Vec3 y = unlimited(x);
      y[2] = y[2] < 0 ? 0 : y[2];
      return y;
    }
    SymTensor to_sample(const SymTensor &s) const
    {
      return symmetric_part(to_local.transpose() * to_matrix(s) * to_local);
    }
  };
  /// What turns a virtual ray into the one along the normal, which PiercingImage supposes.
  struct RayTurn
  {
    IsotropicMedium medium;
    Vec3 origin, direction, burgers; ///< of the virtual ray
    SymTensor stress(const Vec3 &x) const;
    void add_stress(const StressBatch &batch) const;
    void add_displacement(const DisplacementBatch &batch) const;
    double distance(const Vec3 &x) const;
  };
  struct Piece
  {
    std::size_t plane;
    std::variant<SegmentImage, LegImage, PiercingImage, RayTurn> field;
  };
  using PlaneSet = std::uint64_t; // one bit for each plane

  class NodeFluxes;
  template <typename PieceNumber> SymTensor sum_of_pieces(std::size_t n, PieceNumber &&number, const Vec3 &x) const;
  /// Calls @p visit(plane, pieces) for each plane with the numbers of its pieces among number(0) ... number(n - 1).
  template <typename PieceNumber, typename Visit>
  void for_each_plane(std::size_t n, PieceNumber &&number, Visit &&visit) const;
  template <typename PieceNumber>
  void add_stress_of(std::size_t n, PieceNumber &&number, std::span<const Vec3> points,
                     std::span<SymTensor> values) const;
  template <typename PieceNumber>
  void add_displacement_of(std::size_t n, PieceNumber &&number, std::span<const Vec3> points,
                           std::span<Vec3> values) const;
  template <typename Buffer> static Buffer local_points(const Frame &frame, std::span<const Vec3> points);
  template <class Value, class SumPlane>
  std::vector<Value> sum_planes(std::span<const Vec3> points, std::span<const int> faces, double tolerance,
                                SumPlane &&sum_plane) const;
  static std::vector<Vec3> in_frame(const Frame &frame, std::span<const Vec3> points);
  void add_plane(const LineSystem &lines, std::size_t plane, const ImageSettings &settings);
  void add_lines(const LineSystem &lines, std::size_t plane, const ImageSettings &settings, NodeFluxes &fluxes);
  void add_rays(const LineSystem &lines, std::size_t plane, const ImageSettings &settings, NodeFluxes &fluxes);
  void add_legs(const LineSystem &lines, std::size_t plane, const ImageSettings &settings, const NodeFluxes &fluxes);
  bool is_freed(const std::vector<PlaneSet> &sets, std::size_t i, int face_id) const;

  IsotropicMedium medium{};
  std::vector<Frame> planes;
  std::vector<Piece> pieces; // sorted by plane
  std::vector<RemainingLeg> legs;
  std::vector<FadingLine> fading;
  std::vector<PlaneSet> planes_of_line, planes_of_ray;
};
} // namespace ddfem
