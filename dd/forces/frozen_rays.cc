#include "dd/forces/frozen_rays.h"

#include <algorithm>

namespace ddfem
{
namespace
{
/// Change of the unit vector between two refreshes above which a ray has turned at an edge, and does not go on turning.
constexpr double largest_turn = 0.1;

fmm::LineSource reversed(fmm::LineSource l)
{
  l.burgers = -l.burgers;
  return l;
}

void append_correction(const fmm::RaySource &distant, const double sign, LinesInBoxes &placed)
{
  placed.ray_corrections.push_back({distant.origin, distant.direction, sign * distant.burgers});
}
} // namespace

fmm::RaySource FrozenRays::Ray::moved(const double times) const
{
  return {source.origin + times * origin_motion, (source.direction + times * direction_motion).normalized(),
          source.burgers};
}

FrozenRays::FrozenRays(const std::span<const VirtualRay> rays, const CutRays &cuts, std::span<const std::uint32_t> box)
    : grid(cuts.grid), shortest(cuts.shortest)
{
  frozen.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    const std::size_t n_pieces = cuts.ways[i].size() - 1;
    frozen.push_back({rays[i].node, source_of(rays[i]), cuts.ways[i], {box.begin(), box.begin() + n_pieces}, i});
    box = box.subspan(n_pieces);
  }
  std::sort(frozen.begin(), frozen.end(), [](const Ray &a, const Ray &b) { return a.node < b.node; });
}

void FrozenRays::set_motion(const FrozenRays &before, const std::unordered_map<ObjectId, Vec3> &motion_of)
{
  for (Ray &ray : frozen)
  {
    if (const auto found = motion_of.find(ray.node); found != motion_of.end())
      ray.origin_motion = found->second;
    const Ray *const old = before.find({{}, {}, ray.source.burgers, ray.node});
    const Vec3 turn = old ? Vec3(ray.source.direction - old->source.direction) : Vec3(Vec3::Zero());
    ray.direction_motion = turn.norm() < largest_turn ? turn : Vec3(Vec3::Zero());
  }
}

void FrozenRays::forget_motion()
{
  for (Ray &ray : frozen)
    ray.origin_motion = ray.direction_motion = Vec3::Zero();
}

void FrozenRays::append_earlier(std::vector<fmm::LineSource> &lines, std::vector<fmm::RaySource> &distant) const
{
  std::vector<const Ray *> in_order(frozen.size());
  for (const Ray &ray : frozen)
    in_order[ray.order] = &ray;
  for (const Ray *const ray : in_order)
    distant.push_back(fmm::cut_ray(ray->moved(-1), ray->ways, lines));
}

/// The ray of the same node; null if there was none, or one with another Burgers vector.
const FrozenRays::Ray *FrozenRays::find(const VirtualRay &ray) const
{
  const auto r = std::lower_bound(frozen.begin(), frozen.end(), ray.node,
                                  [](const Ray &old, const ObjectId node) { return old.node < node; });
  return r != frozen.end() && r->node == ray.node && r->source.burgers == ray.burgers ? &*r : nullptr;
}

bool FrozenRays::has_jumped(const Ray &old, const fmm::RaySource &now, const double ahead, const fmm::Octree &tree,
                            const double longest_jump)
{
  const fmm::RaySource foreseen = old.moved(ahead);
  const Vec3 origin = now.origin - foreseen.origin, direction = now.direction - foreseen.direction;
  for (std::size_t k = 0; k < old.box.size(); ++k)
    if ((origin + old.ways[k + 1] * direction).norm() > longest_jump * tree.size(tree.boxes()[old.box[k]]))
      return true;
  return false;
}

std::optional<FrozenRays::Nodes> FrozenRays::place(const std::span<const VirtualRay> now, const fmm::Octree &tree,
                                                   const double longest_jump, LinesInBoxes &placed,
                                                   double &squares) const
{
  Nodes changed;
  std::vector<std::uint8_t> is_here(frozen.size(), 0);
  placed.cuts = {grid, shortest, {}};
  for (const VirtualRay &r : now)
  {
    const Ray *const old = find(r);
    if (!old || has_jumped(*old, source_of(r), placed.ahead, tree, longest_jump))
    {
      changed.insert(r.node);
      place_new(source_of(r), tree, placed);
      continue;
    }
    is_here[static_cast<std::size_t>(old - frozen.data())] = 1;
    const Vec3 rest = r.origin - old->moved(placed.ahead).origin;
    squares += (shortest * rest.cross(r.direction)).squaredNorm();
    placed.distant_rays.push_back(fmm::cut_ray(source_of(r), old->ways, placed.lines));
    placed.cuts.ways.push_back(old->ways);
    for (std::size_t k = 0; k < old->box.size(); ++k)
    {
      const fmm::LineSource &piece = placed.lines[placed.box.size()];
      placed.box.push_back(old->box[k]);
      if (!placed.stays(0.5 * (piece.start + piece.end), old->box[k], tree))
        return {};
    }
  }
  for (std::size_t i = 0; i < frozen.size(); ++i)
    if (const Ray &gone = frozen[i]; is_here[i] == 0)
    {
      changed.insert(gone.node);
      std::vector<fmm::LineSource> pieces;
      append_correction(fmm::cut_ray(gone.moved(placed.ahead), gone.ways, pieces), -1, placed);
      for (std::size_t k = 0; k < pieces.size(); ++k)
        placed.corrections.push_back({reversed(pieces[k]), gone.box[k]});
    }
  return changed;
}

void FrozenRays::place_new(const fmm::RaySource &ray, const fmm::Octree &tree, LinesInBoxes &placed) const
{
  placed.cuts.ways.push_back(fmm::cuts_of(ray, grid, shortest));
  placed.distant_rays.push_back(fmm::cut_ray(ray, placed.cuts.ways.back(), placed.lines));
  append_correction(placed.distant_rays.back(), 1, placed);
  while (placed.box.size() < placed.lines.size())
    placed.box.push_back(placed.box_of_new(placed.lines[placed.box.size()], tree));
}
} // namespace ddfem
