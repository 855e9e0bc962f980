#pragma once

#include "fem/elastic_system.h"
#include "fem/nodal_grid.h"

#include <string>
#include <vector>

namespace ddfem::fem
{
/// Nodal fields on the boundary, for each local node. Units nm and MPa.
struct SurfaceFields
{
  const NodalVector &total_displacement;
  const NodalVector &correction_displacement;
  const std::vector<double> &correction_stress; // six for each node
};

/// Writes the boundary faces as VTU, one file for each rank and a .pvtu record, in SI units; see
/// ElasticProblem::write_surface(). Collective. Returns the path of the record. Throws std::runtime_error on all ranks
/// when any of the files cannot be written.
std::string write_surface_files(const NodalGrid &grid, const SurfaceFields &fields, const std::string &directory,
                                const std::string &base_name);
} // namespace ddfem::fem
