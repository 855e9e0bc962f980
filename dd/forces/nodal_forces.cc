#include "dd/forces/nodal_forces.h"

#include "dd/common/parallel.h"
#include "dd/elasticity/gauss.h"
#include "dd/elasticity/self_force.h"
#include "dd/elasticity/vectorised/force_kernels.h"
#include "dd/forces/multipole_forces.h"

#include <optional>

namespace ddfem
{
namespace
{
using Contributions = std::array<SegmentForces, n_force_contributions>;

SegmentForces &operator+=(SegmentForces &f, const SegmentForces &g)
{
  f.start += g.start;
  f.end += g.end;
  return f;
}

SegmentForces &slot(Contributions &c, const ForceContribution which)
{
  return c[static_cast<std::size_t>(which)];
}

/// Nodal forces of a stress field: f = int N (sigma . b) x dx, by a rule on [0, 1].
template <class StressAtPoint>
SegmentForces force_of_field(const StraightLine &line, const std::span<const double> fractions,
                             const std::span<const double> weights, StressAtPoint &&stress)
{
  const Vec3 t = line.end - line.start;
  SegmentForces f{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t q = 0; q < fractions.size(); ++q)
  {
    const double s = fractions[q];
    const Vec3 df = weights[q] * contract(stress(q, Vec3(line.start + s * t)), line.burgers).cross(t);
    f.start += (1 - s) * df;
    f.end += s * df;
  }
  return f;
}

/// The same for a field that varies little along a segment.
template <class StressAtPoint> SegmentForces force_of_smooth_field(const StraightLine &line, StressAtPoint &&stress)
{
  const GaussRule rule = gauss_rule(3);
  return force_of_field(line, rule.points, rule.weights, stress);
}

/// Forces of lines, rays and images on segment number @p i, pair by pair.
void add_line_forces(const LineSystem &system, const std::size_t i, const ForceSettings &settings, Contributions &c)
{
  const StraightLine &line = system.lines()[i];
  const auto &medium = settings.medium;
  for (std::size_t k = 0; k < system.image_shifts().size(); ++k)
  {
    const Vec3 &shift = system.image_shifts()[k];
    slot(c, k == 0 ? ForceContribution::pairs : ForceContribution::images) +=
        force_of_segments(medium, system.segment_table(), line.start - shift, line.end - shift, line.burgers,
                          settings.pair_tolerance, k == 0 ? i : no_line);
  }
  slot(c, ForceContribution::rays) =
      force_of_rays(medium, system.ray_table(), line.start, line.end, line.burgers, settings.pair_tolerance);
  if (system.far_images())
    slot(c, ForceContribution::images) +=
        force_of_smooth_field(line, [&](std::size_t, const Vec3 &x) { return system.far_images()->far_stress(x); });
}

/// All contributions to the ends of segment number @p i.
Contributions segment_contributions(const LineSystem &system, const std::size_t i, const ForceSettings &settings,
                                    const ForceEnvironment &environment, const MultipoleForces *multipoles)
{
  Contributions c;
  c.fill({Vec3::Zero(), Vec3::Zero()});
  const StraightLine &line = system.lines()[i];
  const auto &medium = settings.medium;

  slot(c, ForceContribution::applied) =
      force_of_smooth_field(line, [&](std::size_t, const Vec3 &) -> const SymTensor & { return environment.applied; });
  slot(c, ForceContribution::self) = self_force(medium, line.start, line.end, line.burgers);
  slot(c, ForceContribution::core) =
      core_force(medium, CoreEnergy{settings.core_cutoff_radius}, line.start, line.end, line.burgers);
  if (multipoles)
    slot(c, ForceContribution::pairs) = (*multipoles)(i);
  else
    add_line_forces(system, i, settings, c);
  if (const SegmentField *const field = environment.correction; field && field->points.n_segments() > 0)
    slot(c, ForceContribution::correction) = force_of_field(line, field->points.fractions(i), field->points.weights(i),
                                                            [&](const std::size_t q, const Vec3 &) -> const SymTensor &
                                                            { return field->stress[field->points.begin_of(i) + q]; });
  return c;
}

SegmentForces total_of(const Contributions &contributions)
{
  SegmentForces sum{Vec3::Zero(), Vec3::Zero()};
  for (const SegmentForces &f : contributions)
    sum += f;
  return sum;
}

/// Values on all lines, by their numbers, of which each rank computes its share.
template <class Compute> auto on_all_lines(const LineShares &shares, MPI_Comm comm, Compute &&compute)
{
  std::vector<decltype(compute(std::size_t{}))> gathered(shares.lines.size()), by_line(shares.lines.size());
  const auto rank = static_cast<std::size_t>(rank_of(comm).mine);
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t k = shares.begin[rank]; k < shares.begin[rank + 1]; ++k)
    gathered[k] = compute(shares.lines[k]);
  gather_parts(gathered, shares.begin, comm);
  for (std::size_t k = 0; k < gathered.size(); ++k)
    by_line[shares.lines[k]] = gathered[k];
  return by_line;
}

/// Sums the segments' end forces at the nodes, in the fixed order of each node's arms.
template <class EndForces> std::vector<Vec3> gather_at_nodes(const Network &network, EndForces &&end_forces)
{
  std::vector<Vec3> force(network.node_capacity(), Vec3::Zero());
  network.for_each_node_with_segments(
      [&](const NodeIndex i, std::span<const SegmentIndex> arms)
      {
        for (const SegmentIndex s : arms)
        {
          const SegmentForces &f = end_forces(s);
          force[i.value] += network.start(s) == i ? f.start : f.end;
        }
      });
  return force;
}
} // namespace

const char *name_of(const ForceContribution c)
{
  constexpr std::array<const char *, n_force_contributions> names{"applied", "self",   "core",      "pairs",
                                                                  "rays",    "images", "correction"};
  return names[static_cast<std::size_t>(c)];
}

NodalForces no_forces(const Network &network)
{
  NodalForces forces;
  forces.total.resize(network.node_capacity(), Vec3::Zero());
  forces.segment_ends.resize(network.segment_capacity(), {Vec3::Zero(), Vec3::Zero()});
  return forces;
}

NodalForces compute_nodal_forces(const Network &network, const ForceSettings &settings,
                                 const ForceEnvironment &environment, MPI_Comm comm, const bool with_contributions)
{
  const bool with_multipoles = settings.summation.use_multipoles(network.n_segments());
  const LineSystem system(
      settings.medium, network, environment.shape, settings.ray_direction, environment.cell, environment.images,
      with_multipoles && environment.far_field ? ImageSources::set_by_user : ImageSources::set_at_once);
  std::optional<MultipoleForces> multipoles;
  if (with_multipoles)
  {
    fmm::MultipoleSettings accuracy{settings.summation.tolerance};
    accuracy.costs = environment.costs;
    if (environment.far_field)
      multipoles.emplace(system, accuracy, settings.pair_tolerance, comm, *environment.far_field, network,
                         environment.images);
    else
      multipoles.emplace(system, accuracy, settings.pair_tolerance, comm);
  }
  const LineShares shares = multipoles ? multipoles->shares() : equal_shares(system.lines().size(), comm);
  const auto contributions = [&](const std::size_t i)
  { return segment_contributions(system, i, settings, environment, multipoles ? &*multipoles : nullptr); };
  // All contributions are seven times as much to send.
  std::vector<Contributions> by_line;
  std::vector<SegmentForces> sums;
  if (with_contributions)
    by_line = on_all_lines(shares, comm, contributions);
  else
    sums = on_all_lines(shares, comm, [&](const std::size_t i) { return total_of(contributions(i)); });

  NodalForces forces = no_forces(network);
  std::vector<std::size_t> line_of(network.segment_capacity());
  std::size_t position = 0;
  for (const SegmentIndex s : network.segments())
  {
    line_of[s.value] = position;
    forces.segment_ends[s.value] = with_contributions ? total_of(by_line[position]) : sums[position];
    ++position;
  }
  forces.total = gather_at_nodes(
      network, [&](const SegmentIndex s) -> const SegmentForces & { return forces.segment_ends[s.value]; });
  if (with_contributions)
    for (std::size_t c = 0; c < n_force_contributions; ++c)
      forces.by_contribution[c] = gather_at_nodes(
          network, [&](const SegmentIndex s) -> const SegmentForces & { return by_line[line_of[s.value]][c]; });
  return forces;
}
} // namespace ddfem
