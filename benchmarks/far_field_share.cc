// Share of the far field in the forces, for trees of equal depth everywhere and for the depth by cost: the two cases of
// Durocher (thesis, Bordeaux 2018, figures IV.28 to IV.30).
//
//   far_field_share SIZE STEPS EVERY TOLERANCE PAIR_TOLERANCE RESULTS.csv
//
// The network moves STEPS steps; forces are computed at every EVERY-th, with all distant boxes (full) and without
// (cut-off). The file gets every measurement, standard output the medians.
#include "benchmarks/networks.h"
#include "benchmarks/processor_time.h"
#include "dd/crystal/material.h"
#include "dd/forces/multipole_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>
#include <optional>
#include <string>

namespace
{
using namespace ddfem;

constexpr const char *phase_names[] = {"tree",   "upward", "translations", "downward",
                                       "points", "images", "near",         "close"};
constexpr std::size_t n_phases = std::size(phase_names), first_far = 1, first_near = 6;

/// Processor times, s. Tree: with the memory of its expansions. Images: those beyond the neighbours of a periodic cell.
using Phases = std::array<double, n_phases>;

double sum(const Phases &p, const std::size_t begin = 0, const std::size_t end = n_phases)
{
  return std::accumulate(p.begin() + static_cast<long>(begin), p.begin() + static_cast<long>(end), 0.0);
}

double far(const Phases &p)
{
  return sum(p, first_far, first_near);
}

struct Case
{
  const char *name;
  IsotropicMedium medium;
  MovingNetwork moving;
  std::optional<PeriodicCell> cell;
  int shallowest; ///< level to compare: 3 for size 1
  int deepest;    ///< level whose boxes are at least twice as wide as the longest segments of the thesis, its limit
};

IsotropicMedium medium_of(const Material &m)
{
  return {m.mu, m.nu, m.burgers_magnitude};
}

int deepest_level(const double width, const double segment_length)
{
  return static_cast<int>(std::floor(std::log2(width / (2 * segment_length))));
}

int shallowest_level(const double t)
{
  return static_cast<int>(std::lround(3 + std::log2(t) / 3));
}

Case frank_read_case(const double t)
{
  Case c{"Frank-Read", medium_of(find_material("aluminium")), frank_read_sources(t), {}, shallowest_level(t), 0};
  c.cell = PeriodicCell{Vec3::Zero(), Vec3::Constant(c.moving.width)};
  c.deepest = deepest_level(c.moving.width, 7.5);
  return c;
}

Case loops_case(const double t)
{
  Case c{"loops", medium_of(find_material("zirconium")), small_loops(t), {}, shallowest_level(t), 0};
  c.deepest = deepest_level(c.moving.width, 5);
  return c;
}

struct Run
{
  Phases phases{};
  std::size_t levels = 0, boxes = 0, n_points = 0;
  std::vector<Vec3> forces; ///< on nodes, without those of the segments on themselves and of distant images, MPa nm^2
};

Run forces_of(const Case &c, const LineSystem &system, const fmm::MultipoleSettings &settings,
              const double pair_tolerance, const fmm::Part part)
{
  Run run;
  const double start = seconds();
  const MultipoleForces forces(system, settings, pair_tolerance, MPI_COMM_SELF, part);
  const double end = seconds();
  const fmm::MultipoleStress &s = forces.field().sum();
  const fmm::PhaseTimes &t = s.times();
  run.phases = {0, t.upward, t.translations, t.downward, t.points, 0, t.near, forces.spent().close_pairs};
  run.phases[0] = end - start - std::accumulate(run.phases.begin(), run.phases.end(), 0.0);
  run.levels = s.octree().levels().size() - 2;
  run.boxes = s.octree().boxes().size();
  run.n_points = s.octree().point_order().size();
  run.forces.assign(c.moving.displacement.size(), Vec3::Zero());
  std::size_t i = 0;
  for (const SegmentIndex k : c.moving.network.segments())
  {
    const Segment segment = c.moving.network[k];
    run.forces[segment.start.value] += forces(i).start;
    run.forces[segment.end.value] += forces(i++).end;
  }
  return run;
}

/// Time of the stress of distant images: their sources, and @p n_points points.
double seconds_of_images(const Case &c, PeriodicImages &images, const std::size_t n_points)
{
  const double start = seconds();
  const LineSystem system(c.medium, c.moving.network, nullptr, RayDirection::normal, &*c.cell, &images);
  const std::size_t n = system.lines().size();
  std::vector<SymTensor> stress(n_points);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < n_points; ++k)
  {
    const StraightLine &l = system.lines()[k * n / n_points];
    const Vec3 x = 0.5 * (l.start + l.end);
    stress[k] = images.far_stress(x + c.cell->shift_into_cell(x));
  }
  return seconds() - start;
}

double relative_difference(const std::vector<Vec3> &a, const std::vector<Vec3> &exact)
{
  double difference = 0, total = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    difference += (a[i] - exact[i]).squaredNorm();
    total += exact[i].squaredNorm();
  }
  return std::sqrt(difference / total);
}

double median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// All runs with one depth (0: by cost) and one mode.
struct Series
{
  std::vector<Phases> phases;
  std::vector<double> differences; ///< of the forces from those in full with the depth by cost
  std::size_t levels = 0, boxes = 0;

  template <class Quantity> double median_of(const Quantity &quantity) const
  {
    std::vector<double> values;
    for (const Phases &p : phases)
      values.push_back(quantity(p));
    return median(values);
  }
  double total() const
  {
    return median_of([](const Phases &p) { return sum(p); });
  }
};

/// By depth, then full and cut-off.
using Results = std::map<int, std::array<Series, 2>>;

void measure_step(const Case &c, PeriodicImages *images, const fmm::MultipoleSettings &settings,
                  const double pair_tolerance, Results &results)
{
  // Without the distant images, whose time is measured by itself.
  const LineSystem system(c.medium, c.moving.network, nullptr, RayDirection::normal, c.cell ? &*c.cell : nullptr,
                          nullptr);
  std::vector<Vec3> reference;
  double of_images = 0;
  for (int depth = 0; depth <= c.deepest; depth = std::max(depth + 1, c.shallowest))
    for (const std::size_t mode : {0, 1})
    {
      fmm::MultipoleSettings s = settings;
      s.depth = depth;
      Run run = forces_of(c, system, s, pair_tolerance, mode == 0 ? fmm::Part::all : fmm::Part::near);
      if (reference.empty())
      {
        reference = run.forces;
        of_images = images ? seconds_of_images(c, *images, run.n_points) : 0;
      }
      run.phases[first_near - 1] = mode == 0 ? of_images : 0;
      Series &series = results[depth][mode];
      series.phases.push_back(run.phases);
      series.differences.push_back(relative_difference(run.forces, reference));
      series.levels = run.levels;
      series.boxes = run.boxes;
    }
}

void write(std::FILE *file, const Case &c, const double size, const int step, const Results &results)
{
  for (const auto &[depth, modes] : results)
    for (const std::size_t mode : {0, 1})
    {
      const Series &s = modes[mode];
      std::fprintf(file, "%s,%g,%d,%d,%s,%zu,%zu", c.name, size, step, depth, mode == 0 ? "full" : "cut-off", s.levels,
                   c.moving.network.n_segments());
      for (const double t : s.phases.back())
        std::fprintf(file, ",%.6f", t);
      std::fprintf(file, ",%.3e\n", s.differences.back());
    }
  std::fflush(file);
}

void print(const Case &c, const Results &results)
{
  std::printf("%s, %zu segments; medians in s\n%6s %7s %6s %8s", c.name, c.moving.network.n_segments(), "depth", "",
              "levels", "boxes");
  for (const char *name : phase_names)
    std::printf(" %12s", name);
  std::printf(" %8s %9s %9s %10s\n", "total", "far share", "far/near", "difference");
  for (const auto &[depth, modes] : results)
    for (const std::size_t mode : {0, 1})
    {
      const Series &s = modes[mode];
      std::printf("%6s %7s %6zu %8zu", depth == 0 ? "cost" : std::to_string(depth).c_str(),
                  mode == 0 ? "full" : "cut-off", s.levels, s.boxes);
      for (std::size_t k = 0; k < n_phases; ++k)
        std::printf(" %12.4f", s.median_of([k](const Phases &p) { return p[k]; }));
      std::printf(" %8.3f %9.3f %9.2f %10.2e\n", s.total(),
                  s.median_of([](const Phases &p) { return far(p) / sum(p); }),
                  s.median_of([](const Phases &p) { return far(p) / sum(p, first_near); }), median(s.differences));
    }
  int best = 0;
  for (const auto &[depth, modes] : results)
    if (depth > 0 && (best == 0 || modes[0].total() < results.at(best)[0].total()))
      best = depth;
  std::printf("best depth by hand: %d; by cost against it: %.3f\n\n", best,
              results.at(0)[0].total() / results.at(best)[0].total());
}

void move(MovingNetwork &moving, const double n_steps)
{
  for (const NodeIndex i : moving.network.nodes())
    moving.network.set_position(i, moving.network.position(i) + n_steps * moving.displacement[i.value]);
}
} // namespace

int main(int argc, char **argv)
{
  if (argc != 7)
  {
    std::fprintf(stderr, "usage: %s SIZE STEPS EVERY TOLERANCE PAIR_TOLERANCE RESULTS.csv\n", argv[0]);
    return 2;
  }
  const double size = std::atof(argv[1]), pair_tolerance = std::atof(argv[5]);
  const int n_steps = std::atoi(argv[2]), every = std::max(1, std::atoi(argv[3]));
  fmm::MultipoleSettings settings;
  settings.tolerance = std::atof(argv[4]);
  std::FILE *const file = std::fopen(argv[6], "w");
  if (!file)
  {
    std::perror(argv[6]);
    return 1;
  }
  std::fprintf(file, "case,size,step,depth,mode,levels,segments");
  for (const char *name : phase_names)
    std::fprintf(file, ",%s", name);
  std::fprintf(file, ",difference\n");
  for (Case c : {frank_read_case(size), loops_case(size)})
  {
    std::optional<PeriodicImages> images;
    if (c.cell)
      images.emplace(c.cell->origin, c.cell->lengths);
    Results results;
    for (int step = every; step <= n_steps; step += every)
    {
      move(c.moving, every);
      measure_step(c, images ? &*images : nullptr, settings, pair_tolerance, results);
      write(file, c, size, step, results);
    }
    print(c, results);
  }
  std::fclose(file);
  return 0;
}
