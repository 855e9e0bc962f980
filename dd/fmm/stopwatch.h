// Processor time of phases. Internal to dd/fmm.
#pragma once

#include "dd/common/thread_seconds.h"

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

/// The same of the thread that measures.
class ThreadStopwatch
{
public:
  explicit ThreadStopwatch(double &phase_) : phase(phase_) {}
  ThreadStopwatch(const ThreadStopwatch &) = delete;
  ThreadStopwatch &operator=(const ThreadStopwatch &) = delete;
  ~ThreadStopwatch() { phase += thread_seconds() - start; }

private:
  double &phase;
  double start = thread_seconds();
};
} // namespace ddfem::fmm
