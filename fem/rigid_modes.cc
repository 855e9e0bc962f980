#include "fem/rigid_modes.h"

#include <algorithm>
#include <cmath>

namespace ddfem::fem
{
namespace
{
using Matrix6 = std::array<std::array<double, 6>, 6>;

/// Rotates rows and columns p, q of a symmetric matrix so that its (p, q) entry vanishes, and the columns of `vectors`
/// along.
void jacobi_rotation(Matrix6 &matrix, Matrix6 &vectors, unsigned p, unsigned q)
{
  if (matrix[p][q] == 0.)
  {
    return;
  }
  const double theta = (matrix[q][q] - matrix[p][p]) / (2. * matrix[p][q]);
  const double t = (theta >= 0. ? 1. : -1.) / (std::abs(theta) + std::sqrt(theta * theta + 1.));
  const double c = 1. / std::sqrt(t * t + 1.), s = t * c;
  const auto rotate = [c, s](double &x, double &y)
  {
    const double old = x;
    x = c * old - s * y;
    y = s * old + c * y;
  };
  for (unsigned k = 0; k < 6; ++k)
  {
    rotate(matrix[k][p], matrix[k][q]);
  }
  for (unsigned k = 0; k < 6; ++k)
  {
    rotate(matrix[p][k], matrix[q][k]);
  }
  for (unsigned k = 0; k < 6; ++k)
  {
    rotate(vectors[k][p], vectors[k][q]);
  }
}

/// Eigenvectors (columns) of a symmetric matrix, which becomes diagonal; cyclic Jacobi, convergent to rounding in a few
/// sweeps.
Matrix6 diagonalise(Matrix6 &matrix)
{
  Matrix6 vectors{};
  for (unsigned k = 0; k < 6; ++k)
  {
    vectors[k][k] = 1.;
  }
  for (unsigned sweep = 0; sweep < 30; ++sweep)
  {
    for (unsigned p = 0; p < 6; ++p)
    {
      for (unsigned q = p + 1; q < 6; ++q)
      {
        jacobi_rotation(matrix, vectors, p, q);
      }
    }
  }
  return vectors;
}

/// Gram matrix of the six motions over the owned prescribed unknowns, summed over ranks.
Matrix6 gram_matrix(const NodalGrid &grid, const std::vector<std::array<bool, 3>> &prescribed,
                    const dealii::Point<3> &centre, double length)
{
  const auto motions = all_rigid_motions();
  Matrix6 gram{};
  for (unsigned n = 0; n < grid.n_owned_nodes; ++n)
  {
    const auto arm = (grid.positions[n] - centre) / length;
    for (unsigned c = 0; c < 3; ++c)
    {
      for (unsigned i = 0; prescribed[n][c] && i < 6; ++i)
      {
        for (unsigned j = 0; j < 6; ++j)
        {
          gram[i][j] += motions[i].at(arm)[c] * motions[j].at(arm)[c];
        }
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, gram.data()->data(), 36, MPI_DOUBLE, MPI_SUM, grid.communicator);
  return gram;
}
} // namespace

std::array<RigidMotion, 6> all_rigid_motions()
{
  std::array<RigidMotion, 6> motions;
  for (unsigned d = 0; d < 3; ++d)
  {
    motions[d].shift[d] = 1.;
    motions[3 + d].spin[d] = 1.;
  }
  return motions;
}

std::vector<RigidMotion> free_rigid_motions(const NodalGrid &grid, const std::vector<std::array<bool, 3>> &prescribed,
                                            const dealii::Point<3> &centre, double length)
{
  Matrix6 gram = gram_matrix(grid, prescribed, centre, length);
  const Matrix6 vectors = diagonalise(gram);
  double largest = 0.;
  for (unsigned k = 0; k < 6; ++k)
  {
    largest = std::max(largest, gram[k][k]);
  }
  // Squares of singular values: 1e-12 is a motion a million times smaller on the prescribed unknowns than elsewhere.
  constexpr double threshold = 1e-12;
  const auto motions = all_rigid_motions();
  std::vector<RigidMotion> free;
  for (unsigned k = 0; k < 6; ++k)
  {
    if (gram[k][k] <= threshold * largest)
    {
      RigidMotion motion;
      for (unsigned i = 0; i < 6; ++i)
      {
        motion.shift += vectors[i][k] * motions[i].shift;
        motion.spin += vectors[i][k] * motions[i].spin;
      }
      free.push_back(motion);
    }
  }
  return free;
}
} // namespace ddfem::fem
