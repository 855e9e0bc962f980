// Helpers of the elasticity tests: reproducible random vectors, error measures.
#pragma once

#include "dd/common/types.h"
#include "samples/random_vectors.h"

namespace ddfem::test
{
/// max |value - reference| / max |reference|.
template <typename A, typename B>
double relative_error(const Eigen::MatrixBase<A> &value, const Eigen::MatrixBase<B> &reference)
{
  return (value - reference).template lpNorm<Eigen::Infinity>() / reference.template lpNorm<Eigen::Infinity>();
}

using samples::copper_like;
using samples::RandomVectors;
} // namespace ddfem::test
