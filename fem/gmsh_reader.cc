#include "fem/gmsh_reader.h"

#include <deal.II/grid/grid_in.h>

#include <array>
#include <cctype>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
[[noreturn]] void fail(const std::string &file, const std::string &what)
{
  throw std::runtime_error("mesh file '" + file + "': " + what);
}

std::ifstream open(const std::string &file)
{
  std::ifstream stream(file);
  if (!stream || stream.peek() == std::ifstream::traits_type::eof())
  {
    fail(file, "cannot be opened or is empty");
  }
  return stream;
}

/// Moves to the line after `$section`; false when there is none.
bool find_section(std::istream &stream, const std::string &section)
{
  for (std::string line; std::getline(stream, line);)
  {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())))
    {
      line.pop_back();
    }
    if (line == "$" + section)
    {
      return true;
    }
  }
  return false;
}

/// Checks the format and returns the version.
std::string read_version(const std::string &file, std::istream &stream)
{
  std::string version;
  int binary = 0;
  if (!find_section(stream, "MeshFormat") || !(stream >> version >> binary))
  {
    fail(file, "is not a gmsh mesh (no $MeshFormat section)");
  }
  if (version != "2.2" && version != "4.1")
  {
    fail(file, "has gmsh format " + version + ", but 2.2 or 4.1 is needed (gmsh -format msh41)");
  }
  if (binary != 0)
  {
    fail(file, "is a binary file, but ASCII is needed (gmsh -bin 0)");
  }
  return version;
}

/// Numbers of elements by gmsh's type number.
std::map<int, std::size_t> count_elements(const std::string &file, std::istream &stream, const std::string &version)
{
  if (!find_section(stream, "Elements"))
  {
    fail(file, "has no $Elements section");
  }
  std::map<int, std::size_t> counts;
  std::string rest;
  std::size_t n_lines = 0, first = 0;
  stream >> n_lines;
  if (version == "4.1")
  {
    std::getline(stream, rest);
    for (std::size_t block = 0, n = 0; block < n_lines && stream; ++block)
    {
      int dimension = 0, entity = 0, type = 0;
      stream >> dimension >> entity >> type >> n;
      counts[type] += n;
      std::getline(stream, rest);
      for (std::size_t i = 0; i < n && std::getline(stream, rest); ++i)
      {
      }
    }
  }
  for (std::size_t i = 0; version == "2.2" && i < n_lines && stream; ++i)
  {
    int type = 0;
    stream >> first >> type;
    std::getline(stream, rest);
    counts[type] += 1;
  }
  if (!stream)
  {
    fail(file, "ends within its $Elements section");
  }
  return counts;
}

void check_elements(const std::string &file, std::map<int, std::size_t> counts)
{
  constexpr int quadrilateral = 3, hexahedron = 5;
  const std::map<int, std::string> names = {{2, "triangles"}, {4, "tetrahedra"}, {6, "prisms"}, {7, "pyramids"}};
  if (counts[hexahedron] == 0)
  {
    const std::size_t n_tetrahedra = counts[4];
    fail(file, "has no first-order hexahedra" +
                   (n_tetrahedra > 0 ? " but " + std::to_string(n_tetrahedra) + " tetrahedra" : std::string()) +
                   "; mesh with transfinite volumes and 'Recombine', and give the volume a physical group");
  }
  for (const auto &[type, count] : counts)
  {
    if (count > 0 && type != 15 && type != 1 && type != quadrilateral && type != hexahedron)
    {
      const auto name = names.find(type);
      fail(file, "has " + std::to_string(count) + " " +
                     (name != names.end() ? name->second : "elements of gmsh type " + std::to_string(type)) +
                     ", but only first-order hexahedra and their faces can be used");
    }
  }
}

void check_boundary(const std::string &file, const dealii::Triangulation<3> &triangulation)
{
  std::size_t n_bare = 0;
  dealii::Point<3> where;
  for (const auto &face : triangulation.active_face_iterators())
  {
    // gmsh numbers physical groups from 1; what no group covers keeps deal.II's 0.
    if (face->at_boundary() && face->boundary_id() == 0)
    {
      where = n_bare++ == 0 ? face->center() : where;
    }
  }
  if (n_bare > 0)
  {
    std::ostringstream text;
    text << n_bare << " boundary faces (the first at " << where << " in the file's unit) belong to no physical surface";
    fail(file, text.str());
  }
}
} // namespace

void read_gmsh(const std::string &file, dealii::Triangulation<3> &triangulation)
{
  {
    std::ifstream stream = open(file);
    const std::string version = read_version(file, stream);
    check_elements(file, count_elements(file, stream, version));
  }
  std::ifstream stream = open(file);
  try
  {
    dealii::GridIn<3> reader(triangulation);
    reader.read_msh(stream);
  }
  catch (const dealii::ExceptionBase &error)
  {
    std::ostringstream reason;
    error.print_info(reason);
    std::istringstream lines(reason.str());
    std::string line, text;
    while (std::getline(lines >> std::ws, line) && text.size() < 200)
    {
      text += (text.empty() ? "" : " ") + line;
    }
    fail(file, "cannot be read: " + text);
  }
  check_boundary(file, triangulation);
}

std::map<dealii::types::boundary_id, std::string> gmsh_surface_names(const std::string &file)
{
  std::ifstream stream = open(file);
  std::map<dealii::types::boundary_id, std::string> names;
  std::size_t n = 0;
  if (find_section(stream, "PhysicalNames") && stream >> n)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      int dimension = 0;
      unsigned id = 0;
      std::string name;
      if (!(stream >> dimension >> id >> std::ws) || !std::getline(stream, name))
      {
        fail(file, "ends within its $PhysicalNames section");
      }
      const auto first = name.find('"'), last = name.rfind('"');
      if (dimension == 2 && first < last)
      {
        names[id] = name.substr(first + 1, last - first - 1);
      }
    }
  }
  return names;
}
} // namespace ddfem::fem
