// The tractions of the infinite field, with the images of the lines near flat faces, as the finite elements ask for them.
#pragma once

#include "dd/forces/line_system.h"
#include "dd/forces/surface_images.h"
#include "fem/traction_field.h"

namespace ddfem::coupling
{
/// Tractions of a snapshot of the lines and of their images, a sum of sources: lines, rays, images, and minus the legs that the
/// images leave on their face. On the face of an image the image and what it frees of tractions are left out: their sum is zero
/// there. The snapshots must outlive the object; its periodic images are not used.
class DislocationTractions final : public fem::TractionField
{
public:
  explicit DislocationTractions(const LineSystem &lines, const SurfaceImages *images = nullptr)
      : line_system(lines), surface_images(images)
  {
  }
  double smooth_length(const dealii::Point<3> &centre, double radius, dealii::types::boundary_id b) const override;
  void stress(const std::vector<dealii::Point<3>> &points, const std::vector<dealii::types::boundary_id> &boundaries,
              std::vector<dealii::SymmetricTensor<2, 3>> &values) const override;

private:
  std::size_t n_sources() const;
  bool vanishes_on(std::size_t source, dealii::types::boundary_id boundary) const;
  double distance(std::size_t source, const Vec3 &x) const;
  SymTensor stress_of(std::size_t source, const Vec3 &x) const;
  const LineSystem &line_system;
  const SurfaceImages *surface_images;
};
} // namespace ddfem::coupling
