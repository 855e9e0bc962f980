// Glide planes as objects with exact keys.
#pragma once

#include "dd/common/types.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace ddfem
{
/// Index of a plane in GlidePlanes.
struct PlaneIndex
{
  std::uint32_t value = invalid;
  static constexpr std::uint32_t invalid = 0xffffffffU;
  bool is_valid() const { return value != invalid; }
  auto operator<=>(const PlaneIndex &) const = default;
};

/// The plane { x : normal . x = offset }.
struct GlidePlane
{
  /// Reduced, first non-zero index positive; 0 0 0 for a plane that is not crystallographic.
  std::array<int, 3> miller{};
  Vec3 normal = Vec3::Zero(); ///< unit, sample frame
  double offset = 0.0;        ///< nm
};

/// Registry of glide planes: a plane is stored once, however often and with whatever rounding it is asked for.
///
/// All planes with the same Miller indices share one normal, that of the first one inserted, to the last bit; their
/// offsets are keyed in quanta of 1e-6 nm. A plane whose offset is within one quantum of a stored plane is that stored
/// plane (the neighbouring quanta are searched too, so that two sides of a rounding boundary never become two planes).
/// Planes without Miller indices (0 0 0) are grouped by their normal instead, to 1e-9 rad.
///
/// Indices are given in the order of insertion and never change. The const interface may be used concurrently.
class GlidePlanes
{
public:
  static constexpr double offset_quantum = 1e-6; ///< nm
  /// Normals of planes without Miller indices, rad: at 1e4 nm from the origin it moves a plane by 1e-5 nm.
  static constexpr double normal_tolerance = 1e-9;

  /// The plane with these Miller indices (crystal frame, any common factor and sign; 0 0 0: not crystallographic),
  /// unit normal (sample frame) and offset (nm) along it. @p offset belongs to the sense of @p unit_normal_sample; the
  /// stored plane may have both reversed, together.
  /// Throws std::invalid_argument if the normal is not of unit length, the offset not finite, or the normal
  /// contradicts that of an earlier plane with the same Miller indices.
  PlaneIndex find_or_insert(const std::array<int, 3> &miller, const Vec3 &unit_normal_sample, double offset);
  /// The plane with this orientation through @p point (nm, sample frame). Prefer this overload when the normal may
  /// carry rounding errors: the offset is then measured along the stored normal.
  PlaneIndex find_or_insert(const std::array<int, 3> &miller, const Vec3 &unit_normal_sample, const Vec3 &point);
  /// As above, but only looks; empty if there is no such plane.
  std::optional<PlaneIndex> find(const std::array<int, 3> &miller, const Vec3 &unit_normal_sample,
                                 const Vec3 &point) const;
  /// The plane parallel to @p p through @p point (nm).
  PlaneIndex find_or_insert_parallel(PlaneIndex p, const Vec3 &point);

  const GlidePlane &operator[](PlaneIndex p) const { return planes_[p.value]; }
  std::size_t size() const { return planes_.size(); }

  /// Whether two planes have the same orientation. Exact: no tolerance is involved after insertion.
  bool parallel(PlaneIndex a, PlaneIndex b) const { return family_of_plane_[a.value] == family_of_plane_[b.value]; }
  /// Whether @p x lies on the plane to @p tolerance (nm).
  bool contains(PlaneIndex p, const Vec3 &x, double tolerance = offset_quantum) const;
  /// Signed distance of @p x from the plane, nm, positive on the side the stored normal points to.
  double distance(PlaneIndex p, const Vec3 &x) const;
  /// Foot of the perpendicular from @p x on the plane, nm.
  Vec3 project(PlaneIndex p, const Vec3 &x) const;
  /// Unit vector along the line in which two planes meet, sense of normal(a) x normal(b); empty for parallel planes.
  std::optional<Vec3> intersection_direction(PlaneIndex a, PlaneIndex b) const;
  /// The point nearest to @p x (nm) that lies on all of @p planes. Invalid indices are skipped, repeated ones count
  /// once. When the planes have no common point (parallel ones, or more than three in general position) the
  /// least-squares point nearest to @p x is returned: compare with contains() where that matters.
  Vec3 project_on_intersection(std::span<const PlaneIndex> planes, const Vec3 &x) const;

private:
  /// An orientation shared by parallel planes.
  struct Family
  {
    std::array<int, 3> miller{};
    Vec3 normal = Vec3::Zero();
  };
  using Key = std::array<std::int64_t, 4>;
  struct KeyHash
  {
    std::size_t operator()(const Key &key) const;
  };
  /// A family and whether the normal asked for is opposite to the stored one.
  struct FamilyMatch
  {
    std::uint32_t family = 0;
    bool reversed = false;
  };

  std::optional<FamilyMatch> find_family(const std::array<int, 3> &reduced, const Vec3 &normal) const;
  FamilyMatch find_or_insert_family(const std::array<int, 3> &miller, const Vec3 &normal);
  std::optional<PlaneIndex> find_in_family(std::uint32_t family, double offset) const;
  PlaneIndex find_or_insert_in_family(std::uint32_t family, double offset);

  std::vector<GlidePlane> planes_;
  std::vector<std::uint32_t> family_of_plane_;
  std::vector<Family> families_;
  std::unordered_map<Key, std::uint32_t, KeyHash> family_by_key_; ///< Miller indices, or quantised normal
  std::unordered_map<Key, std::uint32_t, KeyHash> plane_by_key_;  ///< family and offset in quanta
};
} // namespace ddfem
