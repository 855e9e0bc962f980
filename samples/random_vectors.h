// Reproducible random vectors, and a medium.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"

#include <random>

namespace ddfem::samples
{
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
} // namespace ddfem::samples
