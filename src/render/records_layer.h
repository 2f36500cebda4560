/// The image layer `records.Y`: how many records of the irradiance cache lie in each pixel.
#pragma once

#include <vector>

#include <pellucid/math/image.h>
#include <pellucid/scene/camera.h>
#include <pellucid/transport/irradiance_cache.h>

namespace pellucid {

void addRecordsLayer(Image& image, const std::vector<IrradianceRecord>& records, const Camera& camera);

}  // namespace pellucid
