/// Bidirectional path tracing [Veach1997, ch. 10]: one eye path and one light path, and every way to make a whole path of
/// a beginning of the one and an end of the other, weighted by multiple importance sampling: hitting a light, next-event
/// estimation, connecting two vertices, connecting a light path to the lens (a splat on another pixel). Unbiased. Blind
/// to paths without two neighbours that are no perfect mirrors, unless they end at a lamp that can be hit.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/transport/light_trace.h>
#include <pellucid/transport/subpath.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

class Bidirectional {
public:
    /// `lightPaths`: traced for each sample of every pixel, that is, pixels of the image.
    Bidirectional(const Scene& scene, const Camera& camera, const TransportOptions& options,
                  std::uint32_t lightPaths) noexcept;

    /// One eye path, one light path. The radiance of the eye path's pixel; what falls on others is appended to `splats`.
    [[nodiscard]] LayeredRadiance sample(const Ray& cameraRay, Sampler& eye, Sampler& light,
                                         std::vector<LightSplat>& splats, FirstHit* first = nullptr,
                                         StringSums* strings = nullptr) noexcept;

    [[nodiscard]] std::uint64_t rays() const noexcept { return rays_ + lampChains_.rays(); }
    /// The two paths of the last sample.
    [[nodiscard]] const Subpath& eyePath() const noexcept { return eye_; }
    [[nodiscard]] const Subpath& lightPath() const noexcept { return light_; }

private:
    void traceLight(Sampler& sampler, std::vector<LightSplat>& splats) noexcept;
    void splat(const PathVertex& y, std::size_t index, const glm::vec2& lens, std::vector<LightSplat>& splats) noexcept;
    void addDirect(const PathVertex& z, float fine, const glm::vec2& u, LayeredRadiance& sum) noexcept;
    void connect(const PathVertex& z, std::size_t lightVertex, LayeredRadiance& sum) noexcept;
    [[nodiscard]] Rgb transmittance(const PathVertex& from, const glm::vec3& direction, const Ray& shadow,
                                    float distance) noexcept;
    [[nodiscard]] PathString withLightEnd(PathString path, std::size_t vertices) const noexcept;

    const Scene& scene_;
    const Camera& camera_;
    LeftClasses left_;
    SubpathRules rules_;
    Subpath eye_, light_;
    bool splitLampChains_;
    LampChains lampChains_;
    std::uint64_t rays_ = 0;
};

}  // namespace pellucid
