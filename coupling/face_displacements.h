// Analytic displacement fields on the held faces, for their projection on the elements (fem::TraceProjection).
#pragma once

#include "dd/elasticity/triangular_loop.h"
#include "dd/forces/surface_images.h"
#include "dd/geometry/facet_tree.h"
#include "fem/traction_field.h"

#include <vector>

namespace ddfem::coupling
{
/// Presents a displacement (nm) as the traction on faces perpendicular to a coordinate axis: a "stress" whose product with the unit
/// vector of the axis is the displacement. On a face whose outward normal points against the axis the traction has the other sign.
class FaceDisplacement : public fem::TractionField
{
public:
  explicit FaceDisplacement(const int normal_axis) : axis(static_cast<unsigned>(normal_axis)) {}

  void add_stress(std::span<const unsigned> sources, std::span<const dealii::Point<3>> points,
                  std::span<dealii::SymmetricTensor<2, 3>> values) const final;

protected:
  /// Adds the displacement of @p sources at @p points to @p u, nm.
  virtual void add_displacement(std::span<const unsigned> sources, std::span<const Vec3> points,
                                std::span<Vec3> u) const = 0;

private:
  unsigned axis;
};

/// u~ of swept triangles, each of them a source. Its field is analytic up to the distance of the triangle, but jumps across it:
/// a triangle that cuts a face would be divided without end, and is not resolved below a given length.
class SweptDisplacement final : public FaceDisplacement
{
public:
  /// @p triangles must outlive the object. @p poisson: Poisson's ratio. @p reach: where triangles that go to infinity end as far as
  /// distances are concerned, much farther than the grain, nm. @p smallest: this length, nm.
  SweptDisplacement(const std::vector<TriangularLoop> &triangles, double poisson, int normal_axis, double reach,
                    double smallest);

  unsigned n_sources() const override { return static_cast<unsigned>(swept.size()); }
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override;

protected:
  void add_displacement(std::span<const unsigned> sources, std::span<const Vec3> points,
                        std::span<Vec3> u) const override;

private:
  const std::vector<TriangularLoop> &swept;
  double nu, resolution;
  std::vector<std::vector<TriangleCorners>>
      extents; ///< finite triangles that cover each of them: one, or two for a strip
};

/// Displacement of the images of lines, each of them a source, not resolved below a given length either.
class ImageDisplacement final : public FaceDisplacement
{
public:
  /// @p images must outlive the object; @p smallest: this length, nm.
  ImageDisplacement(const SurfaceImages &surface_images, const int normal_axis, const double smallest)
      : FaceDisplacement(normal_axis), images(surface_images), resolution(smallest)
  {
  }
  unsigned n_sources() const override { return static_cast<unsigned>(images.n_images()); }
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override;

protected:
  void add_displacement(std::span<const unsigned> sources, std::span<const Vec3> points,
                        std::span<Vec3> u) const override
  {
    images.add_displacement(sources, points, u);
  }

private:
  const SurfaceImages &images;
  double resolution;
};
} // namespace ddfem::coupling
