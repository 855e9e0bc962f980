// What the processor can do at most.
#pragma once

namespace ddfem::benchmarks
{
/// Largest number of floating-point operations per second of one core, by independent fused multiply-adds (or multiplications
/// and additions where there are none) in the registers of the instruction set in use (use_kernel_target()).
double peak_flops();
} // namespace ddfem::benchmarks
