// Wall time of the parts of a run.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace ddfem::coupling
{
/// Accumulates the wall time of named sections.
class Timing
{
public:
  /// Adds the time from construction to destruction to a section.
  class Scope
  {
  public:
    Scope(Timing &owner, std::string name);
    ~Scope();
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

  private:
    Timing &timing;
    std::string section;
    std::chrono::steady_clock::time_point start;
  };

  /// Seconds since construction.
  double elapsed() const;
  /// Table of the sections, their seconds and shares.
  std::string table() const;

private:
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  std::map<std::string, double> seconds;
};
} // namespace ddfem::coupling
