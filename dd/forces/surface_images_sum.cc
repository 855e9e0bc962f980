// The images of many lines by fast multipoles, plane by plane.
#include "dd/fmm/multipole_images.h"
#include "dd/forces/surface_images.h"

#include <algorithm>
#include <iterator>

namespace ddfem
{
namespace
{
/// Sorts the images that have multipoles from the others.
struct AsSource
{
  double tolerance; ///< of quadratures
  std::vector<fmm::ImageSource> &sources;
  std::vector<unsigned> &others;
  unsigned number;

  void operator()(const SegmentImage &i) const { sources.emplace_back(i.loosened(tolerance)); }
  void operator()(const LegImage &i) const { sources.emplace_back(i); }
  void operator()(const PiercingImage &i) const { sources.emplace_back(i.loosened(tolerance)); }
  template <class Other> void operator()(const Other &) const { others.push_back(number); }
};

/// Calls add(first, n) for portions of so many points, by several threads.
template <class Add> void add_in_portions(const std::size_t n_points, Add &&add)
{
  constexpr std::size_t portion = 32;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t first = 0; first < n_points; first += portion)
    add(first, std::min(portion, n_points - first));
}

/// Of the quadratures of images whose far field has an error.
double quadrature_tolerance(const fmm::MultipoleSettings &settings)
{
  return 0.1 * settings.tolerance;
}
} // namespace

template <class Value, class SumPlane>
std::vector<Value> SurfaceImages::sum_planes(const std::span<const Vec3> points, const std::span<const int> faces,
                                             const double tolerance, SumPlane &&sum_plane) const
{
  std::vector<Value> values(points.size(), Value::Zero());
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end)
  {
    const std::size_t plane = pieces[begin].plane;
    std::vector<fmm::ImageSource> sources;
    std::vector<unsigned> others; // virtual rays that are not normal to their face: few
    for (; end < pieces.size() && pieces[end].plane == plane; ++end)
      std::visit(AsSource{tolerance, sources, others, static_cast<unsigned>(end)}, pieces[end].field);
    std::vector<std::size_t> numbers;
    std::vector<Vec3> some;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (faces.empty() || faces[k] != planes[plane].face_id)
      {
        numbers.push_back(k);
        some.push_back(points[k]);
      }
    const std::vector<Value> of_plane = sum_plane(planes[plane], sources, others, some);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      values[numbers[i]] += of_plane[i];
  }
  return values;
}

std::vector<Vec3> SurfaceImages::in_frame(const Frame &frame, const std::span<const Vec3> points)
{
  std::vector<Vec3> local;
  local.reserve(points.size());
  std::transform(points.begin(), points.end(), std::back_inserter(local),
                 [&](const Vec3 &x) { return frame.local(x); });
  return local;
}

std::vector<SymTensor> SurfaceImages::multipole_stress(const std::span<const Vec3> points,
                                                       const fmm::MultipoleSettings &settings, MPI_Comm comm,
                                                       const std::span<const int> faces) const
{
  return sum_planes<SymTensor>(
      points, faces, quadrature_tolerance(settings),
      [&](const Frame &frame, const std::vector<fmm::ImageSource> &sources, const std::vector<unsigned> &others,
          const std::span<const Vec3> some)
      {
        fmm::MultipoleImages sum(medium, fmm::MultipoleImages::Field::stress, settings, sources, in_frame(frame, some));
        std::vector<SymTensor> values = sum.stress(comm);
        for (SymTensor &s : values)
          s = frame.to_sample(s);
        add_in_portions(values.size(), [&](const std::size_t first, const std::size_t n)
                        { add_stress(others, some.subspan(first, n), std::span(values).subspan(first, n)); });
        return values;
      });
}

std::vector<Vec3> SurfaceImages::multipole_displacement(const std::span<const Vec3> points,
                                                        const fmm::MultipoleSettings &settings, MPI_Comm comm) const
{
  return sum_planes<Vec3>(
      points, {}, quadrature_tolerance(settings),
      [&](const Frame &frame, const std::vector<fmm::ImageSource> &sources, const std::vector<unsigned> &others,
          const std::span<const Vec3> some)
      {
        fmm::MultipoleImages sum(medium, fmm::MultipoleImages::Field::displacement, settings, sources,
                                 in_frame(frame, some));
        std::vector<Vec3> values = sum.displacement(comm);
        for (Vec3 &u : values)
          u = frame.to_local.transpose() * u;
        add_in_portions(values.size(), [&](const std::size_t first, const std::size_t n)
                        { add_displacement(others, some.subspan(first, n), std::span(values).subspan(first, n)); });
        return values;
      });
}
} // namespace ddfem
