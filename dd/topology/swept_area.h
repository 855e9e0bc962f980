// Every motion of a line sweeps triangles: plastic strain and displacement increments are sums over them.
#pragma once

#include "dd/elasticity/triangle_displacement.h"
#include "dd/network/glide_plane.h"
#include "dd/network/network.h"

#include <array>
#include <vector>

namespace ddfem
{
/// A small closed dislocation loop v1 -> v2 -> v3: the new line minus the old one.
struct SweptTriangle
{
  std::array<LoopVertex, 3> vertices;
  Vec3 burgers;     ///< nm
  PlaneIndex plane; ///< glide plane of the line that moved
  bool inside;      ///< swept by the real line inside the grain; otherwise by virtual rays
};

/// The triangles swept since the last clear(), in the order of the events.
class SweptArea
{
public:
  /// The loop p1 -> p2 -> p3 inside the grain.
  void add_triangle(const Vec3 &p1, const Vec3 &p2, const Vec3 &p3, const Vec3 &b, PlaneIndex plane);
  /// A ray with Burgers vector @p b (sense leaving the origin) moved from origin o along d to o_new along d_new.
  void add_ray_motion(const Vec3 &o, const Vec3 &d, const Vec3 &o_new, const Vec3 &d_new, const Vec3 &b,
                      PlaneIndex plane);
  /// The line p -> q on the surface was replaced by p -> infinity along d_p and infinity along d_q -> q.
  void add_opening(const Vec3 &p, const Vec3 &d_p, const Vec3 &q, const Vec3 &d_q, const Vec3 &b, PlaneIndex plane);

  const std::vector<SweptTriangle> &triangles() const { return swept; }
  void clear() { swept.clear(); }

private:
  void add(const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3, const Vec3 &b, PlaneIndex plane,
           bool inside);
  std::vector<SweptTriangle> swept;
};

/// Plastic strain times volume, nm^3: - sym(b x A) summed over the triangles inside, A their right-hand area vector. The sign
/// follows from the work of the Peach-Koehler force f = (sigma . b) x xi, sigma : strain V = f . dx.
SymTensor plastic_strain_volume(const SweptArea &area);
} // namespace ddfem
