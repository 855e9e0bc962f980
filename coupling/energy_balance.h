// Where the work of the loading goes: stored or dissipated, step by step.
#pragma once

#include "coupling/finite_grain.h"
#include "dd/forces/segment_points.h"

#include <vector>

namespace ddfem::coupling
{
/// Work (MPa nm^3 = 1e-21 J) of a stress at points of the segments while the nodes move by @p displacement (nm, by
/// NodeIndex::value): int int (sigma . b) x dx . du with constant stress.
double work_on_lines(const Network &network, const SegmentPoints &points, const std::vector<SymTensor> &stress,
                     const std::vector<Vec3> &displacement);

/// Work (MPa nm^3) of nodal forces (MPa nm^2) that change from @p first to @p last along @p displacement (nm), trapezoid rule.
double work_of_nodal_forces(const Network &network, const std::vector<Vec3> &first, const std::vector<Vec3> &last,
                            const std::vector<Vec3> &displacement);

/// Centres (nm) of the triangles swept inside the grain; those beyond a surface are put back onto it.
std::vector<Vec3> swept_centres(const SweptArea &area, const GrainShape *shape);

/// Work (MPa nm^3) of a stress known at the swept_centres() on the area swept inside the grain: sum of -b . sigma . A.
double work_on_area(const SweptArea &area, const std::vector<SymTensor> &stress);

/// What the lines did in one step, MPa nm^3.
struct LineWork
{
  double total = 0;    ///< of all nodal forces along the motion of the nodes: what drag dissipates
  double external = 0; ///< the part in it of the correction field (finite grain) or of the applied stress
  /// Of the correction (or applied stress) on what was swept besides: merging, splitting, remeshing, lines that leave.
  double topology = 0;

  LineWork &operator+=(const LineWork &other)
  {
    total += other.total;
    external += other.external;
    topology += other.topology;
    return *this;
  }
};

/// Sums from the start of the run, MPa nm^3.
struct Energies
{
  double work = 0;       ///< done by the platens, or by the applied stress on the strain of the body
  double stored = 0;     ///< elastic energy of the body
  double dissipated = 0; ///< by drag and by changes of topology
  double topology = 0;   ///< the latter
  double mismatch() const { return work - stored - dissipated; }
};

/// The balance  work = stored + dissipated.
///
/// Stored energy of a finite grain, from quantities of its boundary (symbols of BoundaryState; derivation in docs/theory.md):
///   E = 1/2 (r - f) . u^  - sum of f . du~  - sum of (work of the nodal forces of the infinite field),
/// the energy of the correction and of its interaction with the infinite field, the change of the infinite field's energy that
/// crosses the surface, and the energy of the lines in an unbounded body. As K u^ = f + r is symmetric,
///   work - stored - dissipated = [ (f+r) . du~ + df . u^ ] - (work of the correction field on lines and swept area):
/// by reciprocity the bracket is the work of sigma^ on the swept area. The images of the lines near the surface count as part of
/// the infinite field here. The balance closes if tractions, displacements by swept area,
/// solver, reactions, recovered stress and nodal forces belong together. It does not test the forces of the infinite field
/// against the energies of lines: that is a test of dd/.
/// Periodic and infinite: the same with the applied stress in place of the correction; E = V sigma : S : sigma / 2.
class EnergyBalance
{
public:
  /// The state that everything counts from.
  void start(const BoundaryState &boundary) { last_boundary = boundary; }
  void start(const SymTensor &stress, const SymTensor &plastic_strain);

  /// A step, or a motion of the platen alone (no @p lines). Collective.
  void add(const BoundaryState &boundary, const LineWork &lines, MPI_Comm communicator);
  /// @p stress MPa, @p volume nm^3.
  void add(const IsotropicMedium &medium, double volume, const SymTensor &stress, const SymTensor &plastic_strain,
           const LineWork &lines);

  const Energies &energies() const { return sums; }
  /// With steps that have not been added: work of the platens (MPa nm^3) and of the lines in them. The energy that is stored is
  /// what closes the balance with the mismatch so far.
  Energies energies_with(double platen_work, const LineWork &lines) const;
  /// mismatch() over the largest of work and dissipation so far; zero before anything has happened.
  double relative_mismatch() const { return scale > 0 ? sums.mismatch() / scale : 0.0; }

private:
  void add(double work, double stored, const LineWork &lines);

  BoundaryState last_boundary;
  SymTensor last_stress = SymTensor::Zero(), last_plastic_strain = SymTensor::Zero();
  Energies sums;
  double scale = 0;
};
} // namespace ddfem::coupling
