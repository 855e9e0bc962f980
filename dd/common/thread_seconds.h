// Processor time of one thread.
#pragma once

#include <ctime>

namespace ddfem
{
/// That the calling thread has used, s. Takes half a microsecond.
inline double thread_seconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
} // namespace ddfem
