// The files of a run.
#pragma once

#include "dd/network/network.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace ddfem::coupling
{
/// One row of history.csv, internal units.
struct HistoryRow
{
  unsigned step = 0;
  double time = 0, dt = 0;                      ///< ns
  double strain = 0, stress = 0;                ///< nominal, along the loading axis; MPa
  SymTensor plastic_strain = SymTensor::Zero(); ///< sample frame
  double axial_plastic_strain = 0;
  double line_length = 0, density = 0; ///< nm, 1/nm^2
  std::size_t segments = 0, nodes = 0, junctions = 0, surface_nodes = 0;
  std::size_t collisions = 0, surface_exits = 0, cross_slips = 0; ///< since the start
  double fixed_reaction = 0, platen_reaction = 0;                 ///< MPa nm^2, tension positive
  unsigned fem_iterations = 0;
  double force_imbalance = 0, moment_imbalance = 0;
  unsigned stages = 0;
  double max_speed = 0;                                           ///< nm/ns
  double wall_time = 0;                                           ///< s
  std::size_t stage = 1;                                          ///< of the loading, from 1
  double elastic_strain = 0;                                      ///< stress over modulus
  Vec3 platen_force = Vec3::Zero(), platen_moment = Vec3::Zero(); ///< MPa nm^2, MPa nm^3; sample frame, on the grain
  Vec3 fixed_force = Vec3::Zero(), fixed_moment = Vec3::Zero();
  double work = 0, stored_energy = 0, dissipated_energy = 0; ///< since the start, MPa nm^3
  double dissipated_by_topology = 0;                         ///< part of dissipated_energy
  double energy_mismatch = 0;                                ///< over the largest of work and dissipation
};

/// Writes @p content to @p path under a temporary name and renames it. Throws FileAccessError.
void write_file(const std::string &path, const std::string &content);

/// The network as an unstructured grid of lines (.vtu, ASCII, SI units): Burgers vector, plane normal, character, ids.
void write_network_vtu(const std::string &path, const Network &network);

/// Output directory of a run on rank 0: history, log and the two ParaView collections. Throws FileAccessError.
class RunOutput
{
public:
  /// Creates the directory, unless its name is empty: then nothing is written at all, which is for tests and measurements.
  /// @p write: false on the other ranks, which then write their part of the surface only.
  RunOutput(std::string directory, bool write);

  void add_history(const HistoryRow &row);
  /// A line to log.txt and, without a terminal, to standard output.
  void log(const std::string &line);
  /// A line that overwrites itself on a terminal; nothing otherwise.
  void status(const std::string &line);
  /// dislocations_NNNNNNN.vtu, and the collection up to now.
  void add_network_frame(unsigned step, double time, const Network &network);
  /// Adds a file written by the FEM to grain.pvd.
  void add_grain_frame(double time, const std::string &file);

  const std::string &directory() const { return path; }
  bool writes() const { return active; }

private:
  using Frames = std::vector<std::pair<double, std::string>>;
  void write_collection(const std::string &name, const Frames &frames) const;

  std::string path;
  bool active, terminal, status_shown = false;
  std::ofstream history, log_file;
  Frames network_frames, grain_frames;
};
} // namespace ddfem::coupling
