// Which instruction set the vectorised kernels use.
#pragma once

#include <string>
#include <vector>

namespace ddfem
{
/// Names of the instruction sets that both the program and this machine have, best first (on x86: AVX3, which is AVX-512, AVX2,
/// SSE4, SCALAR).
std::vector<std::string> kernel_targets();

/// Uses one of kernel_targets() from now on, for tests and timings; an empty name restores the best. Not to be called
/// while kernels run. Throws std::invalid_argument for a name that is not in the list.
void use_kernel_target(const std::string &name);
} // namespace ddfem
