#include "dd/forces/far_field_cache.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ddfem
{
namespace
{
/// How far a point may lie outside its leaf, in sizes of the leaf: local expansions converge less and less there.
constexpr double farthest_of_leaf = 0.1;
/// The displacement up to which a measured growth of the error is trusted, in those it was measured at.
constexpr double growth = 2;
/// Leaves in which errors are measured: a sixteenth, but some in small trees.
constexpr std::size_t largest_stride = 16, fewest_leaves = 32;

FarFieldCache::Field fresh(const FieldRequest &r, const fmm::Part part)
{
  auto field = std::make_shared<MultipoleField>(r.system, r.points, r.settings);
  std::vector<SymTensor> stress = field->stress(r.comm, part);
  return {std::move(field), std::move(stress)};
}

/// Images of the lines beyond the neighbours, for the images of lines that act in the tree.
void set_images(const FieldRequest &r, const std::vector<fmm::LineSource> &lines)
{
  std::vector<LineElement> elements;
  elements.reserve(lines.size());
  for (const fmm::LineSource &l : lines)
    elements.push_back({l.start, l.end, l.burgers});
  r.images->set_sources(r.system.medium(), elements);
}
} // namespace

FarFieldCache::Field FarFieldCache::evaluate(const FieldRequest &request)
{
  const bool starts = std::exchange(at_start_of_step, false);
  if (settings.mode == FarFieldRefresh::never)
    return fresh(request, fmm::Part::near);
  const std::optional<Placement> placement = place(request);
  if (starts && (!placement || is_due(*placement)))
    return refresh(request, placement);
  if (!placement || !is_allowed(*placement))
  {
    ++n.without;
    return fresh(request, fmm::Part::all);
  }
  ++n.kept;
  move(request, *placement);
  return {kept->field, kept->field->stress_with_kept_far_field(request.comm)};
}

std::optional<FarFieldCache::Placement> FarFieldCache::place(const FieldRequest &request) const
{
  if (!kept || settings.mode == FarFieldRefresh::every_evaluation || !request.system.rays().empty())
    return {};
  const fmm::Octree &tree = kept->field->sum().octree();
  auto lines = kept->lines.place(request.network, request.system, tree);
  if (!lines)
    return {};
  Placement placement{std::move(*lines), std::vector<std::uint32_t>(request.points.size())};
  bool all_near = true;
#pragma omp parallel for schedule(static) reduction(&& : all_near)
  for (std::size_t i = 0; i < request.points.size(); ++i)
  {
    const Vec3 x = request.points[i] + request.system.shift_into_cell(request.points[i]);
    const std::uint32_t leaf = placement.leaf_of_point[i] = tree.leaf_at(x);
    all_near = all_near && tree.distance_outside(leaf, x) <= farthest_of_leaf * tree.size(tree.boxes()[leaf]);
  }
  if (!all_near)
    return {};
  return placement;
}

bool FarFieldCache::is_due(const Placement &placement)
{
  ++kept->n_steps;
  if (settings.mode == FarFieldRefresh::every_n_steps)
    return kept->n_steps >= settings.interval;
  // The step that begins moves the lines about as far as the last one, and all of it should use one far field.
  const double now = placement.lines.displacement;
  const double last_step = now - std::exchange(kept->at_last_start, now);
  return now + last_step > allowed_displacement;
}

bool FarFieldCache::is_allowed(const Placement &placement) const
{
  return settings.mode == FarFieldRefresh::every_n_steps || placement.lines.displacement <= allowed_displacement;
}

FarFieldCache::Field FarFieldCache::refresh(const FieldRequest &request, const std::optional<Placement> &placement)
{
  ++n.refreshed;
  Field result = fresh(request, fmm::Part::all);
  if (!request.system.rays().empty() || settings.mode == FarFieldRefresh::every_evaluation)
    return result;
  if (placement && settings.mode == FarFieldRefresh::adaptive)
    measure(request, *placement, result.stress);
  kept = std::make_unique<Kept>(
      Kept{result.field, FrozenLines(request.network, request.system, result.field->sum().octree())});
  return result;
}

void FarFieldCache::measure(const FieldRequest &request, const Placement &placement,
                            const std::vector<SymTensor> &exact)
{
  move(request, placement);
  MultipoleField &field = *kept->field;
  const std::size_t stride = std::clamp<std::size_t>(field.sum().n_leaves() / fewest_leaves, 1, largest_stride);
  const std::vector<std::size_t> sample = field.sum().points_of_leaves(stride);
  const auto far = field.sum().stress_with_kept_far_field(request.comm, fmm::Part::far, stride);
  const auto near = field.sum().stress_with_kept_far_field(request.comm, fmm::Part::near, stride);
  double difference = 0, scale = 0;
  for (const std::size_t i : sample)
  {
    difference += (far[i] + near[i] + field.stress_of_distant_images(i) - exact[i]).squaredNorm();
    scale += far[i].squaredNorm();
  }
  displacement = placement.lines.displacement;
  error = scale > 0 ? std::sqrt(difference / scale) : 0.0;
  const double tolerated = settings.share_of_tolerance * request.settings.tolerance;
  allowed_displacement = displacement * (error > 0 ? std::min(growth, tolerated / error) : growth);
}

void FarFieldCache::move(const FieldRequest &request, const Placement &placement)
{
  kept->field->move(request.system, request.points, placement.lines, placement.leaf_of_point);
  if (request.images && !placement.lines.in_system_frame)
    set_images(request, placement.lines.lines);
}
} // namespace ddfem
