// Processor time of phases. Internal to dd/fmm.
#pragma once

#include <ctime>

namespace ddfem::fmm
{
/// Adds the processor time of a scope, summed over threads, to a phase (s).
class Stopwatch
{
public:
  explicit Stopwatch(double &phase_) : phase(phase_) {}
  Stopwatch(const Stopwatch &) = delete;
  Stopwatch &operator=(const Stopwatch &) = delete;
  ~Stopwatch() { phase += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

private:
  double &phase;
  std::clock_t start = std::clock();
};
} // namespace ddfem::fmm
