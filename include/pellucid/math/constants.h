/// Numbers that more than one room needs.
#pragma once

namespace pellucid {

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr float kTwoPi = 2.0F * kPi;
inline constexpr float kInvPi = 1.0F / kPi;
inline constexpr double kPiD = 3.14159265358979323846;
/// The largest float below one: random numbers lie in [0, kOneMinusEpsilon].
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1F;
inline constexpr double kLargestBelowOne = 1.0 - 0x1p-53;

}  // namespace pellucid
