// The cameras of a scene: by name or number, and one that frames it where there is none.
#include <charconv>
#include <cmath>
#include <utility>

#include <pellucid/base/error.h>

#include "scene_impl.h"

namespace pellucid {

namespace {

[[nodiscard]] const CameraSpec& findCamera(const std::vector<CameraSpec>& cameras, const std::string& nameOrIndex) {
    if (nameOrIndex.empty()) return cameras.front();
    for (const CameraSpec& c : cameras)
        if (c.name == nameOrIndex) return c;
    std::size_t index = cameras.size();
    const auto [end, status] = std::from_chars(nameOrIndex.data(), nameOrIndex.data() + nameOrIndex.size(), index);
    if (status == std::errc() && end == nameOrIndex.data() + nameOrIndex.size() && index < cameras.size())
        return cameras[index];
    std::string known;
    for (std::size_t i = 0; i < cameras.size(); ++i)
        known += (i > 0 ? ", " : "") + std::to_string(i) + " '" + cameras[i].name + "'";
    throw Error(ErrorKind::Usage, "there is no camera '" + nameOrIndex + "'", "--camera", "choose one of " + known);
}

}  // namespace

CameraSpec framingCamera(const Normalisation& n, const Bounds& bounds) {
    const glm::dvec3 toViewer = glm::normalize(glm::dvec3(0.45, 0.35, 1.0));
    CameraSpec spec;
    spec.name = "framing";
    spec.verticalFov = 0.7;
    const double distance = 1.05 * static_cast<double>(bounds.radius()) / std::sin(0.5 * spec.verticalFov);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), toViewer));
    const glm::dvec3 up = glm::cross(toViewer, right);
    const glm::dvec3 position = (glm::dvec3(bounds.centre()) + distance * toViewer) / n.scale() + n.centre;
    spec.toWorld =
        glm::dmat4(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(toViewer, 0), glm::dvec4(position, 1));
    return spec;
}

Camera Scene::camera(const std::string& nameOrIndex, int width, int height, double aperture, double focus) const {
    CameraSpec spec = findCamera(impl_->description.cameras, nameOrIndex);
    constexpr int kDefaultWidth = 512;
    double aspect = spec.aspect > 0.0 ? spec.aspect : 1.0;
    if (spec.orthographic && spec.xmag > 0.0 && spec.ymag > 0.0) aspect = spec.xmag / spec.ymag;
    if (width <= 0 && height <= 0) width = kDefaultWidth;
    if (width <= 0) width = std::max(1, static_cast<int>(std::lround(height * aspect)));
    if (height <= 0) height = std::max(1, static_cast<int>(std::lround(width / aspect)));
    const double scale = impl_->normalisation.scale();
    spec.toWorld = normalisedTransform(impl_->normalisation, spec.toWorld);
    spec.xmag *= scale;
    spec.ymag *= scale;
    return Camera(spec, width, height, aperture * scale, focus * scale);
}

}  // namespace pellucid
