// The same grain with the same sources on different meshes: regular, distorted and read from a file, finer. What the history says
// is compared between meshes, and with the balances that hold on every one of them.
#pragma once

#include "coupling/simulation.h"
#include "fem/cylinder.h"
#include "image_field.h"
#include "tests/support/history.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace ddfem::validation
{
using test::Columns;

/// Dimensions in nm; the axis is z, the bottom z = 0.
constexpr double pillar_width = 400, pillar_height = 900;

enum class Section
{
  square,
  circle
};

/// Cells across and along.
struct Cells
{
  unsigned across, along;
};

/// A file in the directory of temporary files that disappears with the object.
class TemporaryPath
{
public:
  explicit TemporaryPath(const std::string &name)
      : path((std::filesystem::temp_directory_path() / ("ddfem_" + name + std::to_string(getpid()))).string())
  {
  }
  ~TemporaryPath() { std::filesystem::remove_all(path); }
  TemporaryPath(const TemporaryPath &) = delete;
  TemporaryPath &operator=(const TemporaryPath &) = delete;
  const std::string path;
};

/// Radius of the circle with the area of the square.
inline double pillar_radius()
{
  return pillar_width / std::sqrt(M_PI);
}

/// Physical surface of a face of the boundary: 1 to 4 the sides, 5 bottom, 6 top. A round side is one surface, 1. Flat sides are
/// surfaces of their own: only then do they get images.
inline int physical_surface(const Section section, const dealii::Triangulation<3>::face_iterator &face)
{
  const auto is_at = [&](const unsigned axis, const double x)
  { return std::abs(face->vertex(0)[axis] - x) < 1e-6 && std::abs(face->vertex(3)[axis] - x) < 1e-6; };
  if (is_at(2, 0))
    return 5;
  if (is_at(2, pillar_height))
    return 6;
  if (section == Section::square)
    for (const unsigned axis : {0U, 1U})
      for (const int side : {0, 1})
        if (is_at(axis, (side - 0.5) * pillar_width))
          return 1 + 2 * static_cast<int>(axis) + side;
  return 1;
}

/// Writes a mesh in gmsh's format 2.2.
inline void write_gmsh(const dealii::Triangulation<3> &mesh, const Section section, const std::string &file)
{
  std::ofstream out(file);
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.n_vertices() << '\n';
  for (unsigned v = 0; v < mesh.n_vertices(); ++v)
    out << v + 1 << ' ' << mesh.get_vertices()[v] << '\n';
  std::vector<std::string> elements;
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary())
    {
      const std::string id = std::to_string(physical_surface(section, face));
      elements.push_back("3 2 " + id + ' ' + id);
      for (const unsigned v : {0U, 1U, 3U, 2U})
        elements.back() += ' ' + std::to_string(face->vertex_index(v) + 1);
    }
  for (const auto &cell : mesh.active_cell_iterators())
  {
    elements.emplace_back("5 2 1 1");
    for (const unsigned v : {0U, 1U, 3U, 2U, 4U, 5U, 7U, 6U})
      elements.back() += ' ' + std::to_string(cell->vertex_index(v) + 1);
  }
  out << "$EndNodes\n$Elements\n" << elements.size() << '\n';
  for (std::size_t e = 0; e < elements.size(); ++e)
    out << e + 1 << ' ' << elements[e] << '\n';
  out << "$EndElements\n";
}

/// Writes the mesh of a pillar with its inner vertices moved by up to @p factor of their shortest edge. The sides of the cells are
/// straight.
inline void write_distorted_mesh(const std::string &file, const Section section, const Cells &cells,
                                 const double factor)
{
  dealii::Triangulation<3> mesh;
  if (section == Section::square)
    dealii::GridGenerator::subdivided_hyper_rectangle(
        mesh, {cells.across, cells.across, cells.along}, dealii::Point<3>(-pillar_width / 2, -pillar_width / 2, 0),
        dealii::Point<3>(pillar_width / 2, pillar_width / 2, pillar_height));
  else
    fem::make_cylinder(mesh, pillar_radius(), pillar_height, cells.across, cells.along);
  dealii::GridTools::distort_random(factor, mesh, true, 7);
  write_gmsh(mesh, section, file);
}

/// An aluminium pillar with three sources on two slip planes. @p mesh_file: empty for the program's own mesh.
inline coupling::InputDeck pillar_deck(const Section section, const Cells &cells, const unsigned degree,
                                       const std::string &mesh_file, const std::string &stages)
{
  std::vector<std::string> entries{
      "Crystal/Direction along x=1 2 -1",
      "Crystal/Direction along z=-1 3 5",
      "Domain/Element degree=" + std::to_string(degree),
      "Boundary conditions/Platen contact=frictionless",
      "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 4.5e-7 / 2e-7 / 90; "
      "1 1 1 / -1 0 1 / -4e-8 5e-8 3.2e-7 / 1.6e-7 / 60; -1 -1 1 / 0 1 1 / 5e-8 -4e-8 6e-7 / 1.8e-7 / 90",
      "Discretisation/Minimum segment=1.5e-8",
      "Discretisation/Maximum segment=4e-8",
      "Time stepping/Maximum steps=4000",
      "Time stepping/Initial step=1e-12",
      "Output/Frame interval=0",
      "Loading/Type=stages",
      "Loading/Stages=" + stages};
  const auto add = [&](const std::string &entry) { entries.push_back(entry); };
  const std::string subdivisions =
      std::to_string(cells.across) + " " + std::to_string(cells.across) + " " + std::to_string(cells.along);
  if (!mesh_file.empty())
    for (const char *e : {"Domain/Shape=mesh", "Domain/Mesh unit=1e-9", "Boundary conditions/Fixed face=5",
                          "Boundary conditions/Platen face=6"})
      add(e);
  if (!mesh_file.empty())
    add("Domain/Mesh file=" + mesh_file);
  else if (section == Section::square)
    for (const char *e : {"Domain/Origin=-2e-7 -2e-7 0", "Domain/Size=4e-7 4e-7 9e-7"})
      add(e);
  else
    for (const std::string &e : {std::string("Domain/Shape=cylinder"), std::string("Domain/Height=9e-7"),
                                 "Domain/Radius=" + std::to_string(pillar_radius()) + "e-9"})
      add(e);
  add("Domain/Subdivisions=" + subdivisions);
  coupling::InputDeck deck;
  for (const std::string &e : entries)
    deck.set_from_command_line(e);
  return deck;
}

/// Runs a deck and reads its history back.
inline Columns history_of(const coupling::InputDeck &deck)
{
  coupling::Simulation simulation(coupling::interpret(deck), MPI_COMM_WORLD);
  const TemporaryPath directory("pillar_meshes_out");
  {
    coupling::RunOutput output(directory.path, true);
    simulation.run(output);
  }
  return test::read_history(directory.path + "/history.csv");
}

/// @p images: of the lines near flat sides.
inline Columns run_pillar(const Section section, const Cells &cells, const unsigned degree, const bool distorted,
                          const std::string &stages, const bool images = true)
{
  const TemporaryPath file("pillar_mesh.msh");
  if (distorted)
    write_distorted_mesh(file.path, section, cells, 0.2);
  coupling::InputDeck deck = pillar_deck(section, cells, degree, distorted ? file.path : "", stages);
  if (!images)
    deck.set_from_command_line("Domain/Image depth=0");
  return history_of(deck);
}

/// What must hold on every mesh.
inline void check_balances(Report &report, const std::string &name, const Columns &h)
{
  const auto &strain = h.at("strain [-]"), &elastic = h.at("elastic strain [-]"),
             &plastic = h.at("axial plastic strain [-]"), &work = h.at("work [J]");
  double worst_strain = 0, worst_energy = 0, largest_work = 0;
  for (std::size_t i = 0; i < strain.size(); ++i)
  {
    worst_strain = std::max(worst_strain, std::abs(strain[i] - elastic[i] - plastic[i]));
    worst_energy =
        std::max(worst_energy, std::abs(work[i] - h.at("stored energy [J]")[i] - h.at("dissipated energy [J]")[i]));
    largest_work = std::max(largest_work, std::abs(work[i]));
  }
  report.below(name + ": stress at the start / largest (sources are lines minus themselves)",
               h.at("stress [Pa]")[0] / h.at("stress [Pa]").back(), 1e-12);
  report.below(name + ": plastic strain - (total - elastic) / last", worst_strain / std::abs(plastic.back()), 1e-3);
  report.below(name + ": work - stored - dissipated / work", worst_energy / largest_work, 0.01);
}

/// A quantity of a history at a strain, linearly between the rows.
inline double at_strain(const Columns &h, const std::string &column, const double strain)
{
  const auto &x = h.at("strain [-]"), &y = h.at(column);
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i] - strain) * (x[i - 1] - strain) <= 0 && x[i] != x[i - 1])
      return y[i - 1] + (strain - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
  return y.back();
}

/// Largest difference of the stress at the same strain, over the largest stress. Both are compressed without unloading.
inline double difference_of_curves(const Columns &a, const Columns &b)
{
  const double end = std::max(a.at("strain [-]").back(), b.at("strain [-]").back()); // compression: the smaller one
  double worst = 0, scale = 0;
  constexpr int n = 200;
  for (int k = 1; k <= n; ++k)
  {
    const double e = end * k / n, s = at_strain(a, "stress [Pa]", e);
    worst = std::max(worst, std::abs(at_strain(b, "stress [Pa]", e) - s));
    scale = std::max(scale, std::abs(s));
  }
  return worst / scale;
}
} // namespace ddfem::validation
