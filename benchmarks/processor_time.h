// Processor time of a benchmark.
#pragma once

#include <ctime>

namespace ddfem
{
/// Summed over threads, s.
inline double seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}
} // namespace ddfem
