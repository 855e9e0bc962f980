// Small networks in tests: threads would only wait for each other.
#pragma once

#include <omp.h>

namespace ddfem
{
/// One thread for parallel regions until the end of the scope.
class OneThread
{
public:
  OneThread() { omp_set_num_threads(1); }
  OneThread(const OneThread &) = delete;
  OneThread &operator=(const OneThread &) = delete;
  ~OneThread() { omp_set_num_threads(before); }

private:
  int before = omp_get_max_threads();
};
} // namespace ddfem
