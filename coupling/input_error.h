// Errors that the user can mend.
#pragma once

#include <stdexcept>
#include <string>

namespace ddfem::coupling
{
/// Invalid input: one message that says where, what, which value, and what is allowed. Exit status 2.
class InputError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written. Exit status 3.
class FileAccessError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
} // namespace ddfem::coupling
