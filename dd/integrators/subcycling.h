// Subcycling: near forces are integrated with shorter steps than far ones.
#pragma once

#include "dd/integrators/far_forces.h"
#include "dd/integrators/integrator.h"
#include "dd/integrators/split_forces.h"

namespace ddfem
{
class LocalRefinement;

/// Forces are divided into two groups by the distance of the segments, as in Sills, Aghaei & Cai, MSMSE 24 (2016) 045019: NearForces, and
/// FarForces, which are computed at the ends of the global step only. The motion under near forces is integrated by LocalRefinement with
/// steps of its own, shorter ones for the nodes that need them (as in Sills & Cai, MSMSE 22 (2014) 025003). Other than there the groups do not move the nodes one
/// after the other: the far forces stay in the equation that the near ones are integrated with, so that lines in equilibrium rest. They are those of the start first, and
/// then vary linearly to those at the end of this prediction: the second-order infinitesimal step method with Heun's
/// rule outside (Wensch, Knoth & Galant, BIT 49 (2009) 449). The difference of both is the estimated error of the far part.
///
/// Where a few nodes err too much, because something passes them quickly outside the near distance, what is within four times this distance of them is taken
/// for near, and the step is completed for them without another evaluation of all forces.
///
/// Needs EquationOfMotion::forces, and mobility laws that know the force on a node alone.
class Subcycling : public Integrator
{
public:
  using Integrator::Integrator;

private:
  void begin_step(const Start &start) override;
  Try attempt(const Start &start, double h, IntegratorStep &step) override;
  double largest_step(const EquationOfMotion &motion) const override;

  void find_near(const Start &start, double h);
  bool goes_too_far(const Start &start, const Field &displacement) const;
  void correct(const Start &start, LocalRefinement &solver, Try &result);
  void look_farther(const Start &start, LocalRefinement &solver, const Field &predicted, Try &result);

  NearForces near;
  FarForces far;
  std::vector<SegmentForces> at_start; ///< all forces, MPa nm^2, by SegmentIndex::value
  std::vector<double> stiffness;       ///< with that of near pairs, 1/ns, by NodeIndex::value
};
} // namespace ddfem
