// The commands of the ddfem program. Each returns the exit status.
#pragma once

#include <mpi.h>

#include <array>
#include <string>
#include <vector>

namespace ddfem::coupling
{
/// Exit status of the program (0 is success).
enum ExitStatus : int
{
  exit_success = 0,
  exit_failure = 1,     ///< numerical or internal failure
  exit_input = 2,       ///< usage or invalid input
  exit_file = 3,        ///< file input or output
  exit_interrupted = 75 ///< stopped early by a signal
};

/// Arguments that all commands with an input file share.
struct InputArguments
{
  std::string input;
  std::vector<std::string> assignments; ///< from --set
};

int run_command(const InputArguments &arguments, const std::string &directory, MPI_Comm communicator);
int check_command(const InputArguments &arguments, MPI_Comm communicator);
int parameters_command(const std::string &format);
int field_command(const InputArguments &arguments, const std::string &points_file, const std::string &output_file,
                  MPI_Comm communicator);
int forces_command(const InputArguments &arguments, const std::string &output_file, MPI_Comm communicator);

/// Reads a table with columns x,y,z (m) after a header line; extra columns are ignored. Returns nm. Throws InputError.
std::vector<std::array<double, 3>> read_points(const std::string &file);
} // namespace ddfem::coupling
