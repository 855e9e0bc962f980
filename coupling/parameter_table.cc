#include "coupling/parameter_table.h"

#include <deal.II/base/patterns.h>

#include <limits>

namespace ddfem::coupling
{
namespace
{
using namespace dealii;

std::shared_ptr<const Patterns::PatternBase> positive()
{
  return std::make_shared<Patterns::Double>(std::numeric_limits<double>::min());
}
std::shared_ptr<const Patterns::PatternBase> not_negative()
{
  return std::make_shared<Patterns::Double>(0.0);
}
std::shared_ptr<const Patterns::PatternBase> between(const double low, const double high)
{
  return std::make_shared<Patterns::Double>(low, high);
}
std::shared_ptr<const Patterns::PatternBase> any_number()
{
  return std::make_shared<Patterns::Double>();
}
std::shared_ptr<const Patterns::PatternBase> count(const int low, const int high = std::numeric_limits<int>::max())
{
  return std::make_shared<Patterns::Integer>(low, high);
}
std::shared_ptr<const Patterns::PatternBase> one_of(const std::string &choices)
{
  return std::make_shared<Patterns::Selection>(choices);
}
std::shared_ptr<const Patterns::PatternBase> words()
{
  return std::make_shared<Patterns::Anything>();
}
/// Miller indices; four for hexagonal crystals.
std::shared_ptr<const Patterns::PatternBase> miller_indices()
{
  return std::make_shared<Patterns::List>(Patterns::Integer(-100, 100), 3, 4, " ");
}
/// @p n numbers separated by blanks.
std::shared_ptr<const Patterns::PatternBase> vector_of(const unsigned n)
{
  return std::make_shared<Patterns::List>(Patterns::Double(), n, n, " ");
}
std::shared_ptr<const Patterns::PatternBase> yes_no()
{
  return std::make_shared<Patterns::Bool>();
}

void add_material(std::vector<ParameterEntry> &t)
{
  const std::string s = "Material";
  t.push_back({s, "Name", "aluminium", words(), "",
               "Named material: aluminium, copper, nickel (fcc), iron, tungsten (bcc), zirconium (hcp); sources of the "
               "numbers: "
               "docs/materials.md."});
  t.push_back(
      {s, "Shear modulus", "0", not_negative(), "Pa", "Isotropic shear modulus; 0: that of the named material."});
  t.push_back({s, "Poisson ratio", "0", between(0, 0.4999), "", "Poisson's ratio; 0: that of the named material."});
  t.push_back(
      {s, "Lattice parameter", "0", not_negative(), "m", "Lattice parameter a; 0: that of the named material."});
  t.push_back({s, "Core radius", "0", not_negative(), "m",
               "Core radius a of the non-singular theory (Cai et al., JMPS 54 (2006) 561); 0: one Burgers vector."});
  t.push_back(
      {s, "Core cutoff radius", "0", not_negative(), "m",
       "Radius r_c in the core energy mu/(4 pi) ln(a/r_c) (b_s^2 + b_e^2/(1-nu)) per length, which makes the energy "
       "of a line independent of a; 0: a, that is no core energy beyond the non-singular one."});
}

void add_crystal(std::vector<ParameterEntry> &t)
{
  const std::string s = "Crystal";
  t.push_back(
      {s, "Direction along x", "1 0 0", miller_indices(), "",
       "Crystal direction along the sample axis x; orthogonal to that along z. Three Miller indices [u v w], or four "
       "[u v t w] for an hcp crystal, where 1 0 0 is 2 -1 -1 0."});
  t.push_back({s, "Direction along z", "0 0 1", miller_indices(), "",
               "Crystal direction along the sample axis z, in the same way; 0 0 1 is the c axis of an hcp crystal."});
  t.push_back(
      {s, "c over a", "0", not_negative(), "", "Axial ratio of an hcp crystal; 0: that of the named material."});
  t.push_back({s, "Slip on 123 planes", "false", yes_no(), "",
               "Let lines of a bcc crystal glide on {123} besides {110} and {112}."});
}

void add_mobility(std::vector<ParameterEntry> &t)
{
  const std::string s = "Mobility";
  t.push_back(
      {s, "Law", "linear", one_of("linear|kink pair|relaxation"), "",
       "Linear: viscous drag of phonons, with the friction stress, largest speed and climb drag below. Kink pair: bcc "
       "screws move by thermally activated kink pairs (Po et al., Acta Mater. 119 (2016) 123). Relaxation: one "
       "linear drag for all lines, to bring a network to rest; its time has no physical meaning."});
  t.push_back({s, "Edge drag", "0", not_negative(), "Pa s",
               "Drag coefficient B of edge lines: v = tau b / B; 0: that of the named material."});
  t.push_back({s, "Screw drag", "0", not_negative(), "Pa s",
               "Drag coefficient B of screw lines; 0: that of the named material."});
  t.push_back(
      {s, "Family drags", "", words(), "Pa s",
       "Drag coefficients of families of slip systems, where they differ from those above, separated by ';', each as "
       "'FAMILY: EDGE SCREW'. Families: {111}<110> (fcc); {110}<111>, {112}<111>, {123}<111>, {110}<100> (bcc); "
       "prismatic <a>, basal <a>, first-order pyramidal <a>, first-order pyramidal <c+a>, second-order pyramidal <c+a> "
       "(hcp). 'FAMILY: sessile' "
       "lets none of its lines glide. Example: basal <a>: 2e-4 2e-4; second-order pyramidal <c+a>: sessile."});
  t.push_back({s, "Friction stress", "0", not_negative(), "Pa",
               "Lattice friction: lines under a smaller resolved shear stress stay at rest (law linear)."});
  t.push_back(
      {s, "Largest speed", "0", between(0, 1), "shear-wave speed",
       "Speed that no line reaches, in parts of the speed of shear waves: the drag grows by 1/(1 - (v/c)^2) (Austin & "
       "McDowell, Int. J. Plast. 27 (2011) 1; law linear); 0: no limit."});
  t.push_back({s, "Climb drag", "0", not_negative(), "Pa s",
               "Drag coefficient of the climb of lines that have no glide plane; 0: they are sessile."});
  t.push_back({s, "Temperature", "300", positive(), "K", "Of the kink-pair law, thermal motion and cross-slip."});
  t.push_back(
      {s, "Kink drag", "0", not_negative(), "Pa s", "Drag coefficient of kinks (law kink pair); 0: of tungsten."});
  t.push_back({s, "Kink-pair enthalpy", "0", not_negative(), "eV",
               "Activation enthalpy of a kink pair without stress (law kink pair); 0: of tungsten."});
  t.push_back({s, "Kink-pair exponents", "0 0", vector_of(2), "",
               "Exponents p and q of the barrier, (1 - (tau/tau_P)^p)^q (law kink pair); zeros: of tungsten."});
  t.push_back({s, "Peierls stress", "0", not_negative(), "Pa", "tau_P (law kink pair); 0: of tungsten."});
  t.push_back({s, "Athermal temperature", "0", not_negative(), "K",
               "Temperature from which on screws need no kink pairs (law kink pair); 0: of tungsten."});
  t.push_back(
      {s, "Velocities", "local", one_of("local|consistent"), "",
       "Local: the velocity of a node follows from the forces and arms of that node. Consistent: the velocities of all "
       "nodes from one sparse system; more exact at coarse discretisation, and of smaller stable steps; "
       "not with a friction stress or kink pairs."});
  t.push_back(
      {s, "Sliding drag", "0.1", between(1e-3, 1), "drag",
       "Drag on the sliding of nodes along their lines, in parts of that across them: a numerical coefficient that "
       "slows the ends of junctions if it is large."});
  t.push_back(
      {s, "Thermal motion", "false", yes_no(), "",
       "Langevin forces of the heat bath on the lines, integrated by a method of their own: of Time stepping only "
       "Maximum step and Maximum displacement count then."});
}

void add_cross_slip(std::vector<ParameterEntry> &t)
{
  const std::string s = "Cross-slip";
  t.push_back(
      {s, "Model", "off", one_of("off|thermally activated|largest stress"), "",
       "Whether screw lines change their glide plane: at random, with the rate nu (L/L_0) "
       "exp(-[Q - V_S |tau| - V_E (sigma_c - sigma_g)]/kT) (fcc), or to the plane with the largest resolved shear "
       "stress (bcc)."});
  t.push_back({s, "Screw angle", "5", between(0, 30), "degrees",
               "Segments within this angle of their Burgers vector are screws."});
  t.push_back(
      {s, "Attempt rate", "0", not_negative(), "1/s",
       "nu, for a line of the reference length. Without this and the next three entries: the law of Kubin et al. "
       "(1992) for copper."});
  t.push_back({s, "Activation energy", "0", not_negative(), "J", "Q, without stress."});
  t.push_back({s, "Schmid volume", "0", not_negative(), "m^3",
               "V_S, activation volume of the shear stress tau along b on the cross-slip plane."});
  t.push_back(
      {s, "Escaig volume", "0", not_negative(), "m^3",
       "V_E, activation volume of the stresses that widen the stacking fault on the cross-slip plane (sigma_c) and "
       "on the glide plane (sigma_g)."});
  t.push_back({s, "Reference length", "1e-6", positive(), "m", "L_0."});
  t.push_back({s, "Stress ratio", "1", between(0, 10), "",
               "Thermally activated: the new plane's resolved shear stress over the present one's must exceed this; 0: "
               "the rate "
               "alone decides."});
  t.push_back({s, "Hysteresis", "1.1", between(1, 10), "",
               "Largest stress: the new plane's resolved shear stress over the present one's must exceed this."});
}

void add_domain(std::vector<ParameterEntry> &t)
{
  const std::string s = "Domain";
  t.push_back({s, "Shape", "box", one_of("box|cylinder|pillar|cantilever|mesh"), "",
               "Finite grain: box, cylinder (axis z), pillar (axis z, tapered, on a square base with a fillet), "
               "cantilever (beam "
               "along x that grows from the middle of a root block) or hexahedral gmsh mesh, convex or re-entrant. "
               "Periodic cell and infinite body: box; the latter "
               "uses its volume only to turn swept area into plastic strain."});
  t.push_back(
      {s, "Origin", "0 0 0", vector_of(3), "m",
       "Lowest corner of the box or of the cantilever's root block, centre of the bottom of the cylinder or of the "
       "pillar's base, or shift of the mesh."});
  t.push_back(
      {s, "Size", "1e-6 1e-6 1e-6", vector_of(3), "m", "Edge lengths of the box, or of the beam of a cantilever."});
  t.push_back({s, "Radius", "0.5e-6", positive(), "m", "Radius of the cylinder; of the pillar at its top."});
  t.push_back({s, "Height", "2e-6", positive(), "m", "Height of the cylinder; of the pillar above its base."});
  t.push_back({s, "Taper angle", "0", between(0, 44), "degrees",
               "Angle between the side and the axis of the pillar, which is narrowest at its top."});
  t.push_back(
      {s, "Fillet radius", "0", not_negative(), "m", "Radius of the fillet between pillar and base; 0: a sharp edge."});
  t.push_back({s, "Base width", "3e-6", positive(), "m", "Edge of the square base of the pillar."});
  t.push_back({s, "Base height", "1e-6", positive(), "m", "Height of the base of the pillar."});
  t.push_back({s, "Root block", "1e-6 3e-6 3e-6", vector_of(3), "m",
               "Edge lengths of the cantilever's root block, wider than the beam along y and z."});
  t.push_back(
      {s, "Mesh file", "", words(), "", "Hexahedral gmsh .msh file (format 2.2 or 4.1) with physical surfaces."});
  t.push_back({s, "Mesh unit", "1", positive(), "m", "Length of one coordinate unit of the mesh file."});
  t.push_back(
      {s, "Subdivisions", "6 6 12", std::make_shared<Patterns::List>(Patterns::Integer(1, 1000), 3, 3, " "), "",
       "Elements along x, y, z (box, beam of a cantilever); across the diameter (first), through the base of a pillar "
       "(second) and along the axis (third) of a cylinder or pillar."});
  t.push_back({s, "Refinements", "0", count(0, 6), "", "Uniform refinements of the mesh."});
  t.push_back({s, "Element degree", "2", count(1, 2), "", "Polynomial degree of the elements: 1 or 2."});
  t.push_back({s, "Elastic tolerance", "1e-5", between(1e-14, 1e-2), "",
               "Residual of the FEM solve relative to its load; the force of the correction on the segments errs by "
               "one to five times this."});
  t.push_back(
      {s, "Elastic solver", "automatic", one_of("automatic|multigrid|direct"), "",
       "Preconditioner of the conjugate gradients: algebraic multigrid, or a factorisation that is kept (MUMPS), which "
       "takes more time once and more memory. Automatic: multigrid."});
  t.push_back({s, "Correction tolerance", "1e-3", between(0, 0.1), "",
               "Steps do without an elastic solve as long as the error that this makes in the segment forces is "
               "estimated below "
               "this fraction of the force of the correction; 0: every step solves."});
  t.push_back({s, "Traction tolerance", "1e-6", between(1e-12, 1e-2), "",
               "Relative error aimed at in the integrals of the infinite-body tractions over the boundary."});
  t.push_back({s, "Image depth", "4", not_negative(), "element edges",
               "Segments nearer than this many element edges to a flat free face get analytic images; 0: none. "
               "Faces must have the whole grain on one side and must not be held."});
}

void add_boundary(std::vector<ParameterEntry> &t)
{
  const std::string s = "Boundary conditions";
  t.push_back({s, "Fixed face", "", words(), "",
               "Face held in place: x-, x+, y-, y+, z-, z+ (box), bottom, top (cylinder, pillar), root, end "
               "(cantilever), or the "
               "name of a physical surface. Empty: z-, bottom or root."});
  t.push_back({s, "Platen face", "", words(), "", "Face that the platen moves; empty: z+, top or end."});
  t.push_back(
      {s, "Platen contact", "clamped", one_of("clamped|frictionless"), "",
       "Clamped: all displacements of the two faces prescribed; frictionless: only those that drive the platen (see "
       "Platen motion)."});
  t.push_back(
      {s, "Platen motion", "axial", one_of("axial|transverse|twist|bending|none"), "",
       "Axial: along the axis. Transverse: the platen face moves along Transverse axis and is free otherwise, the "
       "fixed "
       "face is clamped (end load of a cantilever). Twist: the platen rotates about the axis (right-handed about its "
       "outward normal); the displacement along the axis is held (clamped) or free on both faces (frictionless). "
       "Bending: "
       "the platen face rotates, positive stretches the side of positive Transverse axis; its other displacements are "
       "free. None: both faces are free. Nominal strain and stress: displacement over height and force over area of "
       "the "
       "platen face; in twist those of the outermost point, in bending of the outermost fibre."});
  t.push_back({s, "Transverse axis", "x", one_of("x|y|z"), "",
               "Direction across the axis of a transverse motion, or across which the strain of a bent grain varies."});
  t.push_back(
      {s, "Impenetrable faces", "", words(), "",
       "Faces at which lines stop, separated by ';'. Lines leave through all others. Besides those named above, a "
       "cylinder has the face side, a pillar side (with the fillet), base-top, base-side, and a cantilever beam-y-, "
       "beam-y+, beam-z-, beam-z+, block."});
  t.push_back(
      {s, "Reference state", "relaxed", one_of("relaxed|perfect crystal"), "",
       "Prescribed displacements are counted from the grain relaxed with all surfaces traction-free at t = 0, or from "
       "the perfect crystal (closed loops and lines between surface points only)."});
  t.push_back({s, "Ray direction", "normal", one_of("normal|radial"), "",
               "Direction of the virtual continuation of lines that end at the surface; the total field does not "
               "depend on it."});
}

void add_loading(std::vector<ParameterEntry> &t)
{
  const std::string s = "Loading";
  t.push_back(
      {s, "Type", "strain rate", one_of("none|stress|strain rate|stages"), "",
       "Finite grain: none (relaxation between the held faces), strain rate (of the platen, nominal) or stages. "
       "Periodic cell: stress, strain rate, stages or none. Infinite body: stress, stages of given stress, or none."});
  t.push_back(
      {s, "Stages", "", words(), "",
       "List of stages for Type = stages, separated by ';', each as 'KIND [NUMBER] until END NUMBER' in SI units. "
       "Kinds: "
       "strain rate R; stress rate R; constant stress [S] (creep at the stress reached, or at S at once); free (the "
       "same "
       "at zero); hold (the displacement reached); unload R (strain rate of this magnitude towards the stress at its "
       "end). Ends: duration, strain, stress, plastic strain (strain minus stress over modulus); all but a duration "
       "count "
       "from the start of the run. Strain and stress are nominal, along the axis (see Platen motion). The last stage "
       "may lack "
       "an end; otherwise the run ends with it. Example: strain rate -1e4 until strain -2e-3; hold until duration "
       "1e-8; "
       "unload 1e4 until stress 0."});
  t.push_back(
      {s, "Stage tolerance", "1e-3", between(1e-6, 0.1), "",
       "Ends of stages that are not known beforehand (a stress under a strain rate, a plastic strain, ...) are met "
       "to this fraction of the way from the start of the stage; the steps shrink accordingly."});
  t.push_back({s, "Machine stiffness", "0", not_negative(), "N/m",
               "Stiffness of the testing machine in series with an axially or transversely loaded grain: strain rates, "
               "holds and "
               "unloading are then those of the machine's drive; 0: rigid."});
  t.push_back(
      {s, "Axis", "0 0 1", vector_of(3), "",
       "Loading axis in the sample frame (periodic cell; the finite grain is loaded along the normal of its platen)."});
  t.push_back(
      {s, "Strain rate", "-1e4", any_number(), "1/s", "Nominal strain rate along the axis; negative in compression."});
  t.push_back(
      {s, "Stress", "0 0 0 0 0 0", vector_of(6), "Pa", "Applied stress at t = 0: xx yy zz xy xz yz, sample frame."});
  t.push_back(
      {s, "Stress rate", "0 0 0 0 0 0", vector_of(6), "Pa/s", "Rate of the applied stress: xx yy zz xy xz yz."});
}

void add_microstructure(std::vector<ParameterEntry> &t)
{
  const std::string s = "Microstructure";
  t.push_back({s, "Frank-Read sources", "", words(), "",
               "Sources separated by ';', each as 'plane / Burgers direction / centre / length / character': Miller "
               "indices (three, "
               "or four in an hcp crystal), sample coordinates in m, length in m, angle between line and Burgers "
               "vector in degrees "
               "(0 screw, 90 edge). The Burgers vector is the shortest lattice translation along its direction. "
               "Example: 1 1 1 / -1 0 1 / 0 0 5e-7 / 2e-7 / 90."});
  t.push_back(
      {s, "Loops", "", words(), "",
       "Closed loops separated by ';', each as 'plane / Burgers direction / centre / radius / corners': regular "
       "polygons in the given plane. A Burgers vector out of the plane makes a prismatic loop: a side glides if a slip "
       "plane "
       "holds it and the Burgers vector, and is sessile otherwise; with 0 corners all sides lie on slip planes and "
       "touch "
       "the circle of the radius. Example: 1 1 1 / -1 0 1 / 0 0 5e-7 / 1e-7 / 24."});
  t.push_back({s, "Network file", "", words(), "",
               "ParaDiS .data file (version 4), lengths in Burgers vectors; added to the sources and loops."});
  t.push_back(
      {s, "Cut at surface", "false", yes_no(), "",
       "Finite grain: cut off what sources, loops and lines of the file reach out of the grain; otherwise nodes "
       "outside are an error."});
}

void add_discretisation(std::vector<ParameterEntry> &t)
{
  const std::string s = "Discretisation";
  t.push_back(
      {s, "Minimum segment", "10e-9", positive(), "m", "L_min: shorter segments are merged into their neighbours."});
  t.push_back(
      {s, "Maximum segment", "30e-9", positive(), "m", "L_max: longer segments are halved; at least twice L_min."});
  t.push_back({s, "Minimum area", "0", not_negative(), "m^2",
               "A node whose triangle with its neighbours is smaller is removed; 0: 0.01 L_min^2."});
  t.push_back(
      {s, "Maximum area", "0", not_negative(), "m^2",
       "Where the triangle of a node with its neighbours is larger the line is sharply bent, and segments longer "
       "than three minimum ones are halved; 0: 0.2 L_max^2."});
  t.push_back({s, "Collision radius", "0", not_negative(), "m", "Capture distance of collisions; 0: L_min / 8."});
  t.push_back(
      {s, "Collision algorithm", "continuous", one_of("continuous|proximity"), "",
       "Continuous: contacts over the whole step, in the order of time. Proximity: by distance, in sub-steps as "
       "short as the capture distance demands; slow, for comparison."});
}

void add_numerics(std::vector<ParameterEntry> &t)
{
  t.push_back({"Forces", "Pair tolerance", "1e-5", between(1e-12, 1e-1), "",
               "Error of the nodal forces between two segments relative to their largest component."});
  t.push_back(
      {"Forces", "Summation", "automatic", one_of("direct|multipole|automatic"), "",
       "Sums over lines: every pair in closed form (direct), a fast multipole method, or the latter for forces and "
       "field "
       "points from 2000 segments on, and on the surface from as many pairs of sources and points as those have."});
  t.push_back({"Forces", "Far-field tolerance", "1e-3", between(1e-8, 1e-1), "",
               "Error of the fast multipole method relative to the rms of the far field, a fifth or less relative to "
               "the total; a tenth of it on the surface."});
  t.push_back(
      {"Forces", "Far-field refresh", "every evaluation", one_of("every evaluation|adaptive|every n steps|never"), "",
       "When the far field of the fast multipole method is computed again for the forces: when its estimated "
       "error reaches half of the tolerance (adaptive), or, for comparison, every n steps or never, without it."});
  t.push_back(
      {"Forces", "Far-field interval", "20", count(1), "", "Steps between refreshes of the far field every n steps."});
  const std::string s = "Time stepping";
  t.push_back({s, "Final time", "1e-6", positive(), "s", "The run ends at this time."});
  t.push_back({s, "Maximum steps", "1000000", count(1), "", "The run ends after this many steps."});
  t.push_back({s, "Final strain", "0", not_negative(), "",
               "The run ends when the magnitude of the nominal strain reaches this; 0: never."});
  t.push_back({s, "Final plastic strain", "0", not_negative(), "",
               "The run ends when the norm of the plastic strain tensor reaches this; 0: never."});
  t.push_back({s, "Equilibrium speed", "0", not_negative(), "m/s",
               "The run ends when no node is faster than this (from the second step on); 0: never."});
  t.push_back(
      {s, "Integrator", "stabilised",
       one_of("forward Euler|trapezoid|Bogacki-Shampine|Dormand-Prince|stabilised|subcycling"), "",
       "Stabilised: second-order Runge-Kutta-Chebyshev, whose stages follow the stiffness of the lines. Subcycling: "
       "the "
       "forces of near segments are integrated with steps of their own, those of the others evaluated twice per step; "
       "for large networks. Trapezoid with corrector iterations, explicit Runge-Kutta pairs of order 3 and 5, and "
       "forward Euler: "
       "for comparison."});
  t.push_back({s, "Near distance", "0", not_negative(), "m",
               "Segments no farther apart than this are near for subcycling; 0: 3 L_min."});
  t.push_back(
      {s, "Relative tolerance", "0", between(0, 0.5), "",
       "Part of the shortest segment of a node that its position may err by per step, besides Position tolerance."});
  t.push_back({s, "Initial step", "1e-13", positive(), "s", "First time step."});
  t.push_back({s, "Maximum step", "1e-9", positive(), "s", "Largest time step."});
  t.push_back({s, "Position tolerance", "0", not_negative(), "m",
               "Estimated error of a node's position per step; 0: L_min / 50."});
  t.push_back(
      {s, "Maximum displacement", "0", not_negative(), "m", "Largest motion of a node in one step; 0: L_min / 2."});
  t.push_back({s, "Maximum stages", "30", count(2, 200), "", "Most stages of the stabilised Runge-Kutta step."});
}

void add_output(std::vector<ParameterEntry> &t)
{
  const std::string s = "Output";
  t.push_back({s, "History interval", "1", count(1), "", "Steps between two rows of history.csv."});
  t.push_back({s, "Frame interval", "50", count(0), "",
               "Steps between two frames of dislocations.pvd and grain.pvd; 0: first and last only."});
  t.push_back({s, "Check network", "true", yes_no(), "",
               "Check the invariants of the network after every step and stop when one is violated."});
}

std::vector<ParameterEntry> make_table()
{
  std::vector<ParameterEntry> t;
  t.push_back({"", "Mode", "finite", one_of("finite|periodic|infinite"), "",
               "Finite grain with its boundary conditions, periodic cell, or unbounded body."});
  t.push_back({"", "Random seed", "1", count(0), "",
               "Of all random numbers: thermal motion and cross-slip. Same seed, same run, on any number of ranks."});
  add_material(t);
  add_crystal(t);
  add_mobility(t);
  add_cross_slip(t);
  add_domain(t);
  add_boundary(t);
  add_loading(t);
  add_microstructure(t);
  add_discretisation(t);
  add_numerics(t);
  add_output(t);
  return t;
}
} // namespace

const std::vector<ParameterEntry> &parameter_table()
{
  static const std::vector<ParameterEntry> table = make_table();
  return table;
}
} // namespace ddfem::coupling
