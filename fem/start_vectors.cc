#include "fem/start_vectors.h"

#include <algorithm>

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
  NodalVector x = system.make_vector();
  if (starts.empty())
  {
    return x;
  }
  const Start &one = starts[0];
  const double a11 = one.vector * one.product, b1 = one.vector * load;
  if (!(a11 > 0.))
  {
    return x;
  }
  if (starts.size() > 1)
  {
    const Start &two = starts[1];
    const double a12 = one.vector * two.product, a22 = two.vector * two.product, b2 = two.vector * load;
    const double determinant = a11 * a22 - a12 * a12;
    // Two nearly equal solutions span no plane that rounding leaves intact.
    constexpr double independent = 1e-10;
    if (determinant > independent * a11 * a22)
    {
      x.add((a22 * b1 - a12 * b2) / determinant, one.vector, (a11 * b2 - a12 * b1) / determinant, two.vector);
      return x;
    }
  }
  x.add(most > 1 ? b1 / a11 : 1., one.vector);
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
