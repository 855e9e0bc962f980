// Tests that run once for each instruction set of the machine.
#pragma once

#include "dd/elasticity/vectorised/targets.h"

#include <gtest/gtest.h>

#include <string>

namespace ddfem::test
{
/// Uses the instruction set that is the test's parameter.
class KernelTargets : public testing::TestWithParam<std::string>
{
protected:
  void SetUp() override { use_kernel_target(GetParam()); }
  void TearDown() override { use_kernel_target(""); }
};

inline std::string name_of_target(const testing::TestParamInfo<std::string> &info)
{
  return info.param;
}
} // namespace ddfem::test
