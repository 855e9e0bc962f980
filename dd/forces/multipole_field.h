// The infinite field of a system of lines by the fast multipole method: at points, and as forces on the lines.
#pragma once

#include "dd/elasticity/segment_force.h"
#include "dd/elasticity/vectorised/force_kernels.h"
#include "dd/fmm/multipole_stress.h"
#include "dd/forces/line_system.h"
#include "dd/forces/lines_in_boxes.h"

#include <mpi.h>

#include <memory>
#include <span>
#include <vector>

namespace ddfem
{
class FarFieldCache;

/// How the fields of many lines are summed.
enum class SummationMethod : std::uint8_t
{
  direct,    ///< every pair in closed form
  multipole, ///< distant boxes by expansions (dd/fmm)
  automatic, ///< multipole from `multipole_from` lines
};

struct SummationSettings
{
  SummationMethod method = SummationMethod::automatic;
  /// Error of the far stress relative to its rms, 1e-8 to 0.1, and of the nodal forces relative to those of the far stress. Of the
  /// total it is a fifth to a hundredth.
  double tolerance = 1e-3;
  /// Above the size at which both methods take the same time.
  std::size_t multipole_from = 2000;

  bool use_multipoles(std::size_t n_lines) const { return use_multipoles(n_lines, n_lines); }
  /// For fields at other points than on the lines: the same number of pairs.
  bool use_multipoles(std::size_t n_sources, std::size_t n_points) const
  {
    const auto pairs = static_cast<double>(n_sources) * static_cast<double>(n_points);
    const auto enough = static_cast<double>(multipole_from) * static_cast<double>(multipole_from);
    return method == SummationMethod::multipole || (method == SummationMethod::automatic && pairs >= enough);
  }
};

/// The lines of @p system as sources, in their order.
std::vector<fmm::LineSource> line_sources(const LineSystem &system);

/// The sources of @p system and a tree that has them and @p points.
class MultipoleField
{
public:
  /// @throws std::invalid_argument for a tolerance outside its range.
  MultipoleField(const LineSystem &system, std::span<const Vec3> points, const fmm::MultipoleSettings &settings);

  /// As LineSystem::stress(): infinite-body stress at the points, MPa, periodic images included; those beyond the 26
  /// neighbours belong to the far part. Collective; all ranks get all values, which do not depend on the number of ranks
  /// and threads.
  std::vector<SymTensor> stress(MPI_Comm comm, fmm::Part part = fmm::Part::all);

  /// Puts sources and points of another time into the boxes, see fmm::MultipoleStress::move(). @p sources: those of @p now
  /// in its order, then others; @p points_now: the images that lie in the boxes.
  void move(const LineSystem &now, std::span<const Vec3> points_now, const LinesInBoxes &sources,
            std::span<const std::uint32_t> leaf_of_point);
  /// As stress() after move(); what distant boxes add is that of the last time, extrapolated by @p ahead times its change before.
  /// Collective.
  std::vector<SymTensor> stress_with_kept_far_field(MPI_Comm comm, double ahead);
  /// The same with a new far field; the last one is kept for extrapolation.
  std::vector<SymTensor> stress_with_new_far_field(MPI_Comm comm);
  /// See fmm::MultipoleStress::set_earlier(); @p lines in the order given last, pieces of rays behind those of the system.
  void set_earlier(const std::vector<fmm::LineSource> &lines, std::vector<fmm::RaySource> distant_rays);
  /// Stress of the images beyond the 26 neighbours at point number @p i, MPa.
  SymTensor stress_of_distant_images(std::size_t i) const;

  fmm::MultipoleStress &sum() { return *expansions; }
  const fmm::MultipoleStress &sum() const { return *expansions; }
  /// How the rays of the constructor's system were cut.
  const CutRays &cut_rays() const { return cuts; }
  /// The points, in a periodic cell wrapped into it.
  const std::vector<Vec3> &at() const { return points; }

private:
  void take(std::span<const Vec3> given);
  void add_distant_images(std::vector<SymTensor> &values) const;

  const LineSystem *system;
  std::vector<Vec3> points; ///< wrapped into the periodic cell
  CutRays cuts;
  std::unique_ptr<fmm::MultipoleStress> expansions;
};

/**
 * Forces on the ends of the lines of a system from all other lines, rays and images. The stress is taken at Gauss points of
 * panels (pieces of lines of similar length). Where a source is too near to a panel for the rule, its contribution
 * to the rule is replaced by that to a rule of one point more or, nearer by, by the force in closed form (segment_force.h): connected
 * and close pairs are exact. A panel of half length h with n points integrates a source at distance d from its middle with a
 * relative error of about rho^-(2n-1), d/h = (rho + 1/rho)/2: rho^-2n (Trefethen, SIAM Rev. 50 (2008) 67, eq. 4.15) times the
 * size of the shape functions on the ellipse, about rho/4. This decides.
 */
class MultipoleForces
{
public:
  /// Computes the stress at all Gauss points. Collective. @p pair_tolerance: of the forces in closed form, at most a
  /// tenth of the tolerance of the settings: their sum, up to a hundred times the far force, is ten to a hundred times more accurate.
  /// @p part: near leaves out what distant boxes add (a cut-off at the size of the boxes), for comparison.
  MultipoleForces(const LineSystem &system, const fmm::MultipoleSettings &settings, double pair_tolerance,
                  MPI_Comm comm, fmm::Part part = fmm::Part::all);
  /// The same with a far field that may be kept from an earlier time. The lines are those of @p network; @p images: as in
  /// ForceEnvironment.
  MultipoleForces(const LineSystem &system, const fmm::MultipoleSettings &settings, double pair_tolerance,
                  MPI_Comm comm, FarFieldCache &cache, const Network &network, PeriodicImages *images);

  /// Forces on line number @p i of the system, without its own (self_force.h), MPa nm^2. Safe to call from any thread.
  SegmentForces operator()(std::size_t i) const;

  /// For measurements: the field at the Gauss points, their number on a panel, and the first one of line number @p i; those of
  /// its panels follow, and then those of the next line.
  const MultipoleField &field() const { return *multipoles; }
  int n_gauss_points() const { return n_gauss; }
  std::size_t first_point_of(std::size_t i) const { return i < first_point.size() ? first_point[i] : stress.size(); }

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

  MultipoleForces(const LineSystem &system, const fmm::MultipoleSettings &settings, double pair_tolerance);
  std::vector<Vec3> place_points();
  std::vector<Panel> panels_of(std::size_t i) const;
  SegmentForces panel_force(std::size_t i, const Panel &panel, std::size_t first_point) const;
  void replace_near(std::size_t i, const Panel &panel, SegmentForces &force) const;
  NearSources near_sources(std::size_t i, const Vec3 &start, const Vec3 &end) const;
  template <class Stress>
  SegmentForces quadrature(const StraightLine &line, const Panel &panel, Stress &&stress_at) const;

  const LineSystem &system;
  double pair_tolerance;
  int n_gauss;              ///< points per panel
  double near_distance;     ///< of sources that are replaced, in half lengths of the panel
  double closest_distance;  ///< of those that closed forms replace
  double longest_panel = 0; ///< nm
  std::vector<std::size_t> first_point;
  std::shared_ptr<MultipoleField> multipoles;
  std::vector<SymTensor> stress;
};
} // namespace ddfem
