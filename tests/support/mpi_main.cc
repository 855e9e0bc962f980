// main() of the tests that run under MPI: every rank runs every test; a failure on one rank is a failure of mpirun.
#include <deal.II/base/mpi.h>
#include <gtest/gtest.h>
#include <omp.h>

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int threads = omp_get_max_threads(); // deal.II would set one of its own
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, static_cast<unsigned>(threads));
  omp_set_num_threads(threads);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
  {
    auto &listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  int result = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return result;
}
