#include "dd/integrators/embedded_runge_kutta.h"

#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace ddfem
{
namespace
{
/// Rows of weights of the stages before each stage but the first; the last row is the step. `error`: weights of the difference of the two
/// methods, lower order minus higher.
struct Tableau
{
  std::vector<std::vector<double>> stages;
  std::vector<double> error;
  unsigned lower_order;
};

const Tableau &tableau(const EmbeddedPair pair)
{
  static const Tableau bogacki_shampine{
      {{1.0 / 2}, {0, 3.0 / 4}, {2.0 / 9, 1.0 / 3, 4.0 / 9}}, {5.0 / 72, -1.0 / 12, -1.0 / 9, 1.0 / 8}, 2};
  static const Tableau dormand_prince{
      {{1.0 / 5},
       {3.0 / 40, 9.0 / 40},
       {44.0 / 45, -56.0 / 15, 32.0 / 9},
       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
       {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}},
      {-71.0 / 57600, 0, 71.0 / 16695, -71.0 / 1920, 17253.0 / 339200, -22.0 / 525, 1.0 / 40},
      4};
  return pair == EmbeddedPair::bogacki_shampine ? bogacki_shampine : dormand_prince;
}

std::vector<Vec3> weighted(const std::vector<std::vector<Vec3>> &stages, const std::span<const double> weights,
                           const double h)
{
  std::vector<Vec3> sum(stages[0].size(), Vec3::Zero());
  for (std::size_t j = 0; j < weights.size(); ++j)
    if (weights[j] != 0)
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += h * weights[j] * stages[j][i];
  return sum;
}
} // namespace

double EmbeddedRungeKutta::largest_step(const EquationOfMotion &) const
{
  return std::numeric_limits<double>::infinity(); // an unstable step has a large error
}

Integrator::Try EmbeddedRungeKutta::attempt(const Start &start, const double h, IntegratorStep &step)
{
  const Tableau &t = tableau(pair);
  std::vector<Field> stages{start.velocity};
  Field displacement;
  for (const std::vector<double> &row : t.stages)
  {
    displacement = weighted(stages, row, h);
    stages.push_back(velocity_at(start, displacement, h * std::accumulate(row.begin(), row.end(), 0.0), step));
  }
  return {std::move(displacement), weighted(stages, t.error, h), {}, t.lower_order + 1};
}
} // namespace ddfem
