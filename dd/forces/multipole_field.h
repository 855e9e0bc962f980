// The infinite field of a system of lines at points by the fast multipole method.
#pragma once

#include "dd/fmm/multipole_stress.h"
#include "dd/forces/line_system.h"
#include "dd/forces/lines_in_boxes.h"

#include <mpi.h>

#include <memory>
#include <span>
#include <vector>

namespace ddfem
{
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
  /// neighbours belong to the far part. Collective; the values do not depend on the number of ranks and threads.
  std::vector<SymTensor> stress(MPI_Comm comm, fmm::Part part = fmm::Part::all,
                                fmm::Recipient recipient = fmm::Recipient::every_rank,
                                fmm::LocalExpansions local = fmm::LocalExpansions::used_once);

  /// Puts sources and points of another time into the boxes, see fmm::MultipoleStress::move(). @p sources: those of @p now
  /// in its order, then others; @p points_now: the images that lie in the boxes.
  void move(const LineSystem &now, std::span<const Vec3> points_now, const LinesInBoxes &sources,
            std::span<const std::uint32_t> leaf_of_point);
  /// As stress() after move(); what distant boxes add is that of the last time, extrapolated by @p ahead times its change before.
  /// Collective.
  std::vector<SymTensor> stress_with_kept_far_field(MPI_Comm comm, double ahead, fmm::Recipient recipient);
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
  std::vector<Vec3> at() const { return expansions->points(); }

private:
  void keep(std::vector<Vec3> given);
  void add_distant_images(std::vector<SymTensor> &values, fmm::Recipient recipient) const;

  const LineSystem *system;
  std::vector<Vec3> points; ///< wrapped into the periodic cell; only with images beyond the neighbours
  CutRays cuts;
  std::unique_ptr<fmm::MultipoleStress> expansions;
};
} // namespace ddfem
