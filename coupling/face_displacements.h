// Analytic displacement fields on the held faces, for their projection on the elements (fem::TraceProjection).
#pragma once

#include "coupling/dislocation_tractions.h"
#include "dd/elasticity/triangular_loop.h"
#include "dd/forces/multipole_field.h"
#include "dd/forces/surface_images.h"
#include "dd/geometry/ball_blocks.h"
#include "dd/geometry/facet_tree.h"
#include "dd/topology/swept_area.h"
#include "fem/traction_field.h"

#include <mpi.h>

#include <vector>

namespace ddfem::coupling
{
/// Triangles that lines have swept, the finite ones first: those can be summed by fast multipoles.
struct SweptLoops
{
  std::vector<TriangularLoop> loops;
  std::size_t n_finite = 0;

  explicit SweptLoops(const SweptArea &area);
  std::span<const TriangularLoop> finite() const { return std::span(loops).first(n_finite); }
  std::span<const TriangularLoop> open() const { return std::span(loops).subspan(n_finite); }
};

/// Where the displacement of swept area at @p x is taken, nm. Nodes of a mesh lie in glide planes and on the paths of surface nodes, where it has several
/// values. Rounding would choose among them for each triangle anew, and area that is swept forth and back would not cancel. This is a point
/// beside, in a direction that no plane of a lattice is likely to contain, farther than rounding of the nodes' positions reaches.
Vec3 beside(const Vec3 &x);

/// How the displacements of many loops are summed over the points of all ranks.
struct SweptSummation
{
  SummationSettings settings{SummationMethod::direct};
  MPI_Comm communicator = MPI_COMM_SELF;

  /// @p n_points: of all ranks.
  bool use_multipoles(const SweptLoops &swept, std::size_t n_points) const
  {
    return settings.use_multipoles(swept.n_finite, n_points);
  }
};

/// Displacement of the loops at points of this rank, nm. Collective.
std::vector<Vec3> swept_displacement(double nu, const SweptLoops &swept, std::span<const Vec3> points,
                                     const SweptSummation &summation);

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
  /// The displacement as such a stress, and back.
  dealii::SymmetricTensor<2, 3> as_stress(const Vec3 &u) const;
  Vec3 from_stress(const dealii::SymmetricTensor<2, 3> &s) const { return {s[axis][0], s[axis][1], s[axis][2]}; }

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
  SweptDisplacement(const SweptLoops &triangles, double poisson, int normal_axis, double reach, double smallest,
                    const SweptSummation &summation = {});

  unsigned n_sources() const override { return static_cast<unsigned>(swept.loops.size()); }
  std::optional<unsigned> n_summed(std::size_t n_points) const override
  {
    return summation.use_multipoles(swept, n_points) ? std::optional(static_cast<unsigned>(swept.n_finite))
                                                     : std::nullopt;
  }
  double summation_error() const override;
  std::vector<dealii::SymmetricTensor<2, 3>> sum(std::span<const dealii::Point<3>> points) const override;
  void append_near(const dealii::Point<3> &centre, double radius, double length,
                   std::vector<unsigned> &sources) const override;
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override;

protected:
  void add_displacement(std::span<const unsigned> sources, std::span<const Vec3> points,
                        std::span<Vec3> u) const override;

private:
  const SweptLoops &swept;
  double nu, resolution;
  SweptSummation summation;
  BallBlocks balls; ///< around the finite triangles, unless sums are direct
  std::vector<std::vector<TriangleCorners>>
      extents; ///< finite triangles that cover each of them: one, or two for a strip
};

/// Displacement of the images of lines, each of them a source, not resolved below a given length either. Many are summed by fast
/// multipoles.
class ImageDisplacement final : public FaceDisplacement
{
public:
  /// @p images must outlive the object; @p smallest: this length, nm.
  ImageDisplacement(const SurfaceImages &surface_images, int normal_axis, double smallest,
                    const SummationSettings &how = {SummationMethod::direct});
  unsigned n_sources() const override { return static_cast<unsigned>(images.n_images()); }
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override;
  std::optional<unsigned> n_summed(std::size_t n_points) const override
  {
    return use_multipoles_for_images(summation, n_sources(), n_points) ? std::optional(0U) : std::nullopt;
  }
  double summation_error() const override { return tolerance_of_tractions(summation); }
  std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> complete_sum(
      std::span<const fem::BoundaryPoints> boundaries) const override;
  void append_near(const dealii::Point<3> &centre, double radius, double length,
                   std::vector<unsigned> &sources) const override;
  /// Of all images at points of this rank, nm.
  std::vector<Vec3> at(std::span<const Vec3> points) const;

protected:
  void add_displacement(std::span<const unsigned> sources, std::span<const Vec3> points,
                        std::span<Vec3> u) const override
  {
    images.add_displacement(sources, points, u);
  }

private:
  const SurfaceImages &images;
  double resolution;
  SummationSettings summation;
  BallBlocks balls; ///< around the images, unless sums are direct
};
} // namespace ddfem::coupling
