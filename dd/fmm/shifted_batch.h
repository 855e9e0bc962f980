// Points of images of boxes. Internal to dd/fmm.
#pragma once

#include "dd/elasticity/point_batch.h"

#include <array>
#include <vector>

namespace ddfem::fmm
{
/// A batch at points moved by @p shift (nm).
struct ShiftedBatch
{
  std::array<std::vector<double>, 3> x;
  StressBatch batch;

  ShiftedBatch(const StressBatch &given, const Vec3 &shift) : batch(given)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      x[c].reserve(given.n);
      for (std::size_t i = 0; i < given.n; ++i)
        x[c].push_back(given.x[c][i] + shift[static_cast<int>(c)]);
      batch.x[c] = x[c].data();
    }
  }
};
} // namespace ddfem::fmm
