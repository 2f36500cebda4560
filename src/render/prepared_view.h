/// What all passes of a render look at: the camera, what it sees, and the plan. Made once, before the first iteration, and
/// changed by none of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/render/plan.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

/// Of the scene's radius: the largest kernel of the caustic map.
constexpr float kMaxCausticRadius = 0.05F;
/// Of any kernel, scene units.
constexpr float kLeastKernelRadius = 4e-6F;

/// The pixels that are rendered.
class RenderedPixels {
public:
    RenderedPixels() = default;
    RenderedPixels(const std::vector<PixelWindow>& windows, int width, int height);

    [[nodiscard]] bool contains(std::size_t pixel) const noexcept { return inside_.empty() || inside_[pixel]; }
    /// Pixels of the image over pixels rendered.
    [[nodiscard]] double scale() const noexcept { return scale_; }
    /// Rays of a pass over these pixels, scaled up to the image.
    [[nodiscard]] std::uint64_t ofWholeImage(std::uint64_t rays) const noexcept;

private:
    std::vector<bool> inside_;  ///< empty: all are
    double scale_ = 1.0;
};

struct PreparedView {
    const Scene& scene;
    const RenderRequest& request;
    const Workers& workers;
    Camera camera;
    TransportOptions options;
    Survey survey = {};
    Plan plan = {};
    RenderedPixels pixels = {};
    StageRecord pilot{"pilot"};

    /// A context with the options of this render.
    [[nodiscard]] TransportContext context(const Maps& maps) const { return {scene, options, maps}; }
    /// Whether eye paths meet light paths.
    [[nodiscard]] bool bidirectional() const noexcept { return request.method == Method::Bdpt || plan.bidirectional; }
    [[nodiscard]] std::size_t pixelIndex(int x, int y) const noexcept {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width()) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] std::size_t pixelCount() const noexcept { return pixelIndex(0, camera.height()); }
};

[[nodiscard]] Camera requestedCamera(const Scene& scene, const RenderRequest& request);

/// Looks once through every pixel, sends the pilot's photons and plans. Keeps references to all three.
[[nodiscard]] PreparedView prepareView(const Scene& scene, const RenderRequest& request, const Workers& workers);

}  // namespace pellucid
