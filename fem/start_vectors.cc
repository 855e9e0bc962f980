#include "fem/start_vectors.h"

#include <cmath>
#include <utility>

namespace ddfem::fem
{
StartVectors::StartVectors(const ElasticSystem &elastic_system, std::size_t most_vectors)
    : system(elastic_system), most(most_vectors)
{
}

void StartVectors::remember(const NodalVector &solution)
{
  Start latest{solution, system.make_vector()};
  system.multiply(latest.product, solution);
  starts.insert(starts.begin(), latest);
  if (starts.size() > most)
  {
    starts.pop_back();
  }
}

NodalVector StartVectors::best(const NodalVector &load) const
{
  // Gram-Schmidt in the energy product, the most recent solution first: solutions of neighbouring times differ by little,
  // and so the first vectors hold what is common, the later ones differences of growing order.
  NodalVector x = system.make_vector();
  std::vector<Start> basis;
  for (const Start &start : starts)
  {
    Start next = start;
    const double energy = next.vector * next.product;
    for (const Start &earlier : basis)
    {
      const double overlap = next.vector * earlier.product;
      next.vector.add(-overlap, earlier.vector);
      next.product.add(-overlap, earlier.product);
    }
    const double rest = next.vector * next.product;
    // A difference of 1e-7 of the vectors has lost all but two digits of its energy.
    constexpr double independent = 1e-14;
    if (!(rest > independent * energy))
    {
      continue;
    }
    next.vector /= std::sqrt(rest);
    next.product /= std::sqrt(rest);
    x.add(next.vector * load, next.vector);
    basis.push_back(std::move(next));
  }
  return x;
}

std::vector<const NodalVector *> StartVectors::vectors() const
{
  std::vector<const NodalVector *> result;
  for (const Start &start : starts)
  {
    result.push_back(&start.vector);
  }
  return result;
}
} // namespace ddfem::fem
