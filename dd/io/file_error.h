// What every reader and writer throws.
#pragma once

#include <stdexcept>

namespace ddfem
{
/// A file cannot be read or written. The message reads "file:line: what, value, what is allowed"; the line is left out
/// where there is none.
struct FileError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};
} // namespace ddfem
