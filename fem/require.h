#pragma once

#include <sstream>
#include <stdexcept>

namespace ddfem::fem
{
/// Throws std::invalid_argument with a message made of `parts` unless the condition holds.
template <typename... Parts> void require(bool condition, const Parts &...parts)
{
  if (!condition)
  {
    std::ostringstream message;
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  }
}
} // namespace ddfem::fem
