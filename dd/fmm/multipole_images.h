// Images of many dislocation lines under a free surface by a fast multipole method.
#pragma once

#include "dd/elasticity/line_table.h"
#include "dd/fmm/image_expansion.h"
#include "dd/fmm/multipole_sum.h"

#include <span>
#include <vector>

namespace ddfem::fmm
{
/// Stress or displacement of images under the surface z = 0 at points with z >= 0: near pairs of boxes by the closed forms
/// (half_space_image.h), distant pairs by four harmonic potentials (image_expansion.h). The pieces of a line and their legs must close, as
/// SurfaceImages sees to: here the stress of the mirror image of a segment comes with that of legs at both ends, which cancel in the sum. The tolerance
/// is relative to the rms of the far field.
class MultipoleImages final : public MultipoleSum
{
public:
  enum class Field : std::uint8_t
  {
    stress,
    displacement
  };

  MultipoleImages(const IsotropicMedium &medium, Field field, const MultipoleSettings &settings,
                  std::span<const ImageSource> images, std::span<const Vec3> points);

  /// At the points in the order given, MPa; for Field::stress. Collective: see compute().
  std::vector<SymTensor> stress(MPI_Comm comm, Part part = Part::all);
  /// nm; for Field::displacement.
  std::vector<Vec3> displacement(MPI_Comm comm, Part part = Part::all);

private:
  /// The end of a mirrored leg with the Burgers vector that flows into it.
  struct LegEnd
  {
    std::uint32_t node;
    Vec3 burgers;
  };

  MultipoleImages(const IsotropicMedium &medium, Field field, const MultipoleSettings &settings,
                  std::span<const ImageSource> images, std::span<const SourceExtent> extents,
                  std::span<const Vec3> points);
  void find_nodes();
  void add_own_moments(const Box &box, const ExpansionView &moments) const override;
  void add_far(const Box &leaf, const Row *fields, const double *q) override;
  void add_near(std::size_t leaf) override;
  void add_near_stress(std::span<const std::uint32_t> near, const StressBatch &batch) const;

  IsotropicMedium medium;
  Field field;
  std::vector<ImageSource> sources;           ///< in the tree's order
  std::vector<std::array<LegEnd, 2>> ends_of; ///< of each of them; two for segments
  std::vector<Vec3> nodes;                    ///< where mirrored legs begin, nm
};
} // namespace ddfem::fmm
