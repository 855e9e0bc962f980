// Analytic images of the lines in the finite grain.
#include "coupling/convert.h"
#include "coupling/finite_grain.h"
#include "coupling/image_planes.h"

#include <algorithm>
#include <set>

namespace ddfem::coupling
{
void FiniteGrain::find_image_planes(const std::vector<PolyhedronShape::Facet> &facets)
{
  const auto is_held = [](const std::array<bool, 3> &components)
  { return components[0] || components[1] || components[2]; };
  std::set<int> held;
  if (is_held(platen_motion->held_by_fixed_face(parameters.clamped)))
    held.insert(static_cast<int>(fixed_face));
  if (is_held(platen_motion->held_by_platen(parameters.clamped)))
    held.insert(static_cast<int>(platen_face));
  planes_of_images = image_planes(facets, held);
  image_settings.depth = parameters.image_depth * facet_size(facets, planes_of_images);
}

void FiniteGrain::update_images(const LineSystem &lines)
{
  images = SurfaceImages(lines, planes_of_images, image_settings);
  const ImageDisplacement field(images, axis, face_resolution, parameters.summation);
  const std::vector<Vec3> u = field.at(boundary_nodes());
  std::transform(u.begin(), u.end(), image_displacement.begin(), to_tensor);
  project_where_held(field, image_displacement);
}

void FiniteGrain::add_images(const std::vector<Vec3> &points, std::vector<SymTensor> &stress) const
{
  if (images.empty())
    return;
  const std::vector<SymTensor> of_images = stress_of_images(images, points, parameters.summation, communicator);
  for (std::size_t k = 0; k < points.size(); ++k)
    stress[k] += of_images[k];
}

SegmentField FiniteGrain::correction_at_segments(const Network &network) const
{
  SegmentPoints::SmoothLength smooth_length;
  if (image_settings.depth > 0)
    smooth_length = smooth_length_under(planes_of_images, image_settings.depth, medium.a);
  SegmentField field{SegmentPoints(network, smooth_length), {}, {}};
  field.without_images = stress_of_elements(field.points.positions());
  field.stress = field.without_images;
  add_images(field.points.positions(), field.stress);
  return field;
}
} // namespace ddfem::coupling
