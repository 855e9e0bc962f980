// Shared by the validation programs: MPI, a list of statements, and the verdict.
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/microstructure/sources.h"
#include "dd/network/network.h"

#include <deal.II/base/mpi.h>
#include <omp.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

namespace ddfem::validation
{
/// Collects statements "value below limit", prints them, and knows whether all hold.
class Report
{
public:
  explicit Report(const bool print) : prints(print) {}

  void below(const std::string &what, const double value, const double limit)
  {
    const bool holds = std::abs(value) < limit; // false for NaN
    if (prints)
      std::printf("%-72s %12.4e  < %9.2e  %s\n", what.c_str(), value, limit, holds ? "ok" : "FAILED");
    failures += holds ? 0 : 1;
  }
  void note(const std::string &text) const
  {
    if (prints)
      std::printf("%s\n", text.c_str());
  }
  int exit_status() const { return failures == 0 ? 0 : 1; }

private:
  bool prints;
  int failures = 0;
};

/// Runs @p body between MPI_Init and MPI_Finalize; the exit status of the program.
inline int run(int argc, char **argv, const std::function<void(Report &)> &body)
{
  const int threads = omp_get_max_threads();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, static_cast<unsigned>(threads));
  omp_set_num_threads(threads);
  Report report(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);
  body(report);
  return report.exit_status();
}

/// Material of all cases: b = 0.25 nm, a = b.
inline IsotropicMedium medium()
{
  return {50e3, 0.3, 0.25};
}

/// Closed polygon of @p corners about the unit normal @p n, without a glide plane.
inline void add_loop(Network &network, const Vec3 &centre, const Vec3 &n, const double radius, const Vec3 &b,
                     const int corners = 24)
{
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < corners; ++k)
    points.push_back(centre + radius * (std::cos(2 * M_PI * k / corners) * u + std::sin(2 * M_PI * k / corners) * v));
  add_line(network, points, b, {}, true, NodeConstraint::free);
}

/// Half loop about @p n whose ends lie on the plane through @p centre with the outward normal @p outward (in the loop's
/// plane); the arc runs through the body.
inline void add_half_loop(Network &network, const Vec3 &centre, const Vec3 &n, const Vec3 &outward, const double radius,
                          const Vec3 &b, const int pieces = 16)
{
  const Vec3 u = outward.cross(n); // along the surface
  std::vector<Vec3> points;
  for (int k = 0; k <= pieces; ++k)
  {
    const double angle = M_PI * k / pieces;
    points.push_back(centre + radius * (std::cos(angle) * u - std::sin(angle) * outward));
  }
  points.front() = centre + radius * u; // exactly on the surface
  points.back() = centre - radius * u;
  add_line(network, points, b, {}, false, NodeConstraint::surface);
}

/// Vector area of the lines, right-handed about their sense; open lines are closed by the chord.
inline Vec3 vector_area(const Network &network)
{
  Vec3 area = Vec3::Zero();
  Vec3 ends[2] = {Vec3::Zero(), Vec3::Zero()};
  int n_ends = 0;
  for (const SegmentIndex s : network.segments())
  {
    const Vec3 &p = network.position(network.start(s)), &q = network.position(network.end(s));
    area += 0.5 * p.cross(q);
    if (network.degree(network.start(s)) == 1)
      ends[0] = p, ++n_ends;
    if (network.degree(network.end(s)) == 1)
      ends[1] = q, ++n_ends;
  }
  if (n_ends == 2)
    area += 0.5 * ends[1].cross(ends[0]);
  return area;
}
} // namespace ddfem::validation
