#include "dd/elasticity/vectorised/targets.h"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <stdexcept>

namespace ddfem
{
namespace
{
/// Highway can always fall back to the target that the compiler assumes.
std::vector<std::int64_t> targets()
{
  hwy::SetSupportedTargetsForTest(0);
  std::vector<std::int64_t> found = hwy::SupportedAndGeneratedTargets();
  if (found.empty() || found.back() != HWY_STATIC_TARGET)
    found.push_back(HWY_STATIC_TARGET);
  return found;
}
} // namespace

std::vector<std::string> kernel_targets()
{
  std::vector<std::string> names;
  for (const std::int64_t target : targets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

void use_kernel_target(const std::string &name)
{
  const std::vector<std::int64_t> all = targets();
  if (name.empty())
  {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return;
  }
  for (const std::int64_t target : all)
    if (name == hwy::TargetName(target))
    {
      hwy::GetChosenTarget().Update(target);
      return;
    }
  throw std::invalid_argument("no instruction set '" + name + "' for the kernels on this machine");
}
} // namespace ddfem
