#include "fem/surface_output.h"

#include <deal.II/base/data_out_base.h>
#include <deal.II/grid/reference_cell.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
constexpr double metre_per_nm = 1e-9, pascal_per_mpa = 1e6;

double von_mises(const double *s)
{
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3. * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/// Boundary faces as patches for deal.II's writers.
class Surface : public dealii::DataOutInterface<2, 3>
{
public:
  Surface(const NodalGrid &grid, const SurfaceFields &fields)
  {
    for (const auto &face : grid.faces)
    {
      patches.push_back(make_patch(grid, fields, face));
    }
  }

private:
  using Patch = dealii::DataOutBase::Patch<2, 3>;
  static constexpr unsigned n_rows = 8, n_coordinates = 3;

  Patch make_patch(const NodalGrid &grid, const SurfaceFields &fields, const NodalGrid::Face &face) const
  {
    const auto nodes = face_nodes(grid.degree, face.number);
    const auto n = static_cast<unsigned>(nodes.size());
    Patch patch;
    patch.patch_index = static_cast<unsigned>(patches.size());
    patch.n_subdivisions = grid.degree;
    patch.reference_cell = dealii::ReferenceCells::Quadrilateral; // otherwise the writer makes cells without corners
    patch.points_are_available = true;
    patch.data.reinit(n_rows + n_coordinates, n);
    for (unsigned a = 0; a < n; ++a)
    {
      const unsigned node = grid.nodes_of(face.cell)[nodes[a]];
      const auto set = [&](unsigned row, double value) { patch.data(row, a) = static_cast<float>(value); };
      for (unsigned c = 0; c < 3; ++c)
      {
        set(c, metre_per_nm * fields.total_displacement.local_element(3 * node + c));
        set(3 + c, metre_per_nm * fields.correction_displacement.local_element(3 * node + c));
        set(n_rows + c, metre_per_nm * grid.positions[node][c]);
      }
      set(6, pascal_per_mpa * von_mises(&fields.correction_stress[6 * std::size_t{node}]));
      set(7, face.boundary);
    }
    // Corners in the order of deal.II's quadrilateral: lexicographic.
    const std::array<unsigned, 4> corners = {0, grid.degree, n - 1 - grid.degree, n - 1};
    for (unsigned v = 0; v < 4; ++v)
    {
      patch.vertices[v] = metre_per_nm * grid.positions[grid.nodes_of(face.cell)[nodes[corners[v]]]];
    }
    return patch;
  }

  const std::vector<Patch> &get_patches() const override { return patches; }

  std::vector<std::string> get_dataset_names() const override
  {
    return {"displacement_m",
            "displacement_m",
            "displacement_m",
            "correction_displacement_m",
            "correction_displacement_m",
            "correction_displacement_m",
            "correction_von_mises_Pa",
            "boundary_id"};
  }

  std::vector<
      std::tuple<unsigned, unsigned, std::string, dealii::DataComponentInterpretation::DataComponentInterpretation>>
  get_nonscalar_data_ranges() const override
  {
    const auto vector = dealii::DataComponentInterpretation::component_is_part_of_vector;
    return {{0, 2, "displacement_m", vector}, {3, 5, "correction_displacement_m", vector}};
  }

  std::vector<Patch> patches;
};

/// Writes aside and renames, so that the file is never there by half.
bool write_file(const std::string &path, const std::function<void(std::ostream &)> &write)
{
  const std::string temporary = path + ".tmp";
  {
    std::ofstream stream(temporary);
    if (!stream)
    {
      return false;
    }
    write(stream);
    if (!stream.flush())
    {
      return false;
    }
  }
  return std::rename(temporary.c_str(), path.c_str()) == 0;
}

void check_all(bool good, const std::string &path, MPI_Comm communicator)
{
  int all_good = good ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all_good, 1, MPI_INT, MPI_MIN, communicator);
  if (all_good == 0)
  {
    throw std::runtime_error("cannot write the surface output '" + path + "' (or that of another rank)");
  }
}
} // namespace

std::string write_surface_files(const NodalGrid &grid, const SurfaceFields &fields, const std::string &directory,
                                const std::string &base_name)
{
  int rank = 0, n_ranks = 1;
  MPI_Comm_rank(grid.communicator, &rank);
  MPI_Comm_size(grid.communicator, &n_ranks);
  std::vector<std::string> names;
  for (int r = 0; r < n_ranks; ++r)
  {
    names.push_back(base_name + "." + std::to_string(r) + ".vtu");
  }
  const Surface surface(grid, fields);
  const std::string own = directory + "/" + names[static_cast<std::size_t>(rank)];
  check_all(write_file(own, [&](std::ostream &stream) { surface.write_vtu(stream); }), own, grid.communicator);
  const std::string record = directory + "/" + base_name + ".pvtu";
  const bool written =
      rank != 0 || write_file(record, [&](std::ostream &stream) { surface.write_pvtu_record(stream, names); });
  check_all(written, record, grid.communicator);
  return record;
}
} // namespace ddfem::fem
