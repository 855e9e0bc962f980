// Dissociation of nodes with many arms.
#pragma once

#include "dd/forces/nodal_forces.h"
#include "dd/mobility/linear_glide.h"
#include "dd/topology/topology_context.h"

#include <functional>

namespace ddfem
{
/// Physics that decides whether and how a node splits.
struct SplittingModel
{
  IsotropicMedium medium;
  double core_cutoff_radius = 0.0; ///< nm; sets the line tension of a new junction segment
  LinearGlide mobility;
};

/// Nodal forces for the present network, computed only when some node can split.
using ForceFunction = std::function<NodalForces(const Network &)>;

/// Splits every free node with four to eight arms into the two nodes, each with two arms at least, that dissipate the most
/// power sum F.V (Bulatov & Cai, Computer Simulations of Dislocations, 2006, section 10.4), if that is more than the
/// unsplit node dissipates and the two move apart. Where the arms of each part balance, nothing joins the parts: lines
/// that met and annihilated reconnect this way. Otherwise a junction segment with the remaining Burgers vector joins them,
/// whose line tension is taken off the forces. The parts are set apart by one and a half collision radii.
void split_nodes(TopologyContext &context, const SplittingModel &model, const ForceFunction &forces);
} // namespace ddfem
