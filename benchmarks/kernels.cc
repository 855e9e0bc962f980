// The vectorised kernels of dd/elasticity against the scalar reference, in one run and on one core.
//
//   ddfem_kernel_benchmark
//
// For each instruction set that the machine has: time, ratio to the scalar reference, and, where operations can be counted,
// the share of the peak that an FMA loop reaches.
#include "benchmarks/counted.h"
#include "benchmarks/fma_peak.h"
#include "dd/elasticity/half_space_image.h"
#include "dd/elasticity/line_stress-inl.h"
#include "dd/elasticity/segment_force.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "dd/elasticity/vectorised/force_kernels.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/elasticity/vectorised/targets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace
{
using namespace ddfem;
using ddfem::benchmarks::Counted;

const IsotropicMedium copper{48'300.0, 0.34, 0.5};

double uniform(std::mt19937 &random, const double low, const double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 in_cube(std::mt19937 &random, const double edge)
{
  return {uniform(random, 0, edge), uniform(random, 0, edge), uniform(random, 0, edge)};
}

Vec3 on_sphere(std::mt19937 &random)
{
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

/// Least processor time of several runs, s.
double time_of(const std::function<void()> &run)
{
  double best = std::numeric_limits<double>::infinity(), spent = 0;
  while (spent < 0.4)
  {
    const std::clock_t start = std::clock();
    run();
    const double t = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    best = std::min(best, t);
    spent += t;
  }
  return best;
}

struct Kernel
{
  std::string name, unit;
  double n;     ///< evaluations of one run
  double flops; ///< per evaluation; 0: not counted
  bool as_rate; ///< millions per second instead of nanoseconds
  std::function<void()> reference, vectorised;
};

/// @p peaks: of the targets; the first row is the scalar reference.
void report(const Kernel &k, const std::vector<std::string> &targets, const std::vector<double> &peaks)
{
  const auto value = [&](const double time) { return k.as_rate ? k.n / time * 1e-6 : time / k.n * 1e9; };
  const double reference = time_of(k.reference);
  std::printf("%-44s %-10s %9.1f %s\n", k.name.c_str(), "reference", value(reference), k.unit.c_str());
  for (std::size_t t = 0; t < targets.size(); ++t)
  {
    use_kernel_target(targets[t]);
    const double time = time_of(k.vectorised);
    std::printf("%-44s %-10s %9.1f %s   x %.1f", "", targets[t].c_str(), value(time), k.unit.c_str(), reference / time);
    if (k.flops > 0)
      std::printf("   %.0f %% of the peak", 100 * k.flops * k.n / time / peaks[t]);
    std::printf("\n");
  }
  use_kernel_target("");
}

struct Segment
{
  Vec3 start, end, burgers;
};

LineTable table_of(const std::vector<Segment> &segments)
{
  LineTable table;
  for (const Segment &s : segments)
    table.add_segment(s.start, s.end, s.burgers);
  return table;
}

/// Segments of @p length in a cube, in random directions or all in one.
std::vector<Segment> random_segments(const std::size_t n, const double edge, const double length,
                                     const bool parallel = false)
{
  std::mt19937 random(1);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec3 x = in_cube(random, edge);
    const Vec3 direction = parallel ? Vec3(0.6, 0, 0.8) : on_sphere(random);
    segments.push_back({x, x + length * direction, 0.25 * on_sphere(random)});
  }
  return segments;
}

/// Lines of segments of @p length that bow, so that neighbours are connected and nearly parallel, as in a network.
std::vector<Segment> random_lines(const std::size_t n_lines, const std::size_t n_each, const double edge,
                                  const double length)
{
  std::mt19937 random(2);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < n_lines; ++i)
  {
    Vec3 x = in_cube(random, edge), t = on_sphere(random);
    const Vec3 turn = 0.1 * on_sphere(random), b = 0.25 * on_sphere(random);
    for (std::size_t k = 0; k < n_each; ++k)
    {
      segments.push_back({x, x + length * t, b});
      x += length * t;
      t = (t + turn.cross(t)).normalized();
    }
  }
  return segments;
}

long flops_of_stress(const bool of_ray)
{
  namespace formulas = HWY_NAMESPACE;
  LineTable table;
  table.add_segment({0, 0, 0}, {3, 4, 5}, {0.1, 0.2, 0.3});
  const auto line = formulas::line_of<Counted>(table, 0);
  const formulas::StressConstants<Counted> constants(copper);
  const auto x = formulas::vector_of<Counted>({7, 1, 2});
  formulas::StressSum<Counted> sum{};
  Counted::n = 0;
  sum.add(of_ray ? formulas::ray_stress_terms(constants, line, x) : formulas::segment_stress_terms(constants, line, x),
          line.t);
  return Counted::n;
}

Kernel stress_kernel(const bool of_rays)
{
  constexpr std::size_t n_points = 1024, n_segments = 512;
  static StressBuffer buffer(n_points);
  static std::vector<Vec3> points;
  static SymTensor sink;
  std::mt19937 random(4);
  points.clear();
  for (std::size_t i = 0; i < n_points; ++i)
  {
    points.push_back(in_cube(random, 1000));
    buffer.set_point(i, points.back());
  }
  const std::vector<Segment> segments = random_segments(n_segments, 1000, 30);
  LineTable table = table_of(segments), rays;
  for (const Segment &s : segments)
    rays.add_ray(s.start, (s.end - s.start).normalized(), s.burgers);
  Kernel k{of_rays ? "stress of rays at points" : "stress of segments at points",
           "M/s",
           static_cast<double>(n_points * n_segments),
           static_cast<double>(flops_of_stress(of_rays)),
           true,
           {},
           {}};
  k.reference = [segments, of_rays]
  {
    SymTensor sum = SymTensor::Zero();
    for (const Segment &s : segments)
    {
      const SegmentStressField segment(copper, s.start, s.end, s.burgers);
      const RayStressField ray(copper, s.start, (s.end - s.start).normalized(), s.burgers);
      for (const Vec3 &x : points)
        sum += of_rays ? ray(x) : segment(x);
    }
    sink += sum;
  };
  k.vectorised = [table, rays, of_rays]
  {
    if (of_rays)
      add_ray_stress(copper, rays, buffer.batch());
    else
      add_segment_stress(copper, table, buffer.batch());
  };
  return k;
}

/// The same for points that are not near: in double or in single precision.
Kernel distant_stress_kernel(const bool single_precision)
{
  Kernel k = stress_kernel(false);
  k.name = single_precision ? "stress of distant segments, single precision" : "stress of distant segments";
  k.flops = 0;
  StressBuffer points(1024);
  std::mt19937 random(4);
  for (std::size_t i = 0; i < 1024; ++i)
    points.set_point(i, in_cube(random, 1000));
  const LineTable table = table_of(random_segments(512, 1000, 30));
  std::vector<unsigned> all(table.size());
  std::iota(all.begin(), all.end(), 0U);
  k.vectorised = [table, all, points, single_precision]() mutable
  {
    if (single_precision)
      add_single_precision_stress(copper, table, all, Vec3::Constant(500), 1000, points.batch());
    else
      add_distant_segment_stress(copper, table, all, points.batch());
  };
  return k;
}

/// All four nodal forces of all pairs, with the default tolerance of a run.
Kernel force_kernel(const std::string &name, const std::vector<Segment> &segments)
{
  constexpr double tolerance = 1e-5;
  static Vec3 sink = Vec3::Zero();
  const auto n = static_cast<double>(segments.size());
  Kernel k{name, "ns per unordered pair", 0.5 * n * (n - 1), 0.0, false, {}, {}};
  k.reference = [segments]
  {
    for (std::size_t i = 0; i < segments.size(); ++i)
      for (std::size_t j = 0; j < segments.size(); ++j)
        if (i != j)
        {
          const Segment &s = segments[i], &source = segments[j];
          sink +=
              segment_force(copper, source.start, source.end, source.burgers, s.start, s.end, s.burgers, tolerance).end;
        }
  };
  k.vectorised = [segments, table = table_of(segments)]
  {
    for (std::size_t i = 0; i < segments.size(); ++i)
    {
      const Segment &s = segments[i];
      sink += force_of_segments(copper, table, s.start, s.end, s.burgers, tolerance, i).end;
    }
  };
  return k;
}

Kernel displacement_kernel(const bool with_rays)
{
  std::mt19937 random(5);
  std::vector<TriangularLoop> loops;
  std::vector<Vec3> points;
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 x = in_cube(random, 1000);
    loops.emplace_back(LoopVertex::at(x), LoopVertex::at(x + 10 * on_sphere(random)),
                       with_rays ? LoopVertex::towards(on_sphere(random)) : LoopVertex::at(x + 30 * on_sphere(random)),
                       0.25 * on_sphere(random));
  }
  for (int i = 0; i < 512; ++i)
    points.push_back(in_cube(random, 1000));
  static Vec3 sink = Vec3::Zero();
  Kernel k{with_rays ? "displacement of half-strips at points" : "displacement of triangles at points",
           "M/s",
           static_cast<double>(loops.size() * points.size()),
           0.0,
           true,
           {},
           {}};
  k.reference = [loops, points]
  {
    for (const TriangularLoop &l : loops)
      for (const Vec3 &x : points)
        sink += triangle_displacement(copper.nu, x, l.vertices[0], l.vertices[1], l.vertices[2], l.burgers);
  };
  k.vectorised = [loops, points] { sink += triangle_displacements(copper.nu, loops, points).front(); };
  return k;
}

/// Images of segments within 200 nm of the surface at points of the same range, with the default tolerance.
Kernel image_kernel(const bool displacement)
{
  std::mt19937 random(6);
  std::vector<SegmentImage> images;
  std::vector<Vec3> points;
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 x = in_cube(random, 1000).cwiseProduct(Vec3(1, 1, 0.2)), t = on_sphere(random);
    images.emplace_back(copper, x, x + 30 * Vec3(t[0], t[1], std::abs(t[2])), 0.25 * on_sphere(random), 1e-6);
  }
  for (int i = 0; i < 256; ++i)
    points.push_back(in_cube(random, 1000).cwiseProduct(Vec3(1, 1, 0.2)));
  static SymTensor sink = SymTensor::Zero();
  static Vec3 sink_of_displacement = Vec3::Zero();
  Kernel k{displacement ? "displacement of images at points" : "stress of images at points",
           "ns per image and point",
           static_cast<double>(images.size() * points.size()),
           0.0,
           false,
           {},
           {}};
  k.reference = [=]
  {
    for (const SegmentImage &image : images)
      for (const Vec3 &x : points)
        if (displacement)
          sink_of_displacement += image.displacement(x);
        else
          sink += image.stress(x);
  };
  k.vectorised = [=]
  {
    StressBuffer of_stress(points.size());
    DisplacementBuffer of_displacement(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      of_stress.set_point(i, points[i]);
      of_displacement.set_point(i, points[i]);
    }
    for (const SegmentImage &image : images)
      if (displacement)
        image.add_displacement(of_displacement.batch());
      else
        image.add_stress(of_stress.batch());
  };
  return k;
}
} // namespace

int main()
{
  const std::vector<std::string> targets = kernel_targets();
  std::vector<double> peaks;
  for (const std::string &t : targets)
  {
    use_kernel_target(t);
    peaks.push_back(benchmarks::peak_flops());
    std::printf("peak of one core by an FMA loop, %-8s %6.1f GF/s\n", t.c_str(), peaks.back() * 1e-9);
  }
  std::printf("operations of a stress: segment %ld, ray %ld\n", flops_of_stress(false), flops_of_stress(true));
  report(stress_kernel(false), targets, peaks);
  report(distant_stress_kernel(false), targets, peaks);
  report(distant_stress_kernel(true), targets, peaks);
  report(stress_kernel(true), targets, peaks);
  report(force_kernel("forces, 1000 random segments in 1 um", random_segments(1000, 1000, 30)), targets, peaks);
  report(force_kernel("forces, 20 bowed lines of 50 segments", random_lines(20, 50, 1000, 30)), targets, peaks);
  report(force_kernel("forces, 400 parallel segments, 5 lengths", random_segments(400, 150, 30, true)), targets, peaks);
  report(force_kernel("forces, 400 random segments, 5 lengths", random_segments(400, 150, 30)), targets, peaks);
  report(force_kernel("forces, 60 random segments, 1 length", random_segments(60, 30, 30)), targets, peaks);
  report(displacement_kernel(false), targets, peaks);
  report(displacement_kernel(true), targets, peaks);
  report(image_kernel(false), targets, peaks);
  report(image_kernel(true), targets, peaks);
  return 0;
}
