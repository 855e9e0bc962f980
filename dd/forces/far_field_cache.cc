#include "dd/forces/far_field_cache.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ddfem
{
namespace
{
/// How far a point may lie outside its leaf, in sizes of the leaf: local expansions converge less and less there.
constexpr double farthest_of_leaf = 0.1;
/// See FrozenLines::place().
constexpr double longest_jump = 0.01;
/// How far the middle of a line may lie outside its box, in box sizes, when the moments of the box are computed again.
constexpr double farthest_in_same_tree = 0.1;
/// Change of the number of lines after which a tree is made anew.
constexpr double largest_change = 0.1;
/// The displacement up to which a measured growth of the error is trusted, in those it was measured at.
constexpr double trusted_growth = 2;
/// Displacement by which the second order of a motion acts, relative to its square in sizes of the smallest box (measured).
constexpr double curvature_weight = 2;
/// Part of the allowed displacement by which changes of topology may be taken for motion.
constexpr double negligible_jump = 0.05;
/// Leaves in which errors are measured: a sixteenth, but some in small trees.
constexpr std::size_t largest_stride = 16, fewest_leaves = 32;

/// Finds the leaf of a point. @p x: moved to the image that is near one, where it has left the cell. Returns whether it is.
bool place_point(const fmm::Octree &tree, Vec3 &x, std::uint32_t &leaf)
{
  for (const Vec3 &shift : tree.image_shifts())
  {
    leaf = tree.leaf_at(x + shift);
    if (tree.distance_outside(leaf, x + shift) <= farthest_of_leaf * tree.size(tree.boxes()[leaf]))
    {
      x += shift;
      return true;
    }
  }
  return false;
}

/// Makes lines the sources of the images beyond the neighbours.
void set_images(const FieldRequest &r, const std::vector<fmm::LineSource> &lines)
{
  if (!r.images)
    return;
  std::vector<LineElement> elements;
  elements.reserve(lines.size());
  for (const fmm::LineSource &l : lines)
    elements.push_back({l.start, l.end, l.burgers});
  r.images->set_sources(r.system.medium(), elements);
}

PeriodicImages::Coefficients field_of_images(const FieldRequest &r)
{
  return r.images ? r.images->far_field() : PeriodicImages::Coefficients();
}

FarFieldCache::Field fresh(const FieldRequest &r, const fmm::Part part,
                           const fmm::LocalExpansions local = fmm::LocalExpansions::used_once)
{
  if (part != fmm::Part::near)
    set_images(r, line_sources(r.system));
  auto field = std::make_shared<MultipoleField>(r.system, r.points, r.settings);
  std::vector<SymTensor> stress = field->stress(r.comm, part, fmm::Recipient::owner, local);
  return {std::move(field), std::move(stress)};
}
} // namespace

void FarFieldCache::forget()
{
  kept.reset();
  growth = {};
}

FarFieldCache::Field FarFieldCache::evaluate(const FieldRequest &request)
{
  const bool starts = std::exchange(at_start_of_step, false);
  if (settings.mode == FarFieldRefresh::never)
    return fresh(request, fmm::Part::near);
  std::optional<Placement> placement = place(request);
  if (starts && (!placement || is_due(request, *placement)))
    return refresh(request, std::move(placement));
  if (!placement || !is_allowed(request, *placement))
  {
    ++n.without;
    return fresh(request, fmm::Part::all);
  }
  ++n.kept;
  move(request, *placement);
  return {kept->field,
          kept->field->stress_with_kept_far_field(request.comm, placement->lines.ahead, fmm::Recipient::owner)};
}

std::optional<FarFieldCache::Placement> FarFieldCache::place(const FieldRequest &request) const
{
  if (!kept || settings.mode == FarFieldRefresh::every_evaluation)
    return {};
  const fmm::Octree &tree = kept->field->sum().octree();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  auto lines = kept->lines.place(request.network, request.system, tree,
                                 settings.mode == FarFieldRefresh::adaptive ? longest_jump : infinity);
  if (!lines)
    return {};
  Placement placement{std::move(*lines), {request.points.begin(), request.points.end()}, {}};
  placement.leaf_of_point.resize(request.points.size());
  bool all_near = true;
#pragma omp parallel for schedule(static) reduction(&& : all_near)
  for (std::size_t i = 0; i < request.points.size(); ++i)
  {
    Vec3 &x = placement.points[i];
    x += request.system.shift_into_cell(x);
    all_near = place_point(tree, x, placement.leaf_of_point[i]) && all_near;
  }
  if (!all_near)
    return {};
  return placement;
}

/// By which the error is estimated: what the extrapolation leaves of the motion, and its curvature as a displacement.
double FarFieldCache::displacement_of(const Placement &placement) const
{
  const fmm::Octree &tree = kept->field->sum().octree();
  const LinesInBoxes &l = placement.lines;
  return std::hypot(l.displacement, l.jump) + curvature_weight * l.curvature / tree.size(tree.boxes().back());
}

double FarFieldCache::tolerated_error(const FieldRequest &request) const
{
  return settings.share_of_tolerance * request.settings.tolerance;
}

double FarFieldCache::allowed_displacement(const FieldRequest &request) const
{
  return growth.allowed(tolerated_error(request));
}

double FarFieldCache::Growth::allowed(const double tolerated) const
{
  return rate > 0 ? std::min(tolerated / rate, trusted) : trusted;
}

void FarFieldCache::Growth::learn(const double tolerated, const double error, const double displacement)
{
  if (displacement == 0)
    return;
  const double before = allowed(tolerated);
  // What small errors consist of besides need not grow: they only bound the rate from above.
  const double measured = error / displacement;
  if (rate == 0 || error > 0.5 * tolerated)
    rate = measured;
  else
    rate = std::clamp(measured, 0.5 * rate, rate);
  trusted = trusted_growth * std::max(displacement, before);
}

bool FarFieldCache::is_due(const FieldRequest &request, const Placement &placement)
{
  ++kept->n_steps;
  if (settings.mode == FarFieldRefresh::every_n_steps)
    return kept->n_steps >= settings.interval;
  // All of the step that begins should use one far field. Its displacement grows by about half more than in the last one.
  const double now = displacement_of(placement), last_step = now - std::exchange(kept->at_last_start, now);
  return now + 1.5 * std::max(0.0, last_step) > allowed_displacement(request);
}

bool FarFieldCache::is_allowed(const FieldRequest &request, const Placement &placement) const
{
  return settings.mode == FarFieldRefresh::every_n_steps || displacement_of(placement) <= allowed_displacement(request);
}

bool FarFieldCache::tree_is_good(const std::optional<Placement> &placement, const std::size_t n_lines) const
{
  if (!placement || settings.mode != FarFieldRefresh::adaptive || placement->lines.farthest > farthest_in_same_tree)
    return false;
  const auto now = static_cast<double>(n_lines), then = static_cast<double>(kept->n_lines);
  return std::abs(now - then) <= largest_change * then;
}

FarFieldCache::Field FarFieldCache::refresh(const FieldRequest &request, std::optional<Placement> placement)
{
  ++n.refreshed;
  std::optional<Sample> before;
  if (placement)
    before = sample(request, *placement);
  Field result = tree_is_good(placement, request.system.lines().size())
                     ? refresh_in_same_tree(request, std::move(*placement))
                     : refresh_in_new_tree(request);
  if (before)
    learn(request, *before, result.stress);
  return result;
}

FarFieldCache::Field FarFieldCache::refresh_in_new_tree(const FieldRequest &request)
{
  ++n.trees;
  const std::unique_ptr<Kept> before = std::move(kept);
  const bool keeps = settings.mode != FarFieldRefresh::every_evaluation;
  Field result = fresh(request, fmm::Part::all, keeps ? fmm::LocalExpansions::kept : fmm::LocalExpansions::used_once);
  if (!keeps)
    return result;
  const MultipoleField &field = *result.field;
  std::vector<fmm::LineSource> sources = line_sources(request.system);
  const std::size_t n_lines = sources.size();
  for (std::size_t i = 0; i < request.system.rays().size(); ++i)
    fmm::cut_ray(source_of(request.system.rays()[i]), field.cut_rays().ways[i], sources);
  kept = std::make_unique<Kept>(Kept{result.field,
                                     {request.network, request.system, sources, field.sum().octree().boxes_of_lines(),
                                      field.cut_rays(), before ? &before->lines : nullptr},
                                     n_lines,
                                     field_of_images(request),
                                     {}});
  if (before && settings.mode == FarFieldRefresh::adaptive)
    set_earlier(request);
  else
    kept->lines.forget_motion();
  return result;
}

FarFieldCache::Field FarFieldCache::refresh_in_same_tree(const FieldRequest &request, Placement placement)
{
  LinesInBoxes &now = placement.lines;
  const bool has_jumped = now.has_corrections() || now.jump > negligible_jump * allowed_displacement(request);
  now.drop_corrections();
  FrozenLines lines(request.network, request.system, now.lines, now.box, now.cuts, &kept->lines);
  kept->field->move(request.system, placement.points, now, placement.leaf_of_point);
  set_images(request, now.lines);
  std::vector<SymTensor> stress = kept->field->stress_with_new_far_field(request.comm);
  kept = std::make_unique<Kept>(
      Kept{kept->field, std::move(lines), kept->n_lines, field_of_images(request), std::move(kept->images)});
  // The far field before holds other lines: without the changes of topology, motion remains.
  if (has_jumped)
    set_earlier(request);
  return {kept->field, std::move(stress)};
}

/// Makes the far field that is extrapolated from that of the lines before their motion.
void FarFieldCache::set_earlier(const FieldRequest &request)
{
  FrozenLines::Earlier earlier = kept->lines.earlier(request.network);
  if (request.images)
  {
    set_images(request, earlier.lines);
    kept->earlier_images = request.images->far_field();
    request.images->set_far_field(kept->images);
  }
  kept->field->set_earlier(earlier.lines, std::move(earlier.distant_rays));
}

void FarFieldCache::move(const FieldRequest &request, const Placement &placement)
{
  kept->field->move(request.system, placement.points, placement.lines, placement.leaf_of_point);
  if (!request.images)
    return;
  const double ahead = placement.lines.ahead;
  if (ahead == 0 || kept->earlier_images.size() == 0)
    request.images->set_far_field(kept->images);
  else
    request.images->set_far_field((1 + ahead) * kept->images - ahead * kept->earlier_images);
}

FarFieldCache::Sample FarFieldCache::sample(const FieldRequest &request, const Placement &placement)
{
  MultipoleField &field = *kept->field;
  const std::size_t stride = std::clamp<std::size_t>(field.sum().n_leaves() / fewest_leaves, 1, largest_stride);
  move(request, placement);
  const auto stress_of = [&](const fmm::Part part) {
    return field.sum().stress_with_kept_far_field(request.comm, {placement.lines.ahead, stride, part});
  };
  Sample result{field.sum().points_of_leaves(stride), stress_of(fmm::Part::far), stress_of(fmm::Part::near),
                displacement_of(placement)};
  for (const std::size_t i : result.points)
    result.all[i] += result.far[i] + field.stress_of_distant_images(i);
  return result;
}

void FarFieldCache::learn(const FieldRequest &request, const Sample &before, const std::vector<SymTensor> &now)
{
  double difference = 0, scale = 0;
  for (const std::size_t i : before.points)
  {
    difference += (before.all[i] - now[i]).squaredNorm();
    scale += before.far[i].squaredNorm();
  }
  error = scale > 0 ? std::sqrt(difference / scale) : 0.0;
  displacement = before.displacement;
  if (settings.mode == FarFieldRefresh::every_n_steps || displacement <= allowed_displacement(request))
    largest = std::max(largest, error);
  growth.learn(tolerated_error(request), error, displacement);
}
} // namespace ddfem
