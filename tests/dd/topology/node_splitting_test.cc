#include "dd/crystal/material.h"
#include "dd/topology/line_operations.h"
#include "dd/topology/node_splitting.h"
#include "samples/dislocation_driver.h"
#include "samples/values.h"
#include "topology_fixture.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <set>
#include <vector>

namespace ddfem
{
namespace
{
const Vec3 b(0.286, 0, 0);
const IsotropicMedium aluminium{26272, 0.345, 0.286};
const MobilityPointer drag = linear_glide(0.02, 0.02);
const ForceSettings force_settings{aluminium, aluminium.a, 1e-6, RayDirection::normal};

/// Splits under a uniform stress; counts how often all forces have been computed.
unsigned split(TopologyContext &c, const SymTensor &applied = SymTensor::Zero(),
               SplittingModel model = {aluminium, aluminium.a, drag})
{
  unsigned evaluations = 0;
  model.applied = applied;
  split_nodes(c, model,
              [&](const Network &n)
              {
                ++evaluations;
                ForceEnvironment e;
                e.applied = applied;
                return compute_nodal_forces(n, force_settings, e, MPI_COMM_SELF);
              });
  return evaluations;
}

SymTensor shear_xz(const double tau)
{
  SymTensor s = SymTensor::Zero();
  s[4] = tau;
  return s;
}

/// Two lines on the horizontal plane that touch at the origin: V-shaped, as when a source closes. Their directions
/// are opposite; they are edges near the origin.
std::array<NodeIndex, 9> touching_bulges(TopologyFixture &f, const double half_opening)
{
  Network &n = f.network;
  const auto node = [&](const double x, const double y, const NodeConstraint c) {
    return n.insert(Node{Vec3(x, y, 0), c});
  };
  using enum NodeConstraint;
  const double w = half_opening;
  std::array<NodeIndex, 9> i{node(0, 0, free),         node(-w, -15, free),      node(-2 * w, -30, pinned),
                             node(-w, 15, free),       node(-2 * w, 30, pinned), node(w, -15, free),
                             node(2 * w, -30, pinned), node(w, 15, free),        node(2 * w, 30, pinned)};
  const PlaneIndex p = f.horizontal();
  const auto line = [&](std::initializer_list<std::size_t> chain)
  {
    for (auto k = chain.begin(); k + 1 != chain.end(); ++k)
      n.insert(Segment{i[*k], i[*(k + 1)], b, p});
  };
  line({2, 1, 0, 3, 4});
  line({8, 7, 0, 5, 6});
  return i;
}

/// The nodes that can be reached from @p i along lines, by index.
std::set<std::uint32_t> connected_nodes(const Network &n, const NodeIndex i)
{
  std::set<std::uint32_t> seen{i.value};
  std::vector<NodeIndex> open{i};
  while (!open.empty())
  {
    const NodeIndex k = open.back();
    open.pop_back();
    for (const SegmentIndex s : n.connected_segments(k))
      if (seen.insert(n.other_end(s, k).value).second)
        open.push_back(n.other_end(s, k));
  }
  return seen;
}

/// The pinned ones among them.
std::set<std::uint32_t> pinned_ends(const Network &n, const NodeIndex i)
{
  std::set<std::uint32_t> ends;
  for (const std::uint32_t k : connected_nodes(n, i))
    if (n.constraint(NodeIndex{k}) == NodeConstraint::pinned)
      ends.insert(k);
  return ends;
}

/// Two lines that cross at a node at the origin, on the planes of slip systems @p first and @p second, with angles
/// (degrees) from the common line of the planes. Returns the four arms' far ends, two of each line.
std::array<NodeIndex, 5> crossing(TopologyFixture &f, const SlipSystems &systems, const char *first, const char *second,
                                  const double sign, const std::array<double, 2> &angles)
{
  Network &n = f.network;
  const std::array<SlipSystem, 2> s{systems[*systems.find(first)], systems[*systems.find(second)]};
  const Vec3 e = s[0].normal.cross(s[1].normal).normalized();
  std::array<NodeIndex, 5> nodes;
  nodes[0] = n.insert(Node{Vec3::Zero()});
  for (std::size_t k = 0; k < 2; ++k)
  {
    const PlaneIndex p = n.planes().find_or_insert(s[k].plane_miller, s[k].normal, Vec3(Vec3::Zero()));
    const double phi = angles[k] * std::numbers::pi / 180;
    const Vec3 t = std::cos(phi) * e + std::sin(phi) * s[k].normal.cross(e);
    const Vec3 burgers = (k == 0 ? 1 : sign) * s[k].burgers;
    nodes[1 + 2 * k] = n.insert(Node{-20 * t, NodeConstraint::pinned});
    nodes[2 + 2 * k] = n.insert(Node{20 * t, NodeConstraint::pinned});
    n.insert(Segment{nodes[1 + 2 * k], nodes[0], burgers, p});
    n.insert(Segment{nodes[0], nodes[2 + 2 * k], burgers, p});
  }
  return nodes;
}

const SlipSystems fcc(Lattice::fcc, 0.40496);

struct CrossingFixture : TopologyFixture
{
  TopologyContext crossing_context()
  {
    TopologyContext c = context();
    c.product_plane = product_plane_rule(fcc);
    return c;
  }
};

TEST(NodeSplitting, BulgesPressedTogetherByStressReconnect)
{
  TopologyFixture f;
  const auto i = touching_bulges(f, 6);
  auto c = f.context();
  split(c, shear_xz(-2000));
  f.network.check_invariants();
  EXPECT_EQ(f.counts.splits, 1U);
  EXPECT_EQ(pinned_ends(f.network, i[2]), (std::set<std::uint32_t>{i[2].value, i[6].value}));
}

TEST(NodeSplitting, BulgesPulledApartByStressStayTwoLines)
{
  TopologyFixture f;
  const auto i = touching_bulges(f, 6);
  auto c = f.context();
  split(c, shear_xz(2000));
  f.network.check_invariants();
  EXPECT_EQ(f.counts.splits, 1U);
  EXPECT_EQ(pinned_ends(f.network, i[2]), (std::set<std::uint32_t>{i[2].value, i[4].value}));
  // Each line has moved to its own side: none has passed the other.
  for (const NodeIndex k : f.network.nodes())
    if (f.network.constraint(k) == NodeConstraint::free && std::abs(f.network.position(k)[1]) < 5)
    {
      const double side = f.network.position(f.network.other_end(f.network.connected_segments(k)[0], k))[0];
      EXPECT_GT(side * f.network.position(k)[0], 0);
    }
}

TEST(NodeSplitting, LinesOfALomerPairMakeAJunctionOnTheIntersectionOfTheirPlanes)
{
  CrossingFixture f;
  const auto i = crossing(f, fcc, "B4", "C1", -1, {20, -20});
  auto c = f.crossing_context();
  split(c);
  f.network.check_invariants();
  ASSERT_EQ(f.counts.splits, 1U);
  const Vec3 sum = fcc[*fcc.find("B4")].burgers - fcc[*fcc.find("C1")].burgers;
  const Vec3 e = Vec3(1, -1, 0).normalized();
  unsigned junctions = 0;
  for (const SegmentIndex s : f.network.segments())
    if (!f.network.plane(s).is_valid())
    {
      ++junctions;
      EXPECT_LT((f.network.burgers(s).cross(sum)).norm(), 1e-12);
      EXPECT_LT(f.network.direction(s).cross(e).norm(), 1e-12);
      EXPECT_NEAR(f.network.length(s), 1.5 * f.settings.collision_radius, 1e-9);
    }
  EXPECT_EQ(junctions, 1U);
  // The two starting points of the lines are now on the same end of the junction, and no other pair.
  EXPECT_EQ(f.network.other_end(f.network.connected_segments(i[1])[0], i[1]),
            f.network.other_end(f.network.connected_segments(i[3])[0], i[3]));
}

TEST(NodeSplitting, RepellingLinesThatTouchComeApartWithoutAJunction)
{
  CrossingFixture f;
  const auto i = crossing(f, fcc, "B4", "C1", -1, {60, -60});
  auto c = f.crossing_context();
  split(c);
  f.network.check_invariants();
  ASSERT_EQ(f.counts.splits, 1U);
  EXPECT_EQ(f.network.n_segments(), 4U);
  EXPECT_EQ(pinned_ends(f.network, i[1]), (std::set<std::uint32_t>{i[1].value, i[2].value}));
}

TEST(NodeSplitting, TheTrialFeelsTheForcesOfTheNetworkThatItMakes)
{
  // Nothing but the arms and the segments at their far ends exists, so that the local forces are all forces.
  CrossingFixture f;
  const auto i = crossing(f, fcc, "B4", "C1", -1, {20, -20});
  for (std::size_t k = 1; k < 5; ++k)
  {
    const Segment arm = f.network.get(f.network.connected_segments(i[k])[0]);
    const NodeIndex end = f.network.insert(Node{1.75 * f.network.position(i[k]), NodeConstraint::pinned});
    f.network.insert(arm.start == i[k] ? Segment{end, i[k], arm.burgers, arm.plane}
                                       : Segment{i[k], end, arm.burgers, arm.plane});
  }
  SymTensor applied;
  applied << 100, -50, 20, 30, 200, -70;
  ForceEnvironment e;
  e.applied = applied;
  SplittingModel model{aluminium, 0.8 * aluminium.a, drag};
  model.applied = applied;
  ForceSettings exact = force_settings;
  exact.core_cutoff_radius = model.core_cutoff_radius;
  model.pair_tolerance = exact.pair_tolerance = 1e-9;
  const NodeNeighbourhood node(f.network, i[0], model, compute_nodal_forces(f.network, exact, e, MPI_COMM_SELF));

  const Vec3 shift = 0.9 * Vec3(1, -1, 0).normalized();
  TrialSplit trial;
  trial.arms[0] = {0, 2};
  trial.arms[1] = {1, 3};
  trial.shift = {shift, -1.1 * shift};
  trial.burgers = -(node.arms()[0].burgers + node.arms()[2].burgers);
  const auto motion = node.motion(trial);

  auto c = f.crossing_context();
  const std::vector<SegmentIndex> second{f.network.connected_segments(i[0])[1], f.network.connected_segments(i[0])[3]};
  const NodeIndex j = detach_arms(c, i[0], second, NodeConstraint::free);
  f.network.set_position(i[0], trial.shift[0]);
  f.network.set_position(j, trial.shift[1]);
  f.network.insert(Segment{i[0], j, trial.burgers, {}});
  f.network.check_invariants();
  const auto forces = compute_nodal_forces(f.network, exact, e, MPI_COMM_SELF).total;
  const auto velocity = glide_velocities(f.network, forces, *drag, nullptr);
  EXPECT_LT((motion[0].force - forces[i[0].value]).norm(), 1e-6 * forces[i[0].value].norm());
  EXPECT_LT((motion[1].force - forces[j.value]).norm(), 1e-6 * forces[j.value].norm());
  EXPECT_LT((motion[0].velocity - velocity[i[0].value]).norm(), 1e-6 * velocity[i[0].value].norm());
  EXPECT_LT((motion[1].velocity - velocity[j.value]).norm(), 1e-6 * velocity[j.value].norm());
}

TEST(NodeSplitting, TheTrialKeepsTheForcesOfFarLinesOnTheArms)
{
  // A strong line 80 nm away; what it adds to the forces on the two parts is that of the network after the split to
  // the order of shift/arm length: it is not computed anew, and not on the junction.
  const auto forces_on_parts = [](const double strength)
  {
    CrossingFixture f;
    const auto i = crossing(f, fcc, "B4", "C1", -1, {20, -20});
    if (strength > 0)
    {
      const Vec3 middle(20, 30, 70);
      add_line(f.network, {middle - Vec3(200, 0, 0), middle, middle + Vec3(200, 0, 0)}, strength * Vec3(0, 0.2, 0.1),
               {}, false, NodeConstraint::pinned);
    }
    SplittingModel model{aluminium, aluminium.a, drag};
    const NodeNeighbourhood node(f.network, i[0], model,
                                 compute_nodal_forces(f.network, force_settings, ForceEnvironment{}, MPI_COMM_SELF));
    const Vec3 shift = 0.5 * Vec3(1, -1, 0).normalized();
    TrialSplit trial{
        {{{0, 2}, {1, 3}}}, {shift, -shift}, -(node.arms()[0].burgers + node.arms()[2].burgers), Vec3::Zero()};
    const auto motion = node.motion(trial);
    auto c = f.crossing_context();
    const std::vector<SegmentIndex> second{f.network.connected_segments(i[0])[1],
                                           f.network.connected_segments(i[0])[3]};
    const NodeIndex j = detach_arms(c, i[0], second, NodeConstraint::free);
    f.network.set_position(i[0], trial.shift[0]);
    f.network.set_position(j, trial.shift[1]);
    f.network.insert(Segment{i[0], j, trial.burgers, {}});
    const auto real = compute_nodal_forces(f.network, force_settings, ForceEnvironment{}, MPI_COMM_SELF).total;
    return std::array<Vec3, 4>{motion[0].force, motion[1].force, real[i[0].value], real[j.value]};
  };
  const auto with = forces_on_parts(20), without = forces_on_parts(0);
  for (std::size_t k = 0; k < 2; ++k)
  {
    const Vec3 expected = with[k + 2] - without[k + 2];
    EXPECT_GT(expected.norm(), 100);
    EXPECT_LT((with[k] - without[k] - expected).norm(), 0.1 * expected.norm());
  }
}

TEST(NodeSplitting, ForcesAreComputedOnceForManyNodesAndNotAtAllForNone)
{
  CrossingFixture f;
  crossing(f, fcc, "B4", "C1", -1, {20, -20});
  auto before = f.crossing_context();
  EXPECT_EQ(split(before), 1U);
  auto none = f.crossing_context();
  EXPECT_EQ(split(none), 0U); // nodes of three arms are left alone

  CrossingFixture many;
  for (int k = 0; k < 5; ++k)
  {
    const auto nodes = crossing(many, fcc, "B4", "C1", -1, {20, -20});
    for (const NodeIndex i : nodes) // along the common line of the planes, all stay on theirs
      many.network.set_position(i, many.network.position(i) + 100 * k * Vec3(1, -1, 0).normalized());
  }
  auto c = many.crossing_context();
  EXPECT_EQ(split(c), 1U);
  EXPECT_EQ(many.counts.splits, 5U);
}

TEST(FreeDirections, TheEndOfASessileJunctionMovesAlongItAndItsInsideDoesNot)
{
  const Vec3 n1 = Vec3(1, 1, 1).normalized(), n2 = Vec3(1, 1, -1).normalized(), e = Vec3(1, -1, 0).normalized();
  const ArmConstraint one{n1, n1.unitOrthogonal()}, two{n2, n2.unitOrthogonal()}, sessile{Vec3::Zero(), e};
  EXPECT_LT((free_directions(std::vector{one, two, sessile}) - e * e.transpose()).norm(), 1e-12);
  EXPECT_LT((free_directions(std::vector{one, one, sessile}) - e * e.transpose()).norm(), 1e-12);
  EXPECT_TRUE(free_directions(std::vector{sessile, sessile}).isZero(0));
  // A sessile line that is not in the glide plane of the arm holds the node.
  EXPECT_TRUE(free_directions(std::vector{one, ArmConstraint{Vec3::Zero(), n1}}).isZero(0));
  EXPECT_NEAR(free_directions(std::vector{one, one}).trace(), 2, 1e-12);
}

TEST(NodeSplitting, AFrankReadSourceClosesIntoALoopAndALine)
{
  for (const double character : {0.0, 90.0})
  {
    DislocationDriver d({aluminium, aluminium.a, drag, {15, 40, 1, 2}, {0.2, 8, 1, 1e-4, 30}}, fcc);
    const SlipSystem &s = fcc[*fcc.find("B4")];
    FrankReadSource source;
    source.plane = s.plane_miller;
    source.burgers = s.burgers;
    source.length = 200;
    source.character_angle = character;
    add_frank_read_source(d.network, Orientation{}, source, 30);
    const NodeIndex end = d.network.nodes().front();
    ASSERT_EQ(d.network.constraint(end), NodeConstraint::pinned);
    const ObjectId end_id = d.network.id(end);
    d.applied = 240 * s.schmid_tensor(); // resolved: 120 MPa
    const auto reached = [&] { return connected_nodes(d.network, *d.network.find_node(end_id)).size(); };
    for (int k = 0; k < 1500 && reached() == d.network.n_nodes(); ++k)
      d.step(1);
    d.network.check_invariants(1e-5);
    EXPECT_LT(reached(), d.network.n_nodes()) << "character " << character; // a loop has left
    // The source is still there, between both ends.
    EXPECT_EQ(pinned_ends(d.network, *d.network.find_node(end_id)).size(), 2U);
  }
}

/// Four sources on four planes through each other in a periodic box.
void add_interpenetrating_sources(Network &network, const double max_segment)
{
  const std::array<const char *, 4> names{"B4", "A3", "C1", "D6"};
  const std::array<Vec3, 4> centres{Vec3(120, 150, 150), Vec3(170, 150, 140), Vec3(150, 170, 160), Vec3(150, 130, 165)};
  for (std::size_t k = 0; k < 4; ++k)
  {
    const SlipSystem &s = fcc[*fcc.find(names[k])];
    FrankReadSource source;
    source.plane = s.plane_miller;
    source.burgers = s.burgers;
    source.centre = centres[k];
    source.length = 150;
    source.character_angle = 60;
    add_frank_read_source(network, Orientation{}, source, 0.75 * max_segment);
  }
}

TEST(NodeSplitting, CollisionsAndSplitsOfInterpenetratingSourcesDoNotUndoEachOther)
{
  const PeriodicCell cell{Vec3::Zero(), Vec3(300, 300, 300)};
  DriverSettings settings{aluminium, aluminium.a, drag, {20, 60, 1, 2}, {0.1, 5, 0.2, 1e-4, 30}};
  DislocationDriver d(settings, fcc, &cell);
  add_interpenetrating_sources(d.network, settings.topology.max_segment);
  const Vec3 axis = Vec3(2, 1, 5).normalized();
  d.applied = 150 * symmetric_part(axis * axis.transpose());
  std::vector<TopologyCounts> counts{d.counts};
  for (unsigned step = 1; step <= (samples::sanitized ? 60U : 200U); ++step)
  {
    d.step(0.2);
    d.network.check_invariants(1e-5);
    counts.push_back(d.counts);
  }
  // Lines cross in the first steps. What comes later is a few events, not one of each kind per step.
  EXPECT_GT(counts.back().collisions, 0U);
  if (samples::sanitized)
    return;
  EXPECT_LE(counts[200].splits - counts[100].splits, 5U);
  EXPECT_LE(counts[200].collisions - counts[100].collisions, 10U);
}
} // namespace
} // namespace ddfem
