/// By what the irradiance cache judges how far a record speaks: the choice of `cache.metric`. It decides a record's radius
/// (transport/record_radius.cpp) and its error at a point (IrradianceCache).
#pragma once

#include <cstdint>

namespace pellucid {

enum class CacheMetric : std::uint8_t {
    Ward,       ///< harmonic mean distance, split-sphere error [Ward1988]
    Tabellion,  ///< nearest distance well above the horizon, the larger of two errors [TabellionLamorlette2004]
    Hessian     ///< second derivatives of E with occlusion, elliptic records [SchwarzhauptJensenJarosz2012]
};

}  // namespace pellucid
