// The operators of the fast multipole method, one by one, against closed forms.
#include "dd/fmm/accuracy.h"
#include "dd/fmm/octree.h"
#include "dd/fmm/translation.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace ddfem::fmm
{
namespace
{
using test::copper_like;
using test::RandomVectors;

/// Coefficients of one box: fields and Q.
struct Coefficients
{
  RowBuffer fields;
  std::vector<double> q;

  explicit Coefficients(int order) : fields(n_harmonics(order)), q(n_harmonics(order), 0.0) {}
  ExpansionView view() { return {fields.rows(), q.data()}; }

  /// Translated by @p vector boxes, with boxes of the given size.
  Coefficients translated(const Shift kind, const int order, const Vec3 &vector, const double size,
                          const double reference_sign) const
  {
    Coefficients result(order);
    const Translation t(kind, order, vector);
    t.add(fields.rows(), result.fields.rows());
    RowBuffer in(q.size()), out(q.size());
    move_reference_point<double>(q.size(), reference_sign * size * vector, fields.rows(), q.data(),
                                 [&](const std::size_t k, const double moved) { in(k, 0) = moved; });
    t.add(in.rows(), out.rows());
    for (std::size_t k = 0; k < q.size(); ++k)
      result.q[k] = out(k, 0);
    return result;
  }
};

const Vec3 origin(100, 50, 20);
constexpr double box_size = 10;

/// Open pieces of line in the box around @p centre: their stress is not in equilibrium, which the expansions must not need.
std::vector<LineSource> lines_in_box(const Vec3 &centre, const double size)
{
  RandomVectors random(1);
  std::vector<LineSource> lines;
  for (int k = 0; k < 30; ++k)
  {
    const Vec3 x = centre + 0.5 * size * random.vector(), d = 0.1 * size * random.vector();
    lines.push_back({x - d, x + d, random.vector()});
  }
  return lines;
}

using Field = std::function<SymTensor(const Vec3 &)>;

Field field_of(const IsotropicMedium &medium, const std::vector<LineSource> &lines)
{
  return [=](const Vec3 &x)
  {
    SymTensor sum = SymTensor::Zero();
    for (const LineSource &l : lines)
      sum += segment_stress(medium, x, l.start, l.end, l.burgers);
    return sum;
  };
}

Field field_of(const LocalStress &local)
{
  return [=](const Vec3 &x)
  {
    SymTensor s = SymTensor::Zero();
    StressBatch batch{1, {&x[0], &x[1], &x[2]}, {}};
    for (int c = 0; c < 6; ++c)
      batch.value[c] = &s[c];
    local.add(batch);
    return s;
  };
}

/// Root mean square difference over a box, relative to the rms of @p exact.
double error_in_box(const Field &field, const Field &exact, const Vec3 &centre, const double size)
{
  RandomVectors random(2);
  double difference = 0, sum = 0;
  for (int k = 0; k < 50; ++k)
  {
    const Vec3 x = centre + 0.5 * size * random.vector();
    difference += (field(x) - exact(x)).squaredNorm();
    sum += exact(x).squaredNorm();
  }
  return std::sqrt(difference / sum);
}

LocalStress far_stress(const IsotropicMedium &medium, const std::vector<LineSource> &lines, const int order,
                       const Vec3 &offset)
{
  Coefficients moments(order);
  add_moments(order, 1e-14, origin, box_size, lines, moments.view());
  Coefficients local = moments.translated(Shift::far, order, offset, box_size, 1);
  return {medium, order, origin + box_size * offset, box_size, local.fields.rows(), local.q.data()};
}

TEST(SolidHarmonics, SumToTheLegendrePolynomial)
{
  RandomVectors random(1);
  constexpr int order = 12;
  const Vec3 u = random.vector().normalized(), v = random.vector().normalized();
  const Row points[3] = {Row{u[0], v[0]}, Row{u[1], v[1]}, Row{u[2], v[2]}};
  RowBuffer s(n_harmonics(order));
  regular_harmonics(order, points, s.rows());
  for (int l = 0; l <= order; ++l)
  {
    double sum = 0;
    for (int m = -l; m <= l; ++m)
      sum += s(harmonic_index(l, m), 0) * s(harmonic_index(l, m), 1);
    EXPECT_NEAR(sum, std::legendre(static_cast<unsigned>(l), u.dot(v)), 1e-13) << l;
  }
}

TEST(SolidHarmonics, GradientIsThatOfDifferences)
{
  constexpr int order = 8;
  constexpr double h = 1e-3; // central differences: h^2/6 times third derivatives of up to 8*7*6
  const Vec3 x(0.3, -0.5, 0.7);
  const auto terms = gradient_terms(order);
  const std::size_t n = n_harmonics(order);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    Row points[3];
    for (int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < 3; ++i) // lanes: x - h, x + h, x
        points[c][i] =
            x[c] + (static_cast<std::size_t>(c) == axis ? h * (i == 2 ? 0.0 : 2.0 * static_cast<double>(i) - 1) : 0);
    RowBuffer s(n);
    regular_harmonics(order, points, s.rows());
    std::vector<double> gradient(n, 0.0);
    for (const GradientTerm &t : terms[axis])
      gradient[t.from] += t.factor * s(t.to, 2);
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_NEAR(gradient[k], (s(k, 1) - s(k, 0)) / (2 * h), 1e-4) << axis << ' ' << k;
  }
}

TEST(Expansions, OfOpenPiecesOfLineConvergeGeometricallyWithTheOrder)
{
  // The contents of touching corners are at 0.87/(2 - 0.87) of convergence's limit in the worst case; the rms error falls
  // by about 0.53 per order.
  const auto lines = lines_in_box(origin, box_size);
  const IsotropicMedium medium{50e3, 0.3, 1e-6};
  for (const Vec3 &offset : {Vec3(2, 0, 0), Vec3(2, -1, 1), Vec3(0, 0, -2), Vec3(-3, 3, 2)})
  {
    const Field exact = field_of(medium, lines);
    double error[3];
    for (int k = 0; k < 3; ++k)
      error[k] = error_in_box(field_of(far_stress(medium, lines, 6 + 8 * k, offset)), exact, origin + box_size * offset,
                              box_size);
    EXPECT_LT(error[0], 0.04) << offset.transpose();
    EXPECT_LT(error[1], 0.02 * error[0]) << offset.transpose();
    EXPECT_LT(error[2], 0.02 * error[1]) << offset.transpose();
  }
}

TEST(Expansions, OrderAtADistanceKeepsTheError)
{
  const auto lines = lines_in_box(origin, box_size);
  const IsotropicMedium medium{50e3, 0.3, 1e-6};
  const Field exact = field_of(medium, lines);
  const auto absolute_error = [&](const Vec3 &offset, const int order)
  {
    const Field field = field_of(far_stress(medium, lines, order, offset));
    double sum = 0;
    RandomVectors random(2);
    for (int k = 0; k < 50; ++k)
    {
      const Vec3 x = origin + box_size * (offset + 0.5 * random.vector());
      sum += (field(x) - exact(x)).squaredNorm();
    }
    return std::sqrt(sum / 50);
  };
  for (const int order : {8, 14, 20})
    for (const Vec3 &offset : {Vec3(2, 2, 0), Vec3(3, 0, 0), Vec3(3, 3, 3)})
      EXPECT_LT(absolute_error(offset, order_at_distance(order, offset.norm())), absolute_error(Vec3(2, 0, 0), order))
          << order << ' ' << offset.transpose();
}

TEST(Expansions, MomentsOfTheParentAreThoseOfItsChildrenMoved)
{
  constexpr int order = 10;
  const Vec3 vector(0.25, -0.25, 0.25), child = origin + box_size * vector;
  const auto lines = lines_in_box(child, 0.5 * box_size);
  Coefficients direct(order), of_child(order);
  add_moments(order, 1e-14, origin, box_size, lines, direct.view());
  add_moments(order, 1e-14, child, 0.5 * box_size, lines, of_child.view());
  // Q is referred to the centre, which moves from the child's to the parent's.
  const Coefficients moved = of_child.translated(Shift::child_to_parent, order, vector, box_size, -1);
  for (std::size_t k = 0; k < direct.q.size(); ++k)
  {
    for (std::size_t c = 0; c < row_width; ++c)
      EXPECT_NEAR(moved.fields(k, c), direct.fields(k, c), 1e-12) << k << ' ' << c;
    EXPECT_NEAR(moved.q[k], direct.q[k], 1e-11) << k;
  }
}

TEST(Expansions, LocalExpansionIsTheSamePolynomialInTheChild)
{
  constexpr int order = 10;
  const auto lines = lines_in_box(origin, box_size);
  const Vec3 offset(2, 1, 0), vector(-0.25, 0.25, 0.25), parent = origin + box_size * offset;
  Coefficients moments(order);
  add_moments(order, 1e-14, origin, box_size, lines, moments.view());
  Coefficients local = moments.translated(Shift::far, order, offset, box_size, 1);
  Coefficients of_child = local.translated(Shift::parent_to_child, order, vector, box_size, 1);
  const Vec3 child = parent + box_size * vector;
  const LocalStress a(copper_like, order, parent, box_size, local.fields.rows(), local.q.data());
  const LocalStress b(copper_like, order, child, 0.5 * box_size, of_child.fields.rows(), of_child.q.data());
  EXPECT_LT(error_in_box(field_of(b), field_of(a), child, 0.5 * box_size), 1e-12);
}

TEST(Expansions, CoreRadiusEntersToFourthOrder)
{
  const auto lines = lines_in_box(origin, box_size);
  const Vec3 offset(3, 0, 0);
  const auto error = [&](double a)
  {
    const IsotropicMedium medium{50e3, 0.3, a};
    return error_in_box(field_of(far_stress(medium, lines, 24, offset)), field_of(medium, lines),
                        origin + box_size * offset, box_size);
  };
  const double order = std::log2(error(2.0) / error(1.0));
  EXPECT_NEAR(order, 4, 0.1);
  EXPECT_LT(error(1.0), 2e-5); // a/d = 1/30
}

TEST(Expansions, OfARayConvergeToItsClosedForm)
{
  RandomVectors random(7);
  std::vector<RaySource> rays;
  for (int k = 0; k < 11; ++k) // more than one block
  {
    const Vec3 d = random.vector().normalized();
    rays.push_back({origin + 4 * box_size * d, (d + 0.3 * random.vector()).normalized(), random.vector()});
  }
  const Field exact = [&](const Vec3 &x)
  {
    SymTensor sum = SymTensor::Zero();
    for (const RaySource &r : rays)
      sum += ray_stress(copper_like, x, r.origin, r.direction, r.burgers);
    return sum;
  };
  const auto error = [&](int order)
  {
    Coefficients local(order);
    add_local_of_rays(order, origin, box_size, rays, local.view());
    return error_in_box(
        field_of(LocalStress(copper_like, order, origin, box_size, local.fields.rows(), local.q.data())), exact, origin,
        box_size);
  };
  // sqrt(3)/2 boxes over a distance of 4: 0.22 per order in the corners
  EXPECT_LT(error(6), 1e-3);
  EXPECT_LT(error(12), 1e-4 * error(6) + 2e-8); // the core, a/d = 0.3/40, to fourth order
}

/// How many lines, images included, act on the points of a leaf: through boxes at any level.
std::size_t lines_that_act(const Octree &tree, std::size_t box)
{
  std::size_t sum = 0;
  for (;; box = tree.boxes()[box].parent)
  {
    for (const NearLink &l : tree.near_links(box))
    {
      const Box &b = tree.boxes()[l.box];
      sum += (l.own_only ? b.own_lines_end : b.lines_end) - b.lines_begin;
    }
    for (const FarLink &l : tree.far_links(box))
      sum += tree.boxes()[l.box].n_lines();
    if (tree.boxes()[box].level == 0)
      return sum;
  }
}

TEST(Octree, EveryLineActsOnceOnEveryPoint)
{
  RandomVectors random(3);
  std::vector<LineSource> lines;
  std::vector<Vec3> points;
  for (int k = 0; k < 4000; ++k) // clustered, with a few long lines
  {
    const Vec3 x = std::pow(std::abs(random.number()), 4) * random.vector(),
               d = (k % 100 == 0 ? 1.0 : 0.002) * random.vector();
    lines.push_back({x - d, x + d, random.vector()});
    points.push_back(k % 2 == 0 ? x : random.vector());
  }
  TreeSettings settings;
  settings.translation_cost = std::vector<double>(28, 20.0);
  for (const bool periodic : {false, true})
    for (const auto &n : {std::array{1, 1, 1}, std::array{2, 3, 1}})
    {
      const RootGrid grid{Vec3(-1, -1, -1), Vec3(2.0 / n[0], 2.0 / n[1], 2.0 / n[2]), n, periodic};
      const Octree tree(grid, extents_of(lines), points, settings);
      EXPECT_GT(tree.levels().size(), 6U);
      std::size_t n_points = 0;
      for (std::size_t i = 0; i < tree.boxes().size(); ++i)
        if (tree.boxes()[i].is_leaf() && tree.boxes()[i].n_points() > 0)
        {
          n_points += tree.boxes()[i].n_points();
          ASSERT_EQ(lines_that_act(tree, i), lines.size() * (periodic ? 27 : 1));
        }
      EXPECT_EQ(n_points, points.size());
    }
}

TEST(Octree, HasTheGivenDepthEverywhere)
{
  RandomVectors random(4);
  std::vector<LineSource> lines;
  std::vector<Vec3> points;
  for (int k = 0; k < 300; ++k) // clustered: by cost, the depth would vary
  {
    const Vec3 x = std::pow(std::abs(random.number()), 4) * random.vector(), d = 0.01 * random.vector();
    lines.push_back({x - d, x + d, random.vector()});
    points.push_back(x);
  }
  TreeSettings settings;
  settings.translation_cost = std::vector<double>(28, 20.0);
  settings.depth = 3;
  for (const bool periodic : {false, true})
  {
    const Octree tree({Vec3(-1, -1, -1), Vec3(2, 2, 2), {1, 1, 1}, periodic}, extents_of(lines), points, settings);
    for (std::size_t i = 0; i < tree.boxes().size(); ++i)
    {
      if (!tree.boxes()[i].is_leaf())
        continue;
      EXPECT_EQ(tree.boxes()[i].level, settings.depth);
      ASSERT_EQ(lines_that_act(tree, i), lines.size() * (periodic ? 27 : 1));
      for (const NearLink &l : tree.near_links(i)) // only of boxes that touch
        for (std::size_t c = 0; c < 3 && l.image == 0; ++c)
          EXPECT_LE(std::abs(tree.boxes()[l.box].place[c] - tree.boxes()[i].place[c]), 1);
    }
  }
}

TEST(Octree, HoldsLongLinesInLargeBoxes)
{
  std::vector<LineSource> lines;
  std::vector<Vec3> points;
  RandomVectors random(8);
  for (int k = 0; k < 3000; ++k)
  {
    const Vec3 x = random.vector(), d = (k % 50 == 0 ? 0.3 : 0.01) * random.vector().normalized();
    lines.push_back({x - d, x + d, Vec3::UnitX()});
    points.push_back(x);
  }
  TreeSettings settings;
  settings.translation_cost = std::vector<double>(28, 20.0);
  const Octree tree({Vec3(-1, -1, -1), Vec3(2, 2, 2), {1, 1, 1}, false}, extents_of(lines), points, settings);
  for (const Box &box : tree.boxes())
    if (box.level > 0)
      for (std::uint32_t k = box.lines_begin; k < box.lines_end; ++k)
      {
        const LineSource &l = lines[tree.line_order()[k]];
        ASSERT_LE((l.end - l.start).norm(), settings.longest_line * tree.size(box));
      }
}
} // namespace
} // namespace ddfem::fmm
