// A network of vector area A in a bar between frictionless platens that hold its length L exerts the force F = E b_x A_x / L on
// both platens, whatever its shape and place (reciprocity); positive: tension. Force and stress do not depend on how the lines are
// continued outside.
#include "../coupling/loop_that_has_left.h"
#include "coupling/finite_grain.h"
#include "image_field.h"

#include <map>

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double length = 500, width = 200, slip = 0.25;
const Vec3 oblique = Vec3(1, 0, 1).normalized(), along = Vec3(1, 0, -1).normalized(); // glide plane, slip direction

/// The bar, with errors relative to an expected force.
class Bar
{
public:
  Bar(const unsigned elements, const unsigned degree, const RayDirection rays = RayDirection::normal)
      : rule(rays), grain(parameters(elements, degree, rays), medium(), MPI_COMM_WORLD)
  {
  }
  const GrainShape &shape() const { return grain.shape(); }
  LineSystem lines(const Network &network) const { return {medium(), network, &grain.shape(), rule, nullptr, nullptr}; }

  /// Solves for a network grown in the perfect crystal.
  coupling::GrainSolution solve(const Network &network)
  {
    const LineSystem sources = lines(network);
    grain.set_reference(network, sources);
    return grain.solve(sources, 0.0);
  }
  /// Solves for swept area that has left no line behind.
  coupling::GrainSolution solve(const SweptArea &area)
  {
    const Network nothing;
    grain.set_reference(nothing, lines(nothing));
    grain.add_swept(area);
    return grain.solve(lines(nothing), 0.0);
  }
  std::vector<SymTensor> correction_stress(const std::vector<Vec3> &points) const
  {
    return grain.correction_stress(points);
  }

private:
  static coupling::GrainParameters parameters(const unsigned elements, const unsigned degree, const RayDirection rule)
  {
    coupling::GrainParameters p;
    p.mesh.size = {length, width, width};
    const unsigned across = elements * 2 / 5;
    p.mesh.subdivisions = {elements, across, across};
    p.elasticity.degree = degree;
    p.fixed_face = "x-";
    p.platen_face = "x+";
    p.clamped = false;
    p.reference = coupling::ReferenceState::perfect_crystal;
    p.ray_direction = rule;
    return p;
  }
  RayDirection rule;
  coupling::FiniteGrain grain;
};

double exact_force(const Vec3 &b, const Vec3 &area)
{
  return medium().youngs_modulus() * b[0] * area[0] / length;
}

/// A network and its vector area.
struct Case
{
  Network network;
  Vec3 burgers, area;
};

Case loop(const Vec3 &centre, const Vec3 &n, const double radius, const Vec3 &b)
{
  Case c{{}, b, {}};
  add_loop(c.network, centre, n, radius, b);
  c.area = vector_area(c.network);
  return c;
}

/// Ends on the plane through @p centre with the normal @p outward, in the plane of normal @p n.
Case half_loop(const Vec3 &centre, const Vec3 &n, const Vec3 &outward, const double radius, const Vec3 &b)
{
  Case c{{}, b, {}};
  add_half_loop(c.network, centre, n, outward, radius, b);
  c.area = vector_area(c.network);
  return c;
}

/// Quarter of a loop around the point @p x of the edge y = z = 0 in the plane of normal @p n: ends on both faces.
Case corner_loop(const double x, const Vec3 &n, const double radius, const Vec3 &b)
{
  const Vec3 corner(x, 0, 0), u = Vec3::UnitY(), v = n.cross(u) * (n.cross(u)[2] > 0 ? 1 : -1);
  constexpr int pieces = 12;
  std::vector<Vec3> points;
  for (int k = 0; k <= pieces; ++k)
    points.push_back(corner + radius * (std::cos(M_PI_2 * k / pieces) * u + std::sin(M_PI_2 * k / pieces) * v));
  points.front() = corner + radius * u; // exactly on the faces
  points.back() = corner + radius * v;
  Case c{{}, b, Vec3::Zero()};
  add_line(c.network, points, b, {}, false, NodeConstraint::surface);
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    c.area += 0.5 * (points[k] - corner).cross(points[k + 1] - corner);
  return c;
}

using Cases = std::map<std::string, std::vector<Case>>;

/// Kinds of networks, each in several places: in the middle, about one element from a platen, a side or an edge.
Cases all_cases()
{
  const Vec3 glide = slip * along, prismatic = slip * Vec3::UnitX(), x = Vec3::UnitX(), y = Vec3::UnitY(),
             z = Vec3::UnitZ();
  Cases cases;
  for (const Vec3 &place : {Vec3(230, 90, 110), Vec3(90, 110, 100), Vec3(415, 80, 90), Vec3(250, 60, 60)})
  {
    cases["shear loop"].push_back(loop(place, oblique, 50, glide));
    cases["prismatic loop"].push_back(loop(place, x, 50, prismatic));
  }
  cases["shear loop near a side face"] = {};
  for (const Vec3 &place : {Vec3(250, 100, 150), Vec3(250, 45, 100), Vec3(70, 155, 100)})
    cases["shear loop near a side face"].push_back(loop(place, oblique, 40, glide));
  for (const double at : {90.0, 240.0, 400.0})
  {
    cases["surface half loop"].push_back(half_loop(Vec3(at, 0, 100), oblique, -y, 60, glide));
    cases["surface half loop"].push_back(half_loop(Vec3(at, 90, width), oblique, -along, 60, glide));
    cases["prismatic half loop"].push_back(half_loop(Vec3(at, 110, 0), x, -z, 60, prismatic));
    cases["corner loop"].push_back(corner_loop(at, oblique, 60, glide));
    cases["corner loop"].push_back(corner_loop(at, x, 60, prismatic));
  }
  // Nearer to a platen than an element of 50, down to a tenth of it: the distance of the nearest point of the loop.
  for (const double near : {5.0, 12.5, 25.0, 50.0})
    for (const bool far_end : {false, true})
    {
      const auto place = [&](const double extent)
      { return Vec3(far_end ? length - near - extent : near + extent, 110, 100); };
      cases["loop 0.1 to 1 element from a platen"].push_back(loop(place(40 * std::sqrt(0.5)), oblique, 40, glide));
      cases["loop 0.1 to 1 element from a platen"].push_back(loop(place(0), x, 40, prismatic));
      // In the corner between a platen and a side, where its image has to be right as well.
      cases["loop close to a platen and a side"].push_back(loop(Vec3(place(0)[0], 45, 100), x, 40, prismatic));
    }
  return cases;
}

struct Errors
{
  double force = 0, mismatch = 0;
};

Errors largest_errors(Bar &bar, const std::vector<Case> &cases)
{
  Errors worst;
  for (const Case &c : cases)
  {
    const auto solution = bar.solve(c.network);
    const double exact = exact_force(c.burgers, c.area);
    worst.force = std::max(worst.force, std::abs(solution.platen_reaction / exact - 1));
    worst.mismatch =
        std::max(worst.mismatch, std::abs(solution.fixed_reaction - solution.platen_reaction) / std::abs(exact));
  }
  return worst;
}

/// Every kind of network in every place, on the production mesh and on a coarse one of linear elements. The uniform stress is among
/// the fields of the elements, and the mean of the displacement on the platens is that of the projection: nothing is left but the
/// error of the integrals, whose tolerance is 1e-4.
void check_cases(Report &report)
{
  Bar production(10, 2), coarse(5, 1);
  for (const auto &[name, cases] : all_cases())
  {
    const Errors errors = largest_errors(production, cases);
    report.below(name + ", 10 quadratic elements along the bar: error", errors.force, 1e-4);
    report.below(name + ": difference of the platens", errors.mismatch, 1e-5);
    report.below(name + ", 5 linear elements: error", largest_errors(coarse, cases).force, 1e-4);
  }
}

void check_loop_that_has_left(Report &report)
{
  Bar bar(10, 2);
  const Vec3 n = Vec3(1, 0.2, 0.4).normalized(), b = slip * Vec3(0.4, 0, -1).normalized();
  Network network;
  const SweptArea swept = test::loop_that_has_left(network, bar.shape(), n, b);
  const auto solution = bar.solve(swept);
  // It has slipped the whole section, whose projection on the platens is theirs.
  const double exact = exact_force(b, Vec3(width * width, 0, 0));
  report.below("loop that has left: segments it has left behind", static_cast<double>(network.n_segments()), 0.5);
  report.below("loop that has left: error", solution.platen_reaction / exact - 1, 1e-3);
  report.below("loop that has left: difference of the platens", solution.fixed_reaction / solution.platen_reaction - 1,
               1e-5);
}

/// The half loop @p c closed outside the bar by straight lines along @p direction that meet 0.01 m away, without rays.
Network closed_along(const Case &c, const Vec3 &direction)
{
  constexpr double far = 1e7;
  std::vector<Vec3> points;
  for (const NodeIndex i : c.network.nodes()) // add_line() numbers them along the line
    points.push_back(c.network.position(i));
  const Vec3 first = points.front(), last = points.back();
  points.push_back(last + far * direction);
  points.push_back(first + far * direction);
  Network closed;
  add_line(closed, points, c.burgers, {}, true, NodeConstraint::free);
  return closed;
}

/// Force, and total stress at points three elements and more below the face where the line ends, for each of several
/// continuations of a half loop. (Nearer it errs by (h/d)^2 of the difference of the continuations' fields.)
void check_closures(Report &report)
{
  constexpr unsigned elements = 20, degree = 2;
  const Case c = half_loop(Vec3(240, 90, width), oblique, -along, 60, slip * along);
  const std::vector<Vec3> points{Vec3(275, 100, 120), Vec3(230, 90, 100), Vec3(300, 120, 60),
                                 Vec3(330, 40, 120),  Vec3(250, 50, 90),  Vec3(120, 100, 100)};
  Bar normal(elements, degree), radial(elements, degree, RayDirection::radial);
  const auto total = [&](Bar &bar, const Network &network, double &force)
  {
    force = bar.solve(network).platen_reaction;
    auto stress = bar.correction_stress(points);
    const LineSystem lines = bar.lines(network);
    for (std::size_t k = 0; k < points.size(); ++k)
      stress[k] += lines.stress(points[k]);
    return stress;
  };
  double reference_force = 0;
  const auto reference = total(normal, c.network, reference_force);
  const auto compare = [&](const std::string &name, Bar &bar, const Network &network)
  {
    double force = 0, worst = 0;
    const auto stress = total(bar, network, force);
    for (std::size_t k = 0; k < points.size(); ++k)
      worst = std::max(worst, (stress[k] - reference[k]).norm() / reference[k].norm());
    report.below("half loop continued " + name + " instead of along the normal: platen force",
                 force / reference_force - 1, 1e-3);
    report.below("half loop continued " + name + ": total stress inside", worst, 0.01);
  };
  compare("radially", radial, c.network);
  compare("along b", normal, closed_along(c, -along));
  compare("10 degrees above the surface", normal, closed_along(c, Vec3(0, std::cos(M_PI / 18), std::sin(M_PI / 18))));
}

/// Errors against the number of elements, degree by degree.
void print_table(const Report &report)
{
  for (const unsigned degree : {1U, 2U})
    for (const unsigned elements : {5U, 10U, 20U})
    {
      Bar bar(elements, degree);
      for (const auto &[name, cases] : all_cases())
      {
        char row[120];
        std::snprintf(row, sizeof row, "degree %u, %2u elements along the bar, %-37s largest error %9.5f %%", degree,
                      elements, (name + ":").c_str(), 100 * largest_errors(bar, cases).force);
        report.note(row);
      }
    }
}
} // namespace

int main(int argc, char **argv)
{
  const bool studies = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               if (studies)
                 return print_table(report);
               check_cases(report);
               check_loop_that_has_left(report);
               check_closures(report);
             });
}
