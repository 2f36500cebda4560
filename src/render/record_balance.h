/// Whether the rays of a render are well parted between the records of a cache and the eye's samples, by the noise that each
/// has been seen to leave.
#pragma once

namespace pellucid {

struct RecordBalance {
    double recordNoise2 = 0.0, eyeNoise2 = 0.0;  ///< relative, squared: what their rays so far leave in the image
    double recordRays = 0.0, eyeRays = 0.0;      ///< those rays
    double raysLeft = 0.0;                       ///< that may yet be traced while these records serve
};

/// The rays that records made anew should have: with a = noise^2 x rays of each side, the sum a_r / x + a_e / y is least at
/// x : y = sqrt(a_r) : sqrt(a_e). 0 where that would not lower it by much.
[[nodiscard]] double raysOfBetterRecords(const RecordBalance& balance) noexcept;

}  // namespace pellucid
