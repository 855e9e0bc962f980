#include "coupling/microstructure_input.h"

#include "coupling/input_error.h"
#include "dd/common/units.h"
#include "dd/crystal/miller_bravais.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace ddfem::coupling
{
namespace
{
/// The fields of one item 'a / b / c'; exactly @p n.
std::vector<std::string> fields(const InputDeck &deck, const std::string &path, const std::string &item,
                                const std::size_t n, const std::string &form)
{
  std::istringstream in(item);
  std::vector<std::string> result;
  for (std::string f; std::getline(in, f, '/');)
    result.push_back(f);
  if (result.size() != n)
    deck.reject(path, "'" + item + "' has " + std::to_string(result.size()) + " fields; allowed is '" + form + "'");
  return result;
}

std::vector<double> field_numbers(const InputDeck &deck, const std::string &path, const std::string &text,
                                  const std::size_t n)
{
  std::istringstream in(text);
  std::vector<double> result;
  for (double x = 0; in >> x;)
    result.push_back(x);
  if (!in.eof() || result.size() != n)
    deck.reject(path, "'" + text + "' must be " + std::to_string(n) + (n == 1 ? " number" : " numbers"));
  return result;
}

/// "hcp crystal; Burgers vectors that glide: 1/3<11-20>, 1/3<11-23>".
std::string crystal_with_burgers_vectors(const SlipSystems &systems)
{
  return std::string(name_of(systems.lattice())) + " crystal; Burgers vectors that glide: " + systems.glissile_types();
}

/// The shortest lattice translation along @p direction, nm; must be one that glides on some plane of the crystal.
Vec3 read_burgers(const InputDeck &deck, const std::string &path, const SlipSystems &systems, const Miller &direction)
{
  Vec3 b = shortest_translation(systems.lattice(), systems.lattice_parameter(), systems.orientation(), direction);
  if (systems.glissile_planes(b).empty())
    deck.reject(path, systems.orientation().cell().direction_name(direction) +
                          " is not the direction of a Burgers vector that glides in this " +
                          crystal_with_burgers_vectors(systems));
  return b;
}

/// The slip planes of a Burgers vector, by name: "(0-11), (101)".
std::string names_of_planes(const SlipSystems &systems, const Vec3 &burgers)
{
  std::string names;
  for (const std::size_t k : systems.glissile_planes(burgers))
    names += (names.empty() ? "" : ", ") + systems.orientation().cell().plane_name(systems.planes()[k].miller);
  return names;
}

/// Whether the crystal slips along @p burgers on the planes @p plane.
bool glides_on(const SlipSystems &systems, const Vec3 &burgers, const Miller &plane)
{
  return std::ranges::any_of(systems.glissile_planes(burgers), [&](const std::size_t k)
                             { return without_sense(systems.planes()[k].miller) == without_sense(plane); });
}

void read_sources(const InputDeck &deck, const SlipSystems &systems, Parameters &p)
{
  const std::string path = "Microstructure/Frank-Read sources";
  const UnitCell &cell = p.orientation.cell();
  for (const std::string &item : deck.items(path))
  {
    const auto f = fields(deck, path, item, 5, "plane / Burgers direction / centre / length / character");
    FrankReadSource source;
    source.plane = read_miller(deck, path, f[0], IndicesOf::plane, p.lattice);
    const Miller direction = read_miller(deck, path, f[1], IndicesOf::direction, p.lattice);
    source.burgers = read_burgers(deck, path, systems, direction);
    if (dot(source.plane, direction) != 0)
      deck.reject(path, "b . n is not zero: " + cell.direction_name(direction) + " does not lie in the plane " +
                            cell.plane_name(source.plane));
    if (!glides_on(systems, source.burgers, source.plane))
      deck.reject(path, cell.plane_name(source.plane) + " is not a slip plane of " + cell.direction_name(direction) +
                            " in this " + name_of(p.lattice) + " crystal; allowed are " +
                            names_of_planes(systems, source.burgers));
    source.centre = to_vec3(field_numbers(deck, path, f[2], 3)) * units::metre;
    source.length = field_numbers(deck, path, f[3], 1)[0] * units::metre;
    source.character_angle = field_numbers(deck, path, f[4], 1)[0];
    if (source.length <= 0)
      deck.reject(path, "the length of a source must be positive");
    p.sources.push_back(source);
  }
}

void read_loops(const InputDeck &deck, const SlipSystems &systems, Parameters &p)
{
  const std::string path = "Microstructure/Loops";
  const UnitCell &cell = p.orientation.cell();
  for (const std::string &item : deck.items(path))
  {
    const auto f = fields(deck, path, item, 5, "plane / Burgers direction / centre / radius / corners");
    PolygonLoop loop;
    loop.plane = read_miller(deck, path, f[0], IndicesOf::plane, p.lattice);
    const Miller direction = read_miller(deck, path, f[1], IndicesOf::direction, p.lattice);
    loop.burgers = read_burgers(deck, path, systems, direction);
    const bool glide = dot(loop.plane, direction) == 0;
    if (glide && !glides_on(systems, loop.burgers, loop.plane))
      deck.reject(path, cell.direction_name(direction) + " lies in " + cell.plane_name(loop.plane) +
                            " but does not glide there; allowed are " + names_of_planes(systems, loop.burgers) +
                            ", and planes that do not hold it");
    loop.centre = to_vec3(field_numbers(deck, path, f[2], 3)) * units::metre;
    loop.radius = field_numbers(deck, path, f[3], 1)[0] * units::metre;
    const double corners = field_numbers(deck, path, f[4], 1)[0];
    const bool on_slip_planes = corners == 0 && !glide;
    if (loop.radius <= 0 || !(corners >= 3 || on_slip_planes) || corners > 1000 || corners != std::floor(corners))
      deck.reject(path, "a loop needs a positive radius and 3 to 1000 corners, or 0 for a loop with b out of its plane "
                        "whose sides lie on slip planes");
    loop.corners = static_cast<unsigned>(corners);
    p.loops.push_back(loop);
  }
}
} // namespace

Miller read_miller(const InputDeck &deck, const std::string &path, const std::string &text, const IndicesOf what,
                   const Lattice lattice)
{
  std::istringstream in(text);
  std::vector<int> m;
  for (int index = 0; in >> index;)
    m.push_back(index);
  const bool four = lattice == Lattice::hcp && m.size() == 4;
  if (!in.eof() || !(m.size() == 3 || four) || std::ranges::all_of(m, [](const int index) { return index == 0; }))
    deck.reject(path, "'" + text + "' must be three " + (lattice == Lattice::hcp ? "or four " : "") +
                          "integer Miller indices of the " + name_of(lattice) + " crystal, not all zero");
  if (!four)
    return {m[0], m[1], m[2]};
  try
  {
    const MillerBravais indices = {m[0], m[1], m[2], m[3]};
    return what == IndicesOf::plane ? plane_from_four_indices(indices) : direction_from_four_indices(indices);
  }
  catch (const std::invalid_argument &e)
  {
    deck.reject(path, e.what());
  }
}

void read_microstructure(const InputDeck &deck, Parameters &p)
{
  const SlipSystems systems = p.slip_systems();
  read_sources(deck, systems, p);
  read_loops(deck, systems, p);
  p.cut_at_surface = deck.flag("Microstructure/Cut at surface");
  if (const std::string file = deck.text("Microstructure/Network file"); !file.empty())
  {
    p.network_file = (std::filesystem::path(deck.directory()) / file).string();
    if (!std::filesystem::is_regular_file(p.network_file))
      deck.reject("Microstructure/Network file", "there is no file " + p.network_file);
  }
}
} // namespace ddfem::coupling
