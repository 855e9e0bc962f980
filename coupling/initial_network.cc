#include "coupling/initial_network.h"

#include "coupling/input_error.h"
#include "dd/io/file_error.h"
#include "dd/io/paradis_data.h"
#include "dd/microstructure/adopt_slip_planes.h"

#include <cmath>
#include <sstream>

namespace ddfem::coupling
{
namespace
{
std::string in_metres(const Vec3 &x)
{
  std::ostringstream out;
  out << "(" << x[0] * 1e-9 << ", " << x[1] * 1e-9 << ", " << x[2] * 1e-9 << ") m";
  return out.str();
}

/// Why a Burgers vector does not glide.
std::string complaint(const SlipSystems &systems, const Vec3 &burgers)
{
  const std::string crystal = std::string(" of this ") + name_of(systems.lattice()) + " crystal";
  const auto type = systems.burgers_type(burgers);
  if (!type)
    return "is no translation" + crystal;
  return std::string("is ") + name_of(*type) + crystal + " and sessile";
}

Network read_network(const Parameters &p)
{
  if (p.network_file.empty())
    return {};
  ParadisReadOptions options;
  options.burgers_magnitude = p.burgers_magnitude;
  if (p.lattice != Lattice::hcp)
    options.cubic_orientation = p.orientation;
  options.periodic = p.mode == Mode::periodic;
  options.strict = true;
  try
  {
    ParadisData data = read_paradis_data(p.network_file, options);
    const Vec3 edges = data.upper - data.lower;
    if (p.mode == Mode::periodic && (edges - p.cell.lengths).norm() > 1e-6 * edges.norm())
      throw InputError(p.network_file + ": the periodic cell of the file has edges " + in_metres(edges) +
                       ", Domain/Size is " + in_metres(p.cell.lengths));
    if (p.lattice == Lattice::hcp) // normals of a hexagonal crystal are no integers: compared with the slip planes
      adopt_slip_planes(data.network, p.slip_systems());
    return std::move(data.network);
  }
  catch (const FileError &e)
  {
    throw InputError(e.what());
  }
}
} // namespace

Network build_network(const Parameters &p)
{
  const SlipSystems systems = p.slip_systems();
  Network network = read_network(p);
  if (p.mode == Mode::periodic)
    network.set_period(p.cell.lengths);
  for (const FrankReadSource &source : p.sources)
    add_frank_read_source(network, p.orientation, source, 0.75 * p.topology.max_segment);
  for (const PolygonLoop &loop : p.loops)
    add_polygon_loop(network, systems, loop, p.topology.max_segment);
  for (const SegmentIndex s : network.segments())
    if (network.plane(s).is_valid() && systems.glissile_planes(network.burgers(s)).empty())
      throw InputError("Microstructure: segment " + std::to_string(network.id(s)) +
                       " has a glide plane but the Burgers vector " + in_metres(network.burgers(s)) + ", which " +
                       complaint(systems, network.burgers(s)) +
                       "; Burgers vectors that glide: " + systems.glissile_types());
  for (const NodeIndex i : network.nodes())
    if (p.mode != Mode::finite && network.constraint(i) == NodeConstraint::surface)
      throw InputError("Microstructure: node " + std::to_string(network.id(i)) +
                       " is a surface node; only a finite grain has a surface");
  const auto violations = network.violations();
  if (!violations.empty())
    throw InputError("Microstructure: " + violations.front().message);
  return network;
}

void fit_into_grain(Network &network, const GrainShape &shape, const double min_segment)
{
  const double tolerance = 1e-3 * min_segment;
  for (const NodeIndex i : network.nodes())
  {
    const Vec3 x = network.position(i);
    const double phi = shape.signed_distance(x);
    const bool surface = network.constraint(i) == NodeConstraint::surface;
    if (phi > tolerance)
      throw InputError("Microstructure: node " + std::to_string(network.id(i)) + " at " + in_metres(x) + " lies " +
                       std::to_string(phi) + " nm outside the grain; all nodes must be inside or on the surface");
    if (!surface)
      continue;
    const auto arms = network.connected_segments(i);
    const auto y = project_to_surface(shape, x, arms.empty() ? Vec3(Vec3::Zero()) : network.normal(arms[0]));
    if (!y || (*y - x).norm() > tolerance + 1e-3 * shape.diameter())
      throw InputError("Microstructure: surface node " + std::to_string(network.id(i)) + " at " + in_metres(x) +
                       " is not on the surface of the grain");
    network.set_position(i, *y);
  }
}
} // namespace ddfem::coupling
