// Internal units: length nm, time ns, stress MPa. Conversions to SI live here and are used by readers and writers only.
#pragma once

namespace ddfem::units
{
inline constexpr double metre = 1e9;   ///< nm per m
inline constexpr double second = 1e9;  ///< ns per s
inline constexpr double pascal = 1e-6; ///< MPa per Pa
/// MPa nm^2 per N: 1 N = 1 Pa m^2 = 1e-6 MPa * 1e18 nm^2.
inline constexpr double newton = pascal * metre * metre;
/// MPa nm^3 per N m, and per J.
inline constexpr double newton_metre = newton * metre;
inline constexpr double joule = newton_metre;
/// MPa nm per N/m.
inline constexpr double newton_per_metre = newton / metre;
/// MPa ns per Pa s.
inline constexpr double pascal_second = pascal * second;
/// nm/ns per m/s.
inline constexpr double metre_per_second = metre / second;
/// 1/ns per 1/s.
inline constexpr double per_second = 1.0 / second;
/// nm^-2 per m^-2 (dislocation density).
inline constexpr double per_square_metre = 1.0 / (metre * metre);
} // namespace ddfem::units
