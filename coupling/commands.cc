#include "coupling/commands.h"

#include "coupling/input_error.h"
#include "coupling/parameter_table.h"
#include "coupling/simulation.h"
#include "dd/common/units.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace ddfem::coupling
{
namespace
{
bool is_first_rank(MPI_Comm communicator)
{
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  return rank == 0;
}

InputDeck read_deck(const InputArguments &arguments)
{
  InputDeck deck;
  deck.read(arguments.input);
  for (const std::string &a : arguments.assignments)
    deck.set_from_command_line(a);
  return deck;
}

std::vector<std::string> split(const std::string &line)
{
  std::istringstream in(line);
  std::vector<std::string> cells;
  for (std::string c; std::getline(in, c, ',');)
  {
    c.erase(std::remove_if(c.begin(), c.end(), [](char ch) { return ch == ' ' || ch == '\r' || ch == '"'; }), c.end());
    cells.push_back(c);
  }
  return cells;
}

/// Column of coordinate @p name in the header; units in the header ("x [m]" or "x") are accepted.
std::size_t column_of(const std::vector<std::string> &header, const std::string &name, const std::string &file)
{
  for (std::size_t k = 0; k < header.size(); ++k)
    if (header[k] == name || header[k] == name + "[m]")
      return k;
  throw InputError(file + ":1: there is no column '" + name + "'; needed are x, y, z in m");
}

void write_stress(std::ostream &out, const SymTensor &s)
{
  for (Eigen::Index c = 0; c < 6; ++c)
    out << "," << s[c] / units::pascal;
}

void require_inside(const std::vector<Vec3> &points, const FiniteGrain &grain, const std::string &file)
{
  for (std::size_t k = 0; k < points.size(); ++k)
    if (grain.shape().signed_distance(points[k]) > 1e-9 * grain.shape().diameter())
      throw InputError(file + ":" + std::to_string(k + 2) + ": the point lies outside the grain");
}
} // namespace

std::vector<std::array<double, 3>> read_points(const std::string &file)
{
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line))
    throw InputError(file + ": cannot be read, or is empty");
  const auto header = split(line);
  const std::array<std::size_t, 3> columns{column_of(header, "x", file), column_of(header, "y", file),
                                           column_of(header, "z", file)};
  std::vector<std::array<double, 3>> points;
  for (unsigned number = 2; std::getline(in, line); ++number)
  {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    const auto cells = split(line);
    std::array<double, 3> x{};
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::string cell = columns[c] < cells.size() ? cells[columns[c]] : "";
      std::istringstream value(cell);
      std::string rest;
      if (!(value >> x[c]) || (value >> rest))
        throw InputError(file + ":" + std::to_string(number) + ": '" + cell + "' is not a number");
      x[c] *= units::metre;
    }
    points.push_back(x);
  }
  return points;
}

int run_command(const InputArguments &arguments, const std::string &directory, MPI_Comm communicator)
{
  const InputDeck deck = read_deck(arguments);
  Simulation simulation(interpret(deck), communicator);
  RunOutput output(directory, is_first_rank(communicator));
  MPI_Barrier(communicator); // the directory exists before another rank writes into it
  if (output.writes())
    write_file(directory + "/parameters.prm", deck.as_prm());
  output.log(simulation.summary());
  const RunEnd end = simulation.run(output);
  if (end == RunEnd::interrupted)
  {
    output.log("stopped by a signal; the results up to this step are in " + directory);
    return exit_interrupted;
  }
  output.log("done; results in " + directory);
  return exit_success;
}

int check_command(const InputArguments &arguments, MPI_Comm communicator)
{
  const InputDeck deck = read_deck(arguments);
  const Simulation simulation(interpret(deck), communicator);
  if (is_first_rank(communicator))
    std::cout << arguments.input << ": valid\n" << simulation.summary();
  return exit_success;
}

int parameters_command(const std::string &format)
{
  if (format == "md")
    std::cout << parameters_as_markdown();
  else
    std::cout << (format == "json" ? InputDeck().as_json() : InputDeck().as_prm());
  return exit_success;
}

int field_command(const InputArguments &arguments, const std::string &points_file, const std::string &output_file,
                  MPI_Comm communicator)
{
  const InputDeck deck = read_deck(arguments);
  Simulation simulation(interpret(deck), communicator);
  std::vector<Vec3> points;
  for (const auto &x : read_points(points_file))
    points.emplace_back(x[0], x[1], x[2]);
  if (simulation.grain())
    require_inside(points, *simulation.grain(), points_file);
  simulation.start();
  const auto infinite = simulation.infinite_stress(points);
  const auto correction = simulation.correction_stress(points);
  std::ostringstream out;
  out << std::setprecision(15) << "x [m],y [m],z [m]";
  for (const char *field : {"infinite", "correction", "total"})
    for (const char *component : {"xx", "yy", "zz", "xy", "xz", "yz"})
      out << ",sigma_" << component << " " << field << " [Pa]";
  out << "\n";
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const Vec3 x = points[k] / units::metre;
    out << x[0] << "," << x[1] << "," << x[2];
    write_stress(out, infinite[k]);
    write_stress(out, correction[k]);
    write_stress(out, infinite[k] + correction[k] + simulation.applied_stress());
    out << "\n";
  }
  if (is_first_rank(communicator))
    write_file(output_file, out.str());
  return exit_success;
}

int forces_command(const InputArguments &arguments, const std::string &output_file, MPI_Comm communicator)
{
  const InputDeck deck = read_deck(arguments);
  Simulation simulation(interpret(deck), communicator);
  simulation.start();
  const NodalForces forces = simulation.forces();
  const Network &network = simulation.network();
  std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  std::sort(nodes.begin(), nodes.end(), [&](auto a, auto b) { return network.id(a) < network.id(b); });
  std::ostringstream out;
  out << std::setprecision(15) << "node id,x [m],y [m],z [m]";
  const auto columns = [&](const std::string &name)
  {
    for (const char *c : {"x", "y", "z"})
      out << ",f_" << c << " " << name << " [N]";
  };
  for (std::size_t c = 0; c < n_force_contributions; ++c)
    columns(name_of(static_cast<ForceContribution>(c)));
  columns("total");
  out << "\n";
  for (const NodeIndex i : nodes)
  {
    out << network.id(i);
    const auto put = [&](const Vec3 &v) { out << "," << v[0] << "," << v[1] << "," << v[2]; };
    put(network.position(i) / units::metre);
    for (const auto &contribution : forces.by_contribution)
      put(contribution[i.value] / units::newton);
    put(forces.total[i.value] / units::newton);
    out << "\n";
  }
  if (is_first_rank(communicator))
    write_file(output_file, out.str());
  return exit_success;
}
} // namespace ddfem::coupling
