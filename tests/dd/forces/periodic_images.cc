// Stress of periodic networks: closed-form near images plus interpolated far images.
#include "dd/forces/periodic_images.h"

#include "dd/elasticity/segment_stress.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
constexpr double pi = std::numbers::pi;
const IsotropicMedium medium{40e3, 0.31, 1e-3};
const Vec3 origin(-20.0, 35.0, 10.0), cell(90.0, 100.0, 120.0);

Vec3 at(double fx, double fy, double fz, const Vec3 &corner = origin)
{
  return corner + Vec3(fx, fy, fz).cwiseProduct(cell);
}

Vec3 random_point(std::mt19937 &generator, const Vec3 &edges = cell)
{
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  Vec3 x;
  for (int c = 0; c < 3; ++c)
    x[c] = origin[c] + fraction(generator) * edges[c];
  return x;
}

// A rectangle with the half edges u, v that circles u x v right-handedly.
struct Rectangle
{
  Vec3 centre, u, v, burgers;

  std::vector<LineElement> elements() const
  {
    const Vec3 corners[] = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    std::vector<LineElement> sides;
    for (std::size_t i = 0; i < 4; ++i)
      for (int part = 0; part < 3; ++part)
      {
        const Vec3 step = (corners[(i + 1) % 4] - corners[i]) / 3;
        sides.push_back({corners[i] + part * step, corners[i] + (part + 1) * step, burgers});
      }
    return sides;
  }
};

const Rectangle loop{at(0.47, 0.52, 0.45), 14.0 * Vec3(0.6, 0.0, 0.8), 11.0 * Vec3(0.64, 0.6, -0.48),
                     Vec3(0.21, -0.13, 0.08)};

std::vector<LineElement> open_network(std::size_t n, const Vec3 &edges = cell)
{
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::vector<LineElement> elements;
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec3 middle = random_point(generator, edges);
    const Vec3 half = 0.03 * edges.minCoeff() * Vec3(normal(generator), normal(generator), normal(generator));
    elements.push_back(
        {middle - half, middle + half, 0.25 * Vec3(normal(generator), normal(generator), normal(generator))});
  }
  return elements;
}

std::vector<LineElement> wrapped(std::vector<LineElement> elements, const Vec3 &corner)
{
  for (LineElement &e : elements)
    for (int c = 0; c < 3; ++c)
    {
      const double shift = cell[c] * std::floor((0.5 * (e.start[c] + e.end[c]) - corner[c]) / cell[c]);
      e.start[c] -= shift;
      e.end[c] -= shift;
    }
  return elements;
}

SymTensor near_stress(const PeriodicImages &images, const std::vector<LineElement> &elements, const Vec3 &x)
{
  SymTensor sum = SymTensor::Zero();
  for (const Vec3 &shift : images.near_shifts())
    for (const LineElement &e : elements)
      sum += segment_stress(medium, x, e.start + shift, e.end + shift, e.burgers);
  return sum;
}

SymTensor total_stress(const PeriodicImages &images, const std::vector<LineElement> &elements, const Vec3 &x)
{
  return near_stress(images, elements, x) + images.far_stress(x);
}

// Root mean square (over points and components) of the far stress in the cell.
double far_rms(const PeriodicImages &images, const Vec3 &edges = cell)
{
  std::mt19937 generator(11);
  double squares = 0;
  for (int i = 0; i < 200; ++i)
    squares += images.far_stress(random_point(generator, edges)).squaredNorm() / (200 * 6);
  return std::sqrt(squares);
}

// Stress of the periodic array of a rectangular loop as an eigenstrain problem: Fourier series over k != 0 of
// sigma = C:(epsilon - epsilon*), epsilon* = -sym(b (x) n) delta(S) (FS/RH). The factor (1 + q) exp(-q), q = k^2 /
// (4 alpha^2), leaves the stress unchanged at distances R >> 1/alpha from the line (it turns |x| into the Ewald function
// that equals R there).
SymTensor fourier_stress(const Rectangle &source, const Vec3 &x, double alpha)
{
  const double lambda = 2 * medium.mu * medium.nu / (1 - 2 * medium.nu), mu = medium.mu;
  const Mat3 eigenstrain = -0.5 * (source.burgers * source.u.cross(source.v).transpose() +
                                   source.u.cross(source.v) * source.burgers.transpose());
  const Mat3 tau = lambda * eigenstrain.trace() * Mat3::Identity() + 2 * mu * eigenstrain;
  const auto sinc = [](double t) { return std::abs(t) < 1e-8 ? 1.0 : std::sin(t) / t; };
  const Vec3 limit = 2 * alpha * std::sqrt(36.0) / (2 * pi) * cell;
  Mat3 sum = Mat3::Zero();
  for (int nx = -int(limit[0]); nx <= int(limit[0]); ++nx)
    for (int ny = -int(limit[1]); ny <= int(limit[1]); ++ny)
      for (int nz = -int(limit[2]); nz <= int(limit[2]); ++nz)
      {
        const Vec3 k = 2 * pi * Vec3(nx, ny, nz).cwiseQuotient(cell);
        const double k2 = k.squaredNorm(), q = k2 / (4 * alpha * alpha);
        if ((nx == 0 && ny == 0 && nz == 0) || q > 36)
          continue;
        const Vec3 f = tau * k;
        const Vec3 v = (f - (lambda + mu) / (lambda + 2 * mu) * k.dot(f) / k2 * k) / (mu * k2);
        const Mat3 stress = lambda * k.dot(v) * Mat3::Identity() + mu * (k * v.transpose() + v * k.transpose()) - tau;
        sum += (1 + q) * std::exp(-q) * std::cos(k.dot(x - source.centre)) * 4 * sinc(k.dot(source.u)) *
               sinc(k.dot(source.v)) / cell.prod() * stress;
      }
  return symmetric_part(sum);
}

// Far stress without interpolation, from the tensor formula of Cai et al. (2006).
SymTensor direct_far_stress(const PeriodicKernel &kernel, const std::vector<LineElement> &elements, const Vec3 &x)
{
  const auto eps = [](int i, int j, int k) { return 0.5 * (i - j) * (j - k) * (k - i); };
  // Of d_ijk in ThirdDerivatives: they are ordered by the number of indices other than x, then of z.
  const auto position = [](int i, int j, int k)
  {
    const int y = (i == 1) + (j == 1) + (k == 1), z = (i == 2) + (j == 2) + (k == 2), r = y + z;
    return static_cast<std::size_t>(r * (r + 1) / 2 + z);
  };
  const double points[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)}, weights[] = {5. / 18, 8. / 18, 5. / 18};
  Mat3 sum = Mat3::Zero();
  for (const LineElement &e : elements)
    for (int g = 0; g < 3; ++g)
    {
      const ThirdDerivatives d = kernel(x - e.start - points[g] * (e.end - e.start));
      const auto third = [&](int i, int j, int k) { return d[position(i, j, k)]; };
      const auto laplacian = [&](int i) { return third(i, 0, 0) + third(i, 1, 1) + third(i, 2, 2); };
      const Mat3 a = weights[g] * e.burgers * (e.end - e.start).transpose();
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q)
          for (int i = 0; i < 3; ++i)
            for (int m = 0; m < 3; ++m)
            {
              sum(p, q) += medium.mu / (8 * pi) * laplacian(i) * (eps(i, m, p) * a(m, q) + eps(i, m, q) * a(m, p));
              for (int l = 0; l < 3; ++l)
                sum(p, q) += medium.mu / (4 * pi * (1 - medium.nu)) * eps(i, m, l) * a(m, l) *
                             (third(i, p, q) - (p == q ? laplacian(i) : 0.0));
            }
    }
  return symmetric_part(sum);
}

// Rms error of the interpolation over random points, relative to the rms of the far stress.
double interpolation_error(const Vec3 &edges, unsigned order)
{
  const std::vector<LineElement> elements = open_network(20, edges);
  PeriodicImages images(origin, edges, order);
  images.set_sources(medium, elements);
  const PeriodicKernel kernel(edges);
  std::mt19937 generator(5);
  double error = 0, size = 0;
  for (int i = 0; i < 60; ++i)
  {
    const Vec3 x = random_point(generator, edges);
    const SymTensor exact = direct_far_stress(kernel, elements, x);
    error += (images.far_stress(x) - exact).squaredNorm();
    size += exact.squaredNorm();
  }
  return std::sqrt(error / size);
}

TEST(PeriodicImages, LoopArrayHasTheStressOfTheFourierSeries)
{
  const std::vector<LineElement> elements = loop.elements();
  const std::vector<Vec3> points{at(0.02, 0.1, 0.9), at(0.97, 0.55, 0.02), at(0.5, 0.02, 0.99), at(0.05, 0.95, 0.5),
                                 at(0.45, 0.97, 0.6)};
  for (const auto &[order, tolerance] : {std::pair{7u, 1e-3}, std::pair{9u, 1e-4}})
  {
    PeriodicImages images(origin, cell, order);
    images.set_sources(medium, elements);
    const double scale = far_rms(images);
    double worst = 0;
    for (const Vec3 &x : points)
      worst =
          std::max(worst, (total_stress(images, elements, x) - fourier_stress(loop, x, 0.17)).cwiseAbs().maxCoeff());
    EXPECT_LT(worst / scale, tolerance) << "order " << order;
    RecordProperty("order " + std::to_string(order), std::to_string(worst / scale));
  }
}

TEST(PeriodicImages, OppositeFacesCarryTheSameStress)
{
  const std::vector<LineElement> elements = open_network(10);
  PeriodicImages images(origin, cell, 9);
  images.set_sources(medium, elements);
  const double scale = far_rms(images);
  std::mt19937 generator(1);
  for (int i = 0; i < 30; ++i)
  {
    Vec3 lower = random_point(generator);
    lower[i % 3] = origin[i % 3];
    const Vec3 upper = lower + cell[i % 3] * Vec3::Unit(i % 3);
    const SymTensor jump = total_stress(images, elements, upper) - total_stress(images, elements, lower);
    EXPECT_LT(jump.cwiseAbs().maxCoeff() / scale, 3e-4) << lower.transpose();
  }
}

TEST(PeriodicImages, WhereTheCellIsCutOutOfTheLatticeDoesNotMatter)
{
  const std::vector<LineElement> elements = open_network(10);
  const Vec3 other_origin = at(0.37, -0.58, 0.21);
  const std::vector<LineElement> other_elements = wrapped(elements, other_origin);
  PeriodicImages images(origin, cell, 9), other(other_origin, cell, 9);
  images.set_sources(medium, elements);
  other.set_sources(medium, other_elements);
  const double scale = far_rms(images);
  std::mt19937 generator(2);
  for (int i = 0; i < 20; ++i)
  {
    const Vec3 x = random_point(generator);
    Vec3 y = x;
    for (int c = 0; c < 3; ++c)
      y[c] -= cell[c] * std::floor((x[c] - other_origin[c]) / cell[c]);
    const SymTensor change = total_stress(other, other_elements, y) - total_stress(images, elements, x);
    EXPECT_LT(change.cwiseAbs().maxCoeff() / scale, 3e-4) << x.transpose();
  }
}

// Periodic and in equilibrium: the mean of sigma n over the cell is its mean over any plane of normal n, and in a plane
// that stays away from the line the trapezoidal rule converges exponentially.
TEST(PeriodicImages, CellMeanOfTheStressIsZero)
{
  const std::vector<LineElement> elements = loop.elements();
  PeriodicImages images(origin, cell, 9);
  images.set_sources(medium, elements);
  const double scale = far_rms(images);
  const int n = 24;
  for (int normal = 0; normal < 3; ++normal)
  {
    Vec3 mean = Vec3::Zero(), near_mean = Vec3::Zero();
    for (int i = 0; i < n * n; ++i)
    {
      Vec3 x = origin;
      x[(normal + 1) % 3] += cell[(normal + 1) % 3] * (i % n + 0.5) / n;
      x[(normal + 2) % 3] += cell[(normal + 2) % 3] * (i / n + 0.5) / n;
      near_mean += contract(near_stress(images, elements, x), Vec3::Unit(normal)) / (n * n);
      mean += contract(total_stress(images, elements, x), Vec3::Unit(normal)) / (n * n);
    }
    EXPECT_LT(mean.norm() / scale, 1e-4) << "normal " << normal;
    EXPECT_GT(near_mean.norm() / scale, 0.1) << "the near images alone should not pass";
  }
}

// Rows of screws of spacing Lx along x have the stress mu b/(2 Lx) (-sinh, sin)/(cosh - cos) of 2 pi (x, y)/Lx (Hirth &
// Lothe, chapter 19); the rows of both signs are summed symmetrically and the mean, mu b (y2 - y1)/(Lx Ly), is removed.
SymTensor screw_dipole_array(const Vec3 &x, const Vec3 &positive, const Vec3 &negative, double b)
{
  SymTensor stress = SymTensor::Zero();
  const double factor = medium.mu * b / (2 * cell[0]);
  for (int row = -12; row <= 12; ++row)
    for (const auto &[position, sign] : {std::pair{positive, 1.0}, std::pair{negative, -1.0}})
    {
      const double u = 2 * pi * (x[0] - position[0]) / cell[0];
      const double v = 2 * pi * (x[1] - position[1] - row * cell[1]) / cell[0];
      stress[4] -= sign * factor * std::sinh(v) / (std::cosh(v) - std::cos(u));
      stress[5] += sign * factor * std::sin(u) / (std::cosh(v) - std::cos(u));
    }
  stress[4] += medium.mu * b * (negative[1] - positive[1]) / (cell[0] * cell[1]);
  return stress;
}

TEST(PeriodicImages, InfiniteScrewDipoleHasTheStressOfTheTwoDimensionalArray)
{
  const Vec3 positive = at(0.3, 0.2, 0), negative = at(0.65, 0.6, 0);
  const int pieces = 10;
  std::vector<LineElement> elements;
  for (int i = 0; i < pieces; ++i)
  {
    const Vec3 from = cell[2] * i / pieces * Vec3::UnitZ(), to = cell[2] * (i + 1) / pieces * Vec3::UnitZ();
    elements.push_back({positive + from, positive + to, Vec3(0, 0, 0.25)});
    elements.push_back({negative + from, negative + to, Vec3(0, 0, -0.25)});
  }
  for (const auto &[order, tolerance] : {std::pair{7u, 1e-3}, std::pair{9u, 1e-4}})
  {
    PeriodicImages images(origin, cell, order);
    images.set_sources(medium, elements);
    const double scale = far_rms(images);
    std::mt19937 generator(4);
    for (int i = 0; i < 30; ++i)
    {
      const Vec3 x = random_point(generator);
      if (std::min((x - positive).head<2>().norm(), (x - negative).head<2>().norm()) < 5)
        continue;
      const SymTensor error = total_stress(images, elements, x) - screw_dipole_array(x, positive, negative, 0.25);
      EXPECT_LT(error.cwiseAbs().maxCoeff() / scale, tolerance) << "order " << order << " at " << x.transpose();
    }
  }
}

TEST(PeriodicImages, InterpolationErrorFallsWithTheOrder)
{
  double previous = 1;
  for (unsigned order = 3; order <= 10; ++order)
  {
    const double error = interpolation_error(Vec3::Constant(100.0), order);
    RecordProperty("order " + std::to_string(order), std::to_string(error));
    EXPECT_LT(error, previous / 2) << "order " << order;
    previous = error;
  }
  EXPECT_LT(interpolation_error(Vec3::Constant(100.0), 7), 8e-4);
  EXPECT_LT(previous, 1e-5);
}

TEST(PeriodicImages, ElongatedAndFlatCellsAreAsAccurateAsCubes)
{
  EXPECT_LT(interpolation_error(Vec3(100, 100, 250), 7), 8e-4);
  EXPECT_LT(interpolation_error(Vec3(80, 160, 200), 7), 8e-4);
}

TEST(PeriodicImages, StressIsBitwiseTheSameOnAnyNumberOfThreads)
{
  const std::vector<LineElement> elements = open_network(1000);
  const int threads = omp_get_max_threads();
  std::vector<SymTensor> values[2];
  for (int run = 0; run < 2; ++run)
  {
    omp_set_num_threads(run + 1);
    PeriodicImages images(origin, cell, 6);
    images.set_sources(medium, elements);
    std::mt19937 generator(9);
    for (int i = 0; i < 20; ++i)
      values[run].push_back(images.far_stress(random_point(generator)));
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(values[0], values[1]);
}

TEST(PeriodicImages, SourcesAreReplacedNotAccumulated)
{
  PeriodicImages images(origin, cell, 5);
  const Vec3 x = at(0.1, 0.8, 0.3);
  EXPECT_EQ(images.far_stress(x), SymTensor::Zero());
  images.set_sources(medium, loop.elements());
  const SymTensor first = images.far_stress(x);
  images.set_sources(medium, open_network(10));
  EXPECT_NE(images.far_stress(x), first);
  images.set_sources(medium, loop.elements());
  EXPECT_EQ(images.far_stress(x), first);
  images.set_sources(medium, {});
  EXPECT_EQ(images.far_stress(x), SymTensor::Zero());
}

TEST(PeriodicImages, LinesThatLeaveTheCellAreMeasured)
{
  PeriodicImages images(origin, cell, 4);
  images.set_sources(medium, loop.elements());
  EXPECT_EQ(images.source_overhang(), 0.0);
  const std::vector<LineElement> sticking_out{{at(0.5, 0.5, 0.9), at(0.5, 0.5, 1.07), Vec3::UnitX()}};
  images.set_sources(medium, sticking_out);
  EXPECT_NEAR(images.source_overhang(), 0.07, 1e-12);
}

TEST(PeriodicImages, RefusesImpossibleArguments)
{
  EXPECT_THROW(PeriodicImages(origin, Vec3(1, 1, 0)), std::invalid_argument);
  EXPECT_THROW(PeriodicImages(origin, cell, 1), std::invalid_argument);
  EXPECT_THROW(PeriodicImages(origin, cell, 33), std::invalid_argument);
  EXPECT_THROW(PeriodicImages(origin, cell, 7, 0.5), std::invalid_argument);
}
} // namespace
} // namespace ddfem
