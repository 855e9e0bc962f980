// Helpers of the elasticity tests: reproducible random vectors, error measures.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"

#include <random>

namespace ddfem::test
{
/// max |value - reference| / max |reference|.
template <typename A, typename B>
double relative_error(const Eigen::MatrixBase<A> &value, const Eigen::MatrixBase<B> &reference)
{
  return (value - reference).template lpNorm<Eigen::Infinity>() / reference.template lpNorm<Eigen::Infinity>();
}

/// Random vectors with components in [-1, 1], always the same sequence.
class RandomVectors
{
public:
  explicit RandomVectors(unsigned seed) : generator(seed) {}
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(generator); }
  Vec3 vector()
  {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  Mat3 rotation() { return Eigen::Quaterniond(number(), number(), number(), number()).normalized().toRotationMatrix(); }

private:
  std::mt19937 generator;
};

inline const IsotropicMedium copper_like{.mu = 50.0e3, .nu = 0.34, .a = 0.3};
} // namespace ddfem::test
