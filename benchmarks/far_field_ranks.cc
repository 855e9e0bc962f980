// Nodal forces by the fast multipole method on several ranks: time of the phases and bytes sent by each rank.
//
//   mpirun -np RANKS far_field_ranks TOLERANCE PAIR_TOLERANCE REPEATS random|clustered measured|assumed N_SEGMENTS...
//
// Medians over the repeats, after one that is not counted. The shares of the ranks follow measured or assumed costs. Wall time of the
// forces; all others are processor times, summed over the threads of a rank.
#include "benchmarks/networks.h"
#include "benchmarks/processor_time.h"
#include "dd/common/parallel.h"
#include "dd/forces/multipole_forces.h"
#include "dd/forces/nodal_forces.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

namespace
{
using namespace ddfem;

const IsotropicMedium medium{50e3, 0.34, 0.3};

enum Column : std::uint8_t
{
  wall,  ///< of compute_nodal_forces()
  lines, ///< LineSystem
  tree,  ///< what remains
  upward,
  translations, ///< with downward
  points,
  near,
  close,
  divided, ///< sum of what the ranks divide
  waiting, ///< for others
  moments_sent,
  stresses_sent,
  n_columns
};
using Row = std::array<double, n_columns>;

/// Phases of one evaluation. Times in s, what is sent in bytes.
Row phases(const Network &network, const fmm::MultipoleSettings &settings, const double pair_tolerance)
{
  Row row{};
  MPI_Barrier(MPI_COMM_WORLD);
  const double start = seconds();
  const LineSystem system(medium, network, nullptr, RayDirection::normal, nullptr, nullptr);
  row[lines] = seconds() - start;
  const MultipoleForces forces(system, settings, pair_tolerance, MPI_COMM_WORLD);
  const fmm::PhaseTimes &t = forces.field().sum().times();
  row[upward] = t.upward;
  row[translations] = t.translations + t.downward;
  row[points] = t.points;
  row[near] = t.near;
  row[close] = forces.spent().close_pairs;
  row[divided] = row[upward] + row[translations] + row[points] + row[near] + row[close];
  row[waiting] = t.waiting + forces.spent().waiting;
  row[moments_sent] = static_cast<double>(forces.field().sum().n_bytes_sent());
  row[stresses_sent] = static_cast<double>(forces.spent().n_stresses_sent * sizeof(SymTensor));
  row[tree] = seconds() - start - row[lines] - row[divided] - row[waiting];
  return row;
}

double seconds_of_forces(const Network &network, const ForceSettings &settings, const ForceEnvironment &environment)
{
  MPI_Barrier(MPI_COMM_WORLD);
  const double start = MPI_Wtime();
  const NodalForces forces = compute_nodal_forces(network, settings, environment, MPI_COMM_WORLD);
  return MPI_Wtime() - start;
}

Row medians(std::vector<Row> rows)
{
  Row result{};
  for (std::size_t c = 0; c < n_columns; ++c)
  {
    std::sort(rows.begin(), rows.end(), [c](const Row &a, const Row &b) { return a[c] < b[c]; });
    result[c] = rows[rows.size() / 2][c];
  }
  return result;
}

void measure(const Network &network, const double tolerance, const double pair_tolerance, const bool with_costs,
             const int n_repeats)
{
  ForceSettings settings{medium, medium.a, pair_tolerance};
  settings.summation = {SummationMethod::multipole, tolerance};
  ForceEnvironment environment;
  if (with_costs)
    environment.costs = std::make_shared<fmm::WorkCosts>();
  fmm::MultipoleSettings multipoles{tolerance};
  multipoles.costs = environment.costs;
  std::vector<Row> rows;
  for (int k = 0; k <= n_repeats; ++k)
  {
    const double time = seconds_of_forces(network, settings, environment);
    Row row = phases(network, multipoles, pair_tolerance);
    row[wall] = time;
    if (k > 0)
      rows.push_back(row);
  }
  const std::vector<Row> all = gather_one(medians(std::move(rows)), MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD).mine != 0)
    return;
  const auto n = static_cast<double>(network.n_segments());
  std::printf(
      "%zu segments, tolerance %g\nrank   forces   system     tree   upward translat   points     near    close "
      " divided  waiting  moments, stresses, end forces sent, bytes\n",
      network.n_segments(), tolerance);
  for (std::size_t r = 0; r < all.size(); ++r)
  {
    std::printf("%4zu", r);
    for (std::size_t c = 0; c < moments_sent; ++c)
      std::printf(" %8.4f", all[r][c]);
    std::printf(" %10.0f %8.0f %8.0f\n", all[r][moments_sent], all[r][stresses_sent],
                n / static_cast<double>(all.size()) * sizeof(SegmentForces));
  }
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  if (argc < 7)
    std::fprintf(stderr, "usage: %s TOLERANCE PAIR_TOLERANCE REPEATS random|clustered measured|assumed N_SEGMENTS...\n",
                 argv[0]);
  for (int k = 6; k < argc; ++k)
    measure(random_loops(std::strtoul(argv[k], nullptr, 10), std::string_view(argv[4]) == "clustered"),
            std::atof(argv[1]), std::atof(argv[2]), std::string_view(argv[5]) == "measured",
            std::max(1, std::atoi(argv[3])));
  MPI_Finalize();
  return argc < 7 ? 2 : 0;
}
