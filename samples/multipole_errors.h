// Errors of the fast multipole method on a network, against the sum of all pairs.
#pragma once

#include "dd/forces/multipole_forces.h"
#include "dd/forces/nodal_forces.h"
#include "samples/systems_of_lines.h"

#include <vector>

namespace ddfem::samples
{
/// Error of a field, and the rms of the field that the requested error refers to: its part by expansions, and the whole field.
struct FieldError
{
  double rms = 0, largest = 0;
  double far = 0, total = 0;
};

struct MultipoleErrors
{
  int order = 0, n_gauss = 0;
  FieldError stress;          ///< at random points, MPa
  FieldError stress_on_lines; ///< at the Gauss points of the lines, MPa
  FieldError force;           ///< on nodes, MPa nm^2
  double force_error_of_stress =
      0; ///< rms part of it that comes from the stress at the Gauss points; the rest is quadrature
};

/// Compares with references that are computed once.
class MultipoleErrorMeter
{
public:
  MultipoleErrorMeter(const SampleLines &lines, std::size_t n_points);

  /// @p cost_factor: see fmm::MultipoleSettings; small, so that much of a small network is far.
  MultipoleErrors errors(double tolerance, double cost_factor,
                         double pair_tolerance = ForceSettings{}.pair_tolerance) const;

  std::size_t n_lines() const { return system.lines().size(); }

private:
  FieldError stress_error(const fmm::MultipoleSettings &settings) const;
  /// Nodal forces of the forces on the ends of every line.
  template <class ForcesOf> std::vector<Vec3> at_nodes(ForcesOf &&forces_of) const;
  std::vector<Vec3> nodal_forces(const std::vector<SymTensor> &stress, const MultipoleForces &forces) const;
  std::vector<Vec3> direct_forces() const;

  const SampleLines &sample;
  LineSystem system;
  std::vector<Vec3> points, exact_force;
  std::vector<SymTensor> exact_stress;
};
} // namespace ddfem::samples
