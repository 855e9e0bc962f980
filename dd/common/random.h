// Random numbers that are functions of what they are for, not of who asks and when.
#pragma once

#include "dd/common/types.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace ddfem
{
/// Philox4x32 with ten rounds (Salmon, Moraes, Dror & Shaw, SC'11, section 3.3): a bijection of the 128-bit @p counter for
/// each 64-bit @p key whose values pass as independent random bits. Words in the order of that paper, lowest first.
inline std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key)
{
  constexpr std::uint64_t multiplier_0 = 0xD2511F53U, multiplier_1 = 0xCD9E8D57U;
  constexpr std::uint32_t weyl_0 = 0x9E3779B9U, weyl_1 = 0xBB67AE85U;
  for (int round = 0; round < 10; ++round)
  {
    const std::uint64_t p0 = multiplier_0 * counter[0], p1 = multiplier_1 * counter[2];
    const auto high = [](const std::uint64_t p) { return static_cast<std::uint32_t>(p >> 32); };
    const auto low = [](const std::uint64_t p) { return static_cast<std::uint32_t>(p); };
    counter = {high(p1) ^ counter[1] ^ key[0], low(p1), high(p0) ^ counter[3] ^ key[1], low(p0)};
    key[0] += weyl_0;
    key[1] += weyl_1;
  }
  return counter;
}

/// What random numbers are drawn for: different purposes have independent numbers.
enum class RandomPurpose : std::uint8_t
{
  thermal_force, ///< id: of the segment
  cross_slip,    ///< id: the smallest of the segments of the screw line
};

/// The random numbers of one object in one step for one purpose: the same on any rank and thread, in any order, and after a
/// restart, because nothing is remembered between two calls.
class CounterRandom
{
public:
  /// @p id: persistent; @p step: below 2^48.
  CounterRandom(const std::uint64_t seed, const ObjectId id, const std::uint64_t step, const RandomPurpose purpose)
      : key{word(seed), word(seed >> 32)}, counter{word(id), word(id >> 32), word(step),
                                                   (word(step >> 32) & 0xffffU) << 16 |
                                                       static_cast<std::uint32_t>(purpose) << 8}
  {
  }

  /// Two independent numbers in (0, 1), of 52 random bits each. @p draw: below 256, which pair.
  std::array<double, 2> uniform_pair(const unsigned draw = 0) const
  {
    std::array<std::uint32_t, 4> c = counter;
    c[3] |= draw & 0xffU;
    const std::array<std::uint32_t, 4> bits = philox4x32(c, key);
    // The middle of one of 2^52 equal intervals: neither 0, of which there is no logarithm, nor 1.
    const auto number = [](const std::uint32_t a, const std::uint32_t b)
    { return (static_cast<double>((std::uint64_t{a} << 32 | b) >> 12) + 0.5) * 0x1p-52; };
    return {number(bits[0], bits[1]), number(bits[2], bits[3])};
  }
  double uniform(const unsigned draw = 0) const { return uniform_pair(draw)[0]; }

  /// Two independent numbers of the normal distribution with mean 0 and variance 1 (Box & Muller, Ann. Math. Stat. 29 (1958) 610).
  std::array<double, 2> normal_pair(const unsigned draw = 0) const
  {
    const auto [u, v] = uniform_pair(draw);
    const double r = std::sqrt(-2 * std::log(u)), angle = 2 * std::numbers::pi * v;
    return {r * std::cos(angle), r * std::sin(angle)};
  }

private:
  static std::uint32_t word(const std::uint64_t v) { return static_cast<std::uint32_t>(v); }

  std::array<std::uint32_t, 2> key;
  std::array<std::uint32_t, 4> counter;
};
} // namespace ddfem
