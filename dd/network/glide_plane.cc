#include "dd/network/glide_plane.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace ddfem
{
namespace
{
/// Index of the first component that decides the sign of a plane: the first non-zero Miller index.
int leading_sign(const std::array<int, 3> &miller)
{
  for (const int h : miller)
    if (h != 0)
      return h > 0 ? 1 : -1;
  return 0;
}

std::array<int, 3> reduced(const std::array<int, 3> &miller)
{
  const int divisor = std::gcd(std::gcd(miller[0], miller[1]), miller[2]);
  if (divisor == 0)
    return miller;
  const int factor = leading_sign(miller) * divisor;
  return {miller[0] / factor, miller[1] / factor, miller[2] / factor};
}

bool is_crystallographic(const std::array<int, 3> &miller)
{
  return leading_sign(miller) != 0;
}

std::string name_of_plane(const std::array<int, 3> &miller)
{
  return "(" + std::to_string(miller[0]) + " " + std::to_string(miller[1]) + " " + std::to_string(miller[2]) + ")";
}

std::int64_t quantised(double value, double quantum)
{
  return std::llround(value / quantum);
}

/// Offsets beyond this (nm) would overflow the 64-bit key; 1e12 nm is a kilometre.
constexpr double largest_offset = 1e12;

/// How exact the normal of a caller must be: its length, and its direction where the Miller indices are known already.
constexpr double input_tolerance = 1e-6;

/// Planes that enclose less than this (rad) are parallel as far as their intersection is concerned.
constexpr double parallel_tolerance = 1e-6;

constexpr std::int64_t normal_kind = 1; // tells the two kinds of keys of a family apart
constexpr std::int64_t miller_kind = 0;

void require_unit(const Vec3 &normal)
{
  if (!(std::abs(normal.norm() - 1) <= input_tolerance))
    throw std::invalid_argument("A glide plane needs a unit normal; the length of the one given is " +
                                std::to_string(normal.norm()) + ".");
}
} // namespace

std::size_t GlidePlanes::KeyHash::operator()(const Key &key) const
{
  std::uint64_t h = 0x9e3779b97f4a7c15U;
  for (const std::int64_t k : key)
  {
    h ^= static_cast<std::uint64_t>(k);
    h *= 0xbf58476d1ce4e5b9U;
    h ^= h >> 29;
  }
  return h;
}

std::optional<GlidePlanes::FamilyMatch> GlidePlanes::find_family(const std::array<int, 3> &miller,
                                                                 const Vec3 &normal) const
{
  if (is_crystallographic(miller))
  {
    const auto found = family_by_key_.find({miller_kind, miller[0], miller[1], miller[2]});
    if (found == family_by_key_.end())
      return {};
    return FamilyMatch{found->second, normal.dot(families_[found->second].normal) < 0};
  }
  // Two normals within the tolerance differ by at most one quantum per component.
  for (const int sign : {1, -1})
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
        {
          const Vec3 n = sign * normal;
          const auto found =
              family_by_key_.find({normal_kind, quantised(n[0], normal_tolerance) + i,
                                   quantised(n[1], normal_tolerance) + j, quantised(n[2], normal_tolerance) + k});
          if (found != family_by_key_.end() && (families_[found->second].normal - n).norm() <= normal_tolerance)
            return FamilyMatch{found->second, sign < 0};
        }
  return {};
}

GlidePlanes::FamilyMatch GlidePlanes::find_or_insert_family(const std::array<int, 3> &miller, const Vec3 &normal)
{
  require_unit(normal);
  const std::array<int, 3> indices = reduced(miller);
  if (const auto found = find_family(indices, normal))
  {
    const Vec3 &stored = families_[found->family].normal;
    if ((found->reversed ? Vec3(stored + normal) : Vec3(stored - normal)).norm() > 2 * input_tolerance)
      throw std::invalid_argument("Glide plane " + name_of_plane(indices) +
                                  " was given with two different normals; was the crystal orientation changed?");
    return *found;
  }
  const bool reversed = leading_sign(miller) < 0;
  const Vec3 unit = (reversed ? Vec3(-normal) : normal).normalized();
  const auto family = static_cast<std::uint32_t>(families_.size());
  families_.push_back({indices, unit});
  if (is_crystallographic(indices))
    family_by_key_[{miller_kind, indices[0], indices[1], indices[2]}] = family;
  else
    family_by_key_[{normal_kind, quantised(unit[0], normal_tolerance), quantised(unit[1], normal_tolerance),
                    quantised(unit[2], normal_tolerance)}] = family;
  return {family, reversed};
}

std::optional<PlaneIndex> GlidePlanes::find_in_family(std::uint32_t family, double offset) const
{
  const std::int64_t quantum = quantised(offset, offset_quantum);
  std::optional<PlaneIndex> nearest;
  double nearest_distance = offset_quantum;
  for (const int shift : {0, -1, 1})
  {
    const auto found = plane_by_key_.find({family, quantum + shift, 0, 0});
    if (found == plane_by_key_.end())
      continue;
    const double distance = std::abs(planes_[found->second].offset - offset);
    if (distance <= nearest_distance)
    {
      nearest = PlaneIndex{found->second};
      nearest_distance = distance;
    }
  }
  return nearest;
}

PlaneIndex GlidePlanes::find_or_insert_in_family(std::uint32_t family, double offset)
{
  if (!(std::abs(offset) < largest_offset))
    throw std::invalid_argument("The offset of a glide plane is " + std::to_string(offset) +
                                " nm; it must be finite and below 1e12 nm.");
  if (const auto found = find_in_family(family, offset))
    return *found;
  const auto index = static_cast<std::uint32_t>(planes_.size());
  planes_.push_back({families_[family].miller, families_[family].normal, offset});
  family_of_plane_.push_back(family);
  plane_by_key_[{family, quantised(offset, offset_quantum), 0, 0}] = index;
  return PlaneIndex{index};
}

PlaneIndex GlidePlanes::find_or_insert(const std::array<int, 3> &miller, const Vec3 &unit_normal_sample, double offset)
{
  const FamilyMatch match = find_or_insert_family(miller, unit_normal_sample);
  return find_or_insert_in_family(match.family, match.reversed ? -offset : offset);
}

PlaneIndex GlidePlanes::find_or_insert(const std::array<int, 3> &miller, const Vec3 &unit_normal_sample,
                                       const Vec3 &point)
{
  const FamilyMatch match = find_or_insert_family(miller, unit_normal_sample);
  return find_or_insert_in_family(match.family, families_[match.family].normal.dot(point));
}

std::optional<PlaneIndex> GlidePlanes::find(const std::array<int, 3> &miller, const Vec3 &unit_normal_sample,
                                            const Vec3 &point) const
{
  const auto match = find_family(reduced(miller), unit_normal_sample);
  if (!match)
    return {};
  return find_in_family(match->family, families_[match->family].normal.dot(point));
}

PlaneIndex GlidePlanes::find_or_insert_parallel(PlaneIndex p, const Vec3 &point)
{
  const std::uint32_t family = family_of_plane_[p.value];
  return find_or_insert_in_family(family, families_[family].normal.dot(point));
}

bool GlidePlanes::contains(PlaneIndex p, const Vec3 &x, double tolerance) const
{
  return std::abs(distance(p, x)) <= tolerance;
}

double GlidePlanes::distance(PlaneIndex p, const Vec3 &x) const
{
  return planes_[p.value].normal.dot(x) - planes_[p.value].offset;
}

Vec3 GlidePlanes::project(PlaneIndex p, const Vec3 &x) const
{
  return x - distance(p, x) * planes_[p.value].normal;
}

std::optional<Vec3> GlidePlanes::intersection_direction(PlaneIndex a, PlaneIndex b) const
{
  const Vec3 line = planes_[a.value].normal.cross(planes_[b.value].normal);
  if (parallel(a, b) || line.norm() <= parallel_tolerance)
    return {};
  return line.normalized();
}

Vec3 GlidePlanes::project_on_intersection(std::span<const PlaneIndex> planes, const Vec3 &x) const
{
  // Minimise |dx| subject to n_k . dx = -distance_k: dx = -N^+ d, with the pseudo-inverse from N^T N (3x3).
  Mat3 normal_matrix = Mat3::Zero();
  Vec3 right_side = Vec3::Zero();
  PlaneIndex first;
  bool several = false;
  for (std::size_t k = 0; k < planes.size(); ++k)
  {
    bool repeated = !planes[k].is_valid();
    for (std::size_t l = 0; l < k && !repeated; ++l)
      repeated = planes[l] == planes[k];
    if (repeated)
      continue;
    several = first.is_valid();
    if (!several)
      first = planes[k];
    const Vec3 &n = planes_[planes[k].value].normal;
    normal_matrix += n * n.transpose();
    right_side -= distance(planes[k], x) * n;
  }
  if (!first.is_valid())
    return x;
  if (!several)
    return project(first, x);
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(normal_matrix);
  Vec3 dx = Vec3::Zero();
  for (int d = 0; d < 3; ++d)
    if (eigen.eigenvalues()[d] > parallel_tolerance * parallel_tolerance)
    {
      const Vec3 direction = eigen.eigenvectors().col(d);
      dx += direction.dot(right_side) / eigen.eigenvalues()[d] * direction;
    }
  return x + dx;
}
} // namespace ddfem
