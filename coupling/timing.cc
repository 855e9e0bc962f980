#include "coupling/timing.h"

#include <iomanip>
#include <sstream>

namespace ddfem::coupling
{
namespace
{
double seconds_since(const std::chrono::steady_clock::time_point &t)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}
} // namespace

Timing::Scope::Scope(Timing &owner, std::string name)
    : timing(owner), section(std::move(name)), start(std::chrono::steady_clock::now())
{
}

Timing::Scope::~Scope()
{
  timing.seconds[section] += seconds_since(start);
}

double Timing::elapsed() const
{
  return seconds_since(begin);
}

std::string Timing::table() const
{
  std::ostringstream out;
  const double total = elapsed();
  out << std::fixed;
  for (const auto &[name, s] : seconds)
    out << std::left << std::setw(34) << name << std::right << std::setw(10) << std::setprecision(2) << s << " s"
        << std::setw(8) << std::setprecision(1) << 100 * s / total << " %\n";
  out << std::left << std::setw(34) << "total" << std::right << std::setw(10) << std::setprecision(2) << total
      << " s\n";
  return out.str();
}
} // namespace ddfem::coupling
