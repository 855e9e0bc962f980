// Processor time of phases.
#pragma once

#include <ctime>

namespace ddfem
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

/// The same of the thread that measures. Takes a microsecond.
class ThreadStopwatch
{
public:
  explicit ThreadStopwatch(double &phase_) : phase(phase_) {}
  ThreadStopwatch(const ThreadStopwatch &) = delete;
  ThreadStopwatch &operator=(const ThreadStopwatch &) = delete;
  ~ThreadStopwatch() { phase += now() - start; }

private:
  static double now()
  {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }

  double &phase;
  double start = now();
};
} // namespace ddfem
