// Shape of the grain as the dislocations see it: inside or outside, nearest face, outward normal.
#pragma once

#include "dd/common/types.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ddfem
{
/// What a face of the grain does to a line that reaches it; independent of the elastic boundary condition.
enum class FaceKind : std::uint8_t
{
  free,         ///< lines leave the grain and a slip step remains
  impenetrable, ///< lines stop
};

/// Body bounded by faces with integer ids (the boundary ids of the mesh). Lengths in nm, sample frame.
class GrainShape
{
public:
  virtual ~GrainShape() = default;

  /// Distance to the surface, negative inside; outside it may be a lower bound of the distance. Continuous, and
  /// with |gradient| <= 1 almost everywhere.
  virtual double signed_distance(const Vec3 &x) const = 0;
  /// Outward unit normal of the face nearest to @p x.
  virtual Vec3 outward_normal(const Vec3 &x) const = 0;
  /// Id of the face nearest to @p x.
  virtual int face(const Vec3 &x) const = 0;
  virtual double volume() const = 0; ///< nm^3
  /// Whether every straight way out of the grain along the outward normal stays outside.
  virtual bool is_convex() const { return true; }
  virtual Vec3 lower_corner() const = 0; ///< of the bounding box
  virtual Vec3 upper_corner() const = 0;

  /// Length of the bounding box' diagonal, nm: the scale for tolerances.
  double diameter() const { return (upper_corner() - lower_corner()).norm(); }

  void set_face_kind(int face_id, FaceKind kind);
  FaceKind face_kind(int face_id) const;

private:
  std::vector<FaceKind> face_kinds; // by face id; free where not set
};

/// Axis-parallel box; faces x-, x+, y-, y+, z-, z+ are 0..5.
class BoxShape final : public GrainShape
{
public:
  BoxShape(const Vec3 &lower, const Vec3 &upper);
  double signed_distance(const Vec3 &x) const override;
  Vec3 outward_normal(const Vec3 &x) const override;
  int face(const Vec3 &x) const override;
  double volume() const override;
  Vec3 lower_corner() const override { return lower; }
  Vec3 upper_corner() const override { return upper; }

private:
  Vec3 lower, upper;
};

/// Circular cylinder with axis z; faces side, bottom, top are 0, 1, 2.
class CylinderShape final : public GrainShape
{
public:
  /// @p base is the centre of the bottom disc.
  CylinderShape(const Vec3 &base, double radius, double height);
  double signed_distance(const Vec3 &x) const override;
  Vec3 outward_normal(const Vec3 &x) const override;
  int face(const Vec3 &x) const override;
  double volume() const override;
  Vec3 lower_corner() const override;
  Vec3 upper_corner() const override;

private:
  Vec3 base;
  double radius, height;
};

/// Convex polyhedron: the intersection of half-spaces, built from the boundary facets of a mesh.
class PolyhedronShape final : public GrainShape
{
public:
  struct Facet
  {
    std::vector<Vec3> vertices; ///< in order around the facet, either sense
    int face_id = 0;
  };
  /// Coplanar facets with the same id are merged into one face. Throws std::invalid_argument if the facets do not
  /// bound a convex body (a vertex in front of a facet by more than 1e-6 of the diameter): virtual rays along the
  /// face normals would re-enter the grain.
  explicit PolyhedronShape(const std::vector<Facet> &facets);
  double signed_distance(const Vec3 &x) const override;
  Vec3 outward_normal(const Vec3 &x) const override;
  int face(const Vec3 &x) const override;
  double volume() const override { return enclosed_volume; }
  Vec3 lower_corner() const override { return lower; }
  Vec3 upper_corner() const override { return upper; }

private:
  struct HalfSpace
  {
    Vec3 normal;
    double offset;
    int face_id;
  };
  const HalfSpace &nearest(const Vec3 &x) const;
  std::vector<HalfSpace> half_spaces;
  Vec3 lower, upper;
  double enclosed_volume = 0;
};

/// Point on the surface reached from @p x by moving within the plane of unit normal @p plane_normal (Newton iterations
/// along the in-plane part of the outward normal); a zero normal leaves the direction free. The result satisfies
/// |signed_distance| < 1e-9 diameter. Empty if the plane does not meet the surface near @p x (it is parallel to the face).
std::optional<Vec3> project_to_surface(const GrainShape &shape, const Vec3 &x, const Vec3 &plane_normal);

/// The same for a point that may move in some directions only, a plane or a line: @p directions projects on them orthogonally.
std::optional<Vec3> project_to_surface_within(const GrainShape &shape, const Vec3 &x, const Mat3 &directions);

/// First point on the surface along the straight path from @p inside (signed distance <= 0) to @p outside. In a re-entrant
/// grain, ways out that are shorter than an eighth of the path may be overlooked.
Vec3 surface_crossing(const GrainShape &shape, const Vec3 &inside, const Vec3 &outside);
} // namespace ddfem
