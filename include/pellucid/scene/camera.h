/// The camera as the scene file states it (CameraSpec) and the thin-lens camera that makes rays (Camera).
#pragma once

#include <optional>
#include <string>

#include <glm/glm.hpp>

#include <pellucid/math/ray.h>

namespace pellucid {

/// Looks along -z of its own space, y up. glTF conventions: a scale in `toWorld` does not change the picture, so
/// whoever moves the scene to other units scales xmag and ymag too.
struct CameraSpec {
    std::string name;
    glm::dmat4 toWorld{1.0};
    bool orthographic = false;
    double verticalFov = 0.8;  ///< radians, of the whole image height
    double aspect = 0.0;       ///< width / height; 0: the image's own. Advice for choosing the image's size: pixels are
                               ///< square and the vertical extent holds, whatever the image's shape
    double xmag = 1.0, ymag = 1.0;  ///< orthographic half extents
};

/// A point on the film mapped back from the scene, for light tracing.
struct FilmPoint {
    glm::vec2 position;   ///< in pixels, (0,0) the upper left corner
    glm::vec3 direction;  ///< from the scene point to the lens point, unit
    float distance = 0.0F;
    float importance = 0.0F;  ///< see Camera::project
};

/// A ray and the width of a pixel's footprint across it: footprint(t) = footprintAtOrigin + t * footprintSpread, the
/// square root of the cross section of the pixel's pyramid.
struct CameraRay {
    Ray ray;
    float footprintAtOrigin = 0.0F;
    float footprintSpread = 0.0F;
};

/// Perspective (thin lens) or orthographic camera, in normalised scene space.
class Camera {
public:
    /// `aperture` is the lens diameter and `focus` the distance to the plane in focus, both in scene units; aperture
    /// 0 is a pinhole.
    Camera(const CameraSpec& spec, int width, int height, double aperture = 0.0, double focus = 1.0);

    [[nodiscard]] int width() const noexcept { return width_; }
    [[nodiscard]] int height() const noexcept { return height_; }

    /// `film` in pixels; `lens` uniform in the unit square.
    [[nodiscard]] CameraRay ray(const glm::vec2& film, const glm::vec2& lens) const noexcept;

    /// Connects `point` to a point of the lens chosen by `lens`. Empty when the point falls outside of the image. A
    /// light path of throughput beta (W) that is scattered towards the lens with BSDF f and cosine c at `point` adds
    /// beta * f * c * importance to the pixel (radiance, W m^-2 sr^-1), for one emitted path; divide by their number.
    [[nodiscard]] std::optional<FilmPoint> project(const glm::vec3& point, const glm::vec2& lens) const noexcept;

    /// FilmPoint::importance of a point at `distance` along a camera ray of direction `direction`. Times the cosine at
    /// the point it is the density per area with which the rays of that pixel reach it.
    [[nodiscard]] float importance(const glm::vec3& direction, float distance) const noexcept;

    [[nodiscard]] glm::vec3 position() const noexcept { return origin_; }
    [[nodiscard]] glm::vec3 forward() const noexcept { return forward_; }

private:
    int width_, height_;
    bool orthographic_;
    glm::vec3 origin_, right_, up_, forward_;
    float halfWidth_, halfHeight_;  ///< of the film at unit distance (perspective) or in scene units (orthographic)
    float lensRadius_, focus_;
    float pixelWidth_, pixelArea_;  ///< on the film of these half extents
};

}  // namespace pellucid
