// The infinite-body stress of the dislocations as the load of the correction problem.
#pragma once

#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/forces/line_system.h"
#include "dd/forces/multipole_field.h"
#include "dd/forces/surface_images.h"
#include "dd/geometry/ball_blocks.h"
#include "fem/traction_field.h"

#include <mpi.h>

#include <vector>

namespace ddfem::coupling
{
/// Error of the sums for the boundary-value problem, relative to the rms of the far field: a tenth of that of the forces, since
/// errors of the tractions do not balance.
constexpr double tolerance_of_tractions(const SummationSettings &s)
{
  return 0.1 * s.tolerance;
}

/// Whether the fields of many images are summed by fast multipoles. The closed form of an image costs as much as that of some eight segments.
inline bool use_multipoles_for_images(const SummationSettings &s, std::size_t n_images, std::size_t n_points)
{
  return s.use_multipoles(8 * n_images, n_points);
}

/// Stress of the images at points, MPa. Collective: every rank has all points and gets all values.
std::vector<SymTensor> stress_of_images(const SurfaceImages &images, std::span<const Vec3> points,
                                        const SummationSettings &summation, MPI_Comm comm);

/// Presents a LineSystem and the images of its lines to the FEM. Sources are the lines, the rays, the legs and rests of lines that the
/// images leave on their faces, the images. On the face of an image the image and the lines and rays that it frees of tractions are left out:
/// their sum is zero there. The stress of the non-singular theory is analytic up to the distance sqrt(d^2 + a^2) in the complex
/// plane, d being the distance to the line (or mirror image): that is its smooth length. Many lines, their rays and their images
/// are summed by fast multipoles.
class DislocationTractions final : public fem::TractionField
{
public:
  /// @p lines, without periodic images, and @p images (of the same lines; null: none) must outlive the object.
  explicit DislocationTractions(const LineSystem &lines, const SurfaceImages *images = nullptr,
                                const SummationSettings &summation = {SummationMethod::direct},
                                MPI_Comm comm = MPI_COMM_SELF);

  unsigned n_sources() const override;
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override;
  void add_stress(std::span<const unsigned> sources, std::span<const dealii::Point<3>> points,
                  std::span<dealii::SymmetricTensor<2, 3>> values) const override;
  bool vanishes_on(unsigned source, dealii::types::boundary_id boundary) const override;
  std::optional<unsigned> n_summed(std::size_t n_points) const override;
  double summation_error() const override { return tolerance_of_tractions(summation); }
  std::vector<dealii::SymmetricTensor<2, 3>> sum(std::span<const dealii::Point<3>> points) const override;
  std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> complete_sum(
      std::span<const fem::BoundaryPoints> boundaries) const override;
  void append_near(const dealii::Point<3> &centre, double radius, double length,
                   std::vector<unsigned> &sources) const override;

private:
  std::size_t n_lines() const { return line_system.lines().size(); }
  double distance(unsigned source, const Vec3 &x) const;
  /// Takes the stress of some lines and rays from `values`.
  void subtract(std::span<const unsigned> sources, std::span<const dealii::Point<3>> points,
                const fmm::MultipoleSettings &settings, std::span<dealii::SymmetricTensor<2, 3>> values) const;
  /// Of some lines by fast multipoles, at points of this rank, MPa.
  std::vector<SymTensor> stress_of_lines(std::span<const unsigned> numbers, std::span<const Vec3> points,
                                         const fmm::MultipoleSettings &settings) const;
  std::size_t first_rest() const { return n_lines() + rays.size(); }
  std::size_t first_image() const { return first_rest() + rests.size(); }
  bool is_rest(unsigned source) const { return source >= first_rest() && source < first_image(); }
  bool is_image(unsigned source) const { return source >= first_image(); }
  std::size_t image_number(unsigned source) const { return source - first_image(); }

  const LineSystem &line_system;
  const SurfaceImages *images;
  SummationSettings summation;
  MPI_Comm communicator;
  BallBlocks balls, rest_balls, image_balls; ///< around the lines, rests and images, unless sums are direct
  std::vector<VirtualRay> ray_list;          ///< rays of the lines, then legs
  LineTable rays;                            ///< the same
  LineTable rests;                           ///< of lines with fading images
};
} // namespace ddfem::coupling
