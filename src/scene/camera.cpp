#include <pellucid/scene/camera.h>

#include <algorithm>
#include <cmath>

#include <pellucid/math/warps.h>

namespace pellucid {

namespace {

/// The column of a node's matrix as a unit axis; `fallback` where a scale of zero left nothing of it.
glm::dvec3 unitAxis(const glm::dvec3& axis, const glm::dvec3& fallback) noexcept {
    const double length = glm::length(axis);
    return length > 0.0 && std::isfinite(length) ? axis / length : fallback;
}

}  // namespace

Camera::Camera(const CameraSpec& spec, int width, int height, double aperture, double focus)
    : width_(std::max(width, 1)),
      height_(std::max(height, 1)),
      orthographic_(spec.orthographic),
      lensRadius_(static_cast<float>(0.5 * std::max(aperture, 0.0))),
      focus_(static_cast<float>(focus > 0.0 ? focus : 1.0)) {
    const glm::dmat4& m = spec.toWorld;
    const glm::dvec3 back = unitAxis(glm::dvec3(m[2]), {0.0, 0.0, 1.0});
    const glm::dvec3 y(m[1]);
    const glm::dvec3 aside = std::fabs(back.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, -1.0);
    const glm::dvec3 up = unitAxis(y - back * glm::dot(y, back), glm::normalize(aside - back * glm::dot(aside, back)));
    glm::dvec3 right = glm::cross(up, back);
    if (glm::dot(right, glm::dvec3(m[0])) < 0.0) right = -right;  // a mirroring node shows a mirrored picture

    origin_ = glm::vec3(glm::dvec3(m[3]));
    right_ = glm::vec3(right);
    up_ = glm::vec3(up);
    forward_ = glm::vec3(-back);

    const double halfHeight = orthographic_ ? std::fabs(spec.ymag) : std::tan(0.5 * spec.verticalFov);
    const double pixel = 2.0 * halfHeight / height_;
    halfHeight_ = static_cast<float>(halfHeight);
    halfWidth_ = static_cast<float>(0.5 * pixel * width_);
    pixelWidth_ = static_cast<float>(pixel);
    pixelArea_ = static_cast<float>(pixel * pixel);
}

CameraRay Camera::ray(const glm::vec2& film, const glm::vec2& lens) const noexcept {
    const float x = film.x * pixelWidth_ - halfWidth_;
    const float y = halfHeight_ - film.y * pixelWidth_;
    const glm::vec2 disc = lensRadius_ > 0.0F ? lensRadius_ * sampleUniformDisc(lens) : glm::vec2(0.0F);
    const glm::vec3 lensOffset = right_ * disc.x + up_ * disc.y;
    const glm::vec3 filmOffset = right_ * x + up_ * y;

    CameraRay result;
    if (orthographic_) {
        result.ray.origin = origin_ + filmOffset + lensOffset;
        result.ray.direction = lensRadius_ > 0.0F ? glm::normalize(focus_ * forward_ - lensOffset) : forward_;
        result.footprintAtOrigin = pixelWidth_;
        return result;
    }
    result.ray.origin = origin_ + lensOffset;
    result.ray.direction = glm::normalize(filmOffset + forward_ - lensOffset / focus_);
    // A pixel of width p at unit distance subtends p^2 cos^3(theta).
    const float cosine = 1.0F / std::sqrt(1.0F + x * x + y * y);
    result.footprintSpread = pixelWidth_ * cosine * std::sqrt(cosine);
    return result;
}

float Camera::importance(const glm::vec3& direction, float distance) const noexcept {
    const float cosine = glm::dot(direction, forward_);
    return orthographic_ ? 1.0F / (pixelArea_ * cosine)
                         : 1.0F / (pixelArea_ * cosine * cosine * cosine * distance * distance);
}

/// The pixel's value is the mean of L over its area A on the film and over the lens. With the film scaled to the
/// plane in focus (distance F, area A F^2) and the lens point held, a film element is F^2 / cos^3 of a solid angle at
/// the lens, so
///   I = mean over the lens of  integral L cos_x / (A cos^3(theta) d^2) dA_x,
/// theta at the lens against the forward axis, d from the lens point to x, and for an orthographic camera, whose rays
/// through one lens point are parallel, I = mean of integral L cos_x / (A cos(theta)) dA_x. `importance` is the factor
/// after L cos_x: replacing L dA_x by the sum of beta f over arriving light paths gives the estimate. [Veach1997]
std::optional<FilmPoint> Camera::project(const glm::vec3& point, const glm::vec2& lens) const noexcept {
    const glm::vec2 disc = lensRadius_ > 0.0F ? lensRadius_ * sampleUniformDisc(lens) : glm::vec2(0.0F);
    const glm::vec3 offset = point - origin_;
    const glm::vec3 local(glm::dot(offset, right_), glm::dot(offset, up_), glm::dot(offset, forward_));
    if (!(local.z > 0.0F)) return std::nullopt;

    // From the lens point to the scene point, in the camera's axes, and the film coordinates of that ray.
    glm::vec3 ray;
    glm::vec2 film;
    if (orthographic_) {
        ray = glm::vec3(-disc * (local.z / focus_), local.z);
        film = glm::vec2(local) - disc - glm::vec2(ray);
    } else {
        ray = glm::vec3(glm::vec2(local) - disc, local.z);
        film = disc / focus_ + glm::vec2(ray) / ray.z;
    }
    const glm::vec2 pixel((film.x + halfWidth_) / pixelWidth_, (halfHeight_ - film.y) / pixelWidth_);
    const bool inside = pixel.x >= 0.0F && pixel.y >= 0.0F && pixel.x < static_cast<float>(width_) &&
                        pixel.y < static_cast<float>(height_);
    if (!inside) return std::nullopt;

    FilmPoint result;
    result.position = pixel;
    result.distance = glm::length(ray);
    result.direction = -(right_ * ray.x + up_ * ray.y + forward_ * ray.z) / result.distance;
    result.importance = importance(-result.direction, result.distance);
    if (!std::isfinite(result.importance)) return std::nullopt;
    return result;
}

}  // namespace pellucid
