// The ddfem program.
#include "coupling/commands.h"
#include "coupling/input_error.h"
#include "coupling/simulation.h"

#include <CLI/CLI.hpp>
#include <deal.II/base/mpi.h>
#include <omp.h>

#include <functional>
#include <iostream>

namespace
{
using namespace ddfem::coupling;

/// Ends all ranks, of which perhaps only this one has failed.
int abort_all(const std::string &message, const ExitStatus status)
{
  std::cerr << "ddfem: " << message << std::endl;
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size > 1)
    MPI_Abort(MPI_COMM_WORLD, status);
  return status;
}

/// Runs a command and turns exceptions into one message and an exit status.
int guarded(const std::function<int()> &command)
{
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const auto say = [&](const std::string &message)
  {
    if (rank == 0)
      std::cerr << "ddfem: " << message << std::endl;
  };
  try
  {
    return command();
  }
  catch (const InputError &e)
  {
    say(e.what());
    return exit_input;
  }
  catch (const FileAccessError &e)
  {
    return abort_all(e.what(), exit_file);
  }
  catch (const std::exception &e)
  {
    return abort_all(e.what(), exit_failure);
  }
}

struct Options
{
  InputArguments input;
  std::string directory = "results", format = "prm", points, output, method;
  unsigned threads = 0;
};

void add_input(CLI::App &command, Options &o)
{
  command.add_option("INPUT", o.input.input, "input file (.prm or .json)")->required();
  command.add_option("--set", o.input.assignments, "\"Section/Entry=value\", overrides the input; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--threads", o.threads, "OpenMP threads per process");
}

void add_method(CLI::App &command, Options &o)
{
  command.add_option("--method", o.method, "sum of the lines: direct or fmm; without it, that of the input")
      ->check(CLI::IsMember({"direct", "fmm"}));
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App app{"ddfem: dislocation dynamics in finite crystalline grains"};
  app.set_version_flag("--version", std::string("ddfem ") + DDFEM_VERSION);
  app.require_subcommand(1);
  Options o;

  auto *run = app.add_subcommand("run", "run a simulation");
  add_input(*run, o);
  run->add_option("-o,--output", o.directory, "output directory")->capture_default_str();
  auto *check = app.add_subcommand("check", "check an input without running it; writes nothing");
  add_input(*check, o);
  auto *parameters = app.add_subcommand("parameters", "print all input entries with their defaults");
  parameters->add_option("--format", o.format, "prm, json or md")
      ->check(CLI::IsMember({"prm", "json", "md"}))
      ->capture_default_str();
  auto *field = app.add_subcommand("field", "infinite, correction and total stress of the initial state at points");
  add_input(*field, o);
  field->add_option("--points", o.points, "CSV with columns x,y,z in m")->required();
  field->add_option("-o,--output", o.output, "CSV to write")->required();
  add_method(*field, o);
  auto *forces = app.add_subcommand("forces", "nodal forces of the initial state by contribution");
  add_input(*forces, o);
  forces->add_option("-o,--output", o.output, "CSV to write")->required();
  add_method(*forces, o);

  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError &e)
  {
    return app.exit(e) == 0 ? exit_success : exit_input;
  }
  if (parameters->parsed())
    return parameters_command(o.format);
  if (!o.method.empty())
    o.input.assignments.emplace_back(o.method == "fmm" ? "Forces/Summation=multipole" : "Forces/Summation=direct");

  // deal.II sets the number of OpenMP threads to its own limit, so it is told what OpenMP would have used.
  const unsigned threads = o.threads > 0 ? o.threads : static_cast<unsigned>(omp_get_max_threads());
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, threads);
  omp_set_num_threads(static_cast<int>(threads));
  install_signal_handlers();
  return guarded(
      [&]
      {
        if (run->parsed())
          return run_command(o.input, o.directory, MPI_COMM_WORLD);
        if (check->parsed())
          return check_command(o.input, MPI_COMM_WORLD);
        if (field->parsed())
          return field_command(o.input, o.points, o.output, MPI_COMM_WORLD);
        return forces_command(o.input, o.output, MPI_COMM_WORLD);
      });
}
