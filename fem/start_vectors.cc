#include "fem/start_vectors.h"

#include <algorithm>
#include <cmath>

namespace ddfem::fem
{
StartVectors::StartVectors(const ElasticSystem &elastic_system, std::size_t most_vectors)
    : system(elastic_system), most(most_vectors), products(most_vectors, std::vector<double>(most_vectors, 0.))
{
}

void StartVectors::remember(const NodalVector &solution, const NodalVector &product)
{
  if (!changes.empty())
  {
    changes.front().vector -= solution;
    changes.front().product -= product;
  }
  if (changes.size() == most)
  {
    changes.pop_back();
  }
  changes.push_front({solution, product});
  for (std::size_t i = most - 1; i > 0; --i)
  {
    for (std::size_t j = most - 1; j > 0; --j)
    {
      products[i][j] = products[i - 1][j - 1];
    }
  }
  // Only the first two differ from what they were.
  multiply_from(0, 2);
}

/// Products in energy of some of the changes with themselves and those after them.
void StartVectors::multiply_from(std::size_t first, std::size_t last)
{
  for (std::size_t i = first; i < std::min(last, changes.size()); ++i)
  {
    for (std::size_t j = i; j < changes.size(); ++j)
    {
      products[i][j] = products[j][i] = changes[i].vector * changes[j].product;
    }
  }
}

NodalVector StartVectors::best(const NodalVector &load) const
{
  // Cholesky factorisation L L^T of the products, and L y = changes.load; what depends on those before it is left out.
  const std::size_t n = changes.size();
  std::vector<std::vector<double>> factor(n, std::vector<double>(n, 0.));
  std::vector<double> y(n, 0.), coefficients(n, 0.);
  for (std::size_t i = 0; i < n; ++i)
  {
    double rest = products[i][i], right = changes[i].vector * load;
    for (std::size_t j = 0; j < i; ++j)
    {
      double sum = products[i][j];
      for (std::size_t k = 0; k < j; ++k)
      {
        sum -= factor[i][k] * factor[j][k];
      }
      factor[i][j] = factor[j][j] > 0. ? sum / factor[j][j] : 0.;
      rest -= factor[i][j] * factor[i][j];
      right -= factor[i][j] * y[j];
    }
    // A rest of 1e-14 has lost all but two digits.
    constexpr double independent = 1e-14;
    if (rest > independent * products[i][i])
    {
      factor[i][i] = std::sqrt(rest);
      y[i] = right / factor[i][i];
    }
  }
  NodalVector x = system.make_vector();
  for (std::size_t i = n; i-- > 0;)
  {
    if (factor[i][i] > 0.)
    {
      double sum = y[i];
      for (std::size_t k = i + 1; k < n; ++k)
      {
        sum -= factor[k][i] * coefficients[k];
      }
      coefficients[i] = sum / factor[i][i];
      x.add(coefficients[i], changes[i].vector);
    }
  }
  return x;
}

std::vector<const NodalVector *> StartVectors::state() const
{
  std::vector<const NodalVector *> result;
  for (const Change &change : changes)
  {
    result.push_back(&change.vector);
    result.push_back(&change.product);
  }
  return result;
}

void StartVectors::restore(const std::vector<NodalVector> &state)
{
  changes.clear();
  for (std::size_t k = 0; k + 1 < state.size() && changes.size() < most; k += 2)
  {
    changes.push_back({state[k], state[k + 1]});
  }
  multiply_from(0, changes.size());
}
} // namespace ddfem::fem
