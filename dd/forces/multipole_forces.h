// Forces on lines by the fast multipole method.
#pragma once

#include "dd/elasticity/segment_force.h"
#include "dd/elasticity/vectorised/force_kernels.h"
#include "dd/forces/line_shares.h"
#include "dd/forces/line_system.h"
#include "dd/forces/lines_near_leaf.h"
#include "dd/forces/multipole_field.h"

#include <mpi.h>

#include <memory>
#include <vector>

namespace ddfem
{
class FarFieldCache;

/**
 * Forces on the ends of the lines of a system from all other lines, rays and images. The stress is taken at Gauss points of
 * panels (pieces of lines of similar length). Where a source is too near to a panel for the rule, its contribution
 * to the rule is replaced by that to a rule of one point more or, nearer by, by the force in closed form (segment_force.h): connected
 * and close pairs are exact. A panel of half length h with n points integrates a source at distance d from its middle with a
 * relative error of about rho^-(2n-1), d/h = (rho + 1/rho)/2: rho^-2n (Trefethen, SIAM Rev. 50 (2008) 67, eq. 4.15) times the
 * size of the shape functions on the ellipse, about rho/4. This decides.
 *
 * Each rank computes the stress at the points of its leaves, and the forces on the lines that begin there. Stresses at points of
 * lines that cross from one share to another travel while close sources are replaced.
 */
class MultipoleForces
{
public:
  /// Collective. @p pair_tolerance: of the forces in closed form, at most a
  /// tenth of the tolerance of the settings: their sum, up to a hundred times the far force, is ten to a hundred times more accurate.
  /// @p part: near leaves out what distant boxes add (a cut-off at the size of the boxes), for comparison.
  MultipoleForces(const LineSystem &system, const fmm::MultipoleSettings &settings, double pair_tolerance,
                  MPI_Comm comm, fmm::Part part = fmm::Part::all);
  /// The same with a far field that may be kept from an earlier time. The lines are those of @p network; @p images: as in
  /// ForceEnvironment.
  MultipoleForces(const LineSystem &system, const fmm::MultipoleSettings &settings, double pair_tolerance,
                  MPI_Comm comm, FarFieldCache &cache, const Network &network, PeriodicImages *images);

  /// Lines by the rank that has the forces on them.
  const LineShares &shares() const { return line_shares; }
  /// Forces on line number @p i of the system, one of this rank, without its own (self_force.h), MPa nm^2. Safe to call from any thread.
  const SegmentForces &operator()(const std::size_t i) const { return forces[i]; }

  /// For measurements: the field at the Gauss points, their number on a panel, and the first one of line number @p i; those of
  /// its panels follow, and then those of the next line.
  const MultipoleField &field() const { return *multipoles; }
  int n_gauss_points() const { return n_gauss; }
  std::size_t first_point_of(const std::size_t i) const
  {
    return i < points.n_lines() ? points.begin(i) : points.n_points();
  }

  /// What this rank has spent besides the field.
  struct Spent
  {
    double close_pairs = 0;          ///< processor time, summed over threads, s
    double waiting = 0;              ///< for the stresses of others, processor time, s
    std::size_t n_stresses_sent = 0; ///< to others
  };
  const Spent &spent() const { return spent_besides; }

private:
  /// Piece [begin, end] (fractions) of a line.
  struct Panel
  {
    double begin, end;
  };

  /// Lines too near to a panel for its rule, among them the panel's own.
  struct NearSources
  {
    LineTable closest;            ///< by closed forms
    LineTable others;             ///< by a rule of one point more
    std::size_t itself = no_line; ///< among the closest
  };
  /// What the panels of a leaf share: the lines near it, and the memory for those of a panel.
  struct Surroundings
  {
    LinesNearLeaf lines;
    NearSources near;
  };

  MultipoleForces(const LineSystem &system, const fmm::MultipoleSettings &settings, double pair_tolerance);
  std::vector<Vec3> place_points();
  std::size_t n_panels(std::size_t i) const;
  template <class Visit> void for_each_panel(std::size_t i, Visit &&visit) const;
  void sum(std::vector<SymTensor> stress, MPI_Comm comm);
  std::vector<double> replace_near();
  void replace_near_in(const fmm::Box &leaf);
  void replace_near(std::size_t i, const Panel &panel, Surroundings &around, SegmentForces &force) const;
  void find_near_sources(std::size_t i, const Vec3 &start, const Vec3 &end, Surroundings &around) const;
  SegmentForces quadrature(std::size_t i, const std::vector<SymTensor> &stress) const;

  const LineSystem &system;
  double pair_tolerance;
  int n_gauss;              ///< points per panel
  double near_distance;     ///< of sources that are replaced, in half lengths of the panel
  double closest_distance;  ///< of those that closed forms replace
  double longest_panel = 0; ///< nm
  PointsOfLines points{{0}};
  std::shared_ptr<MultipoleField> multipoles;
  LineShares line_shares;
  std::vector<SegmentForces> forces; ///< on the lines of this rank, by number of the line
  Spent spent_besides;
};
} // namespace ddfem
