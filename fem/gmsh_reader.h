#pragma once

#include <deal.II/base/types.h>
#include <deal.II/grid/tria.h>

#include <map>
#include <string>

namespace ddfem::fem
{
/// Reads the hexahedra of an ASCII gmsh file (format 2.2 or 4.1) with deal.II's reader; boundary ids are the physical
/// surface numbers. Throws std::runtime_error with one sentence naming the file: cannot be opened, other format,
/// binary, no hexahedra, other cells besides, boundary faces without a physical surface, anything deal.II's reader
/// objects to.
void read_gmsh(const std::string &file, dealii::Triangulation<3> &triangulation);

/// Physical surfaces named in the file. Throws std::runtime_error if it cannot be opened.
std::map<dealii::types::boundary_id, std::string> gmsh_surface_names(const std::string &file);
} // namespace ddfem::fem
