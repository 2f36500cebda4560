#include <pellucid/transport/bidirectional.h>

#include "medium.h"

namespace pellucid {

namespace {

/// Sampler dimensions: of the eye path 0 film, 1 lens; of the light path three of emission; then so many a vertex.
constexpr std::uint64_t kEyeDimensions = 2, kLightDimensions = 3, kDimensionsPerVertex = 8;
enum VertexDimension : std::uint64_t { kCoin, kConnectChoice, kConnectPoint, kScatter };

[[nodiscard]] glm::vec3 sideOf(const PathVertex& v, const glm::vec3& direction) noexcept {
    const glm::vec3& n = v.bsdf.geometricNormal();
    return glm::dot(direction, n) < 0.0F ? -n : n;
}

[[nodiscard]] double geometricCosine(const PathVertex& v, const glm::vec3& direction) noexcept {
    return static_cast<double>(std::fabs(glm::dot(direction, v.bsdf.geometricNormal())));
}

}  // namespace

Bidirectional::Bidirectional(const Scene& scene, const Camera& camera, const TransportOptions& options,
                             std::uint32_t lightPaths) noexcept
    : scene_(scene),
      camera_(camera),
      left_(options.left),
      rules_{options.powerHeuristic, options.rouletteThreshold, options.maxDepth, lightPaths},
      eye_(scene, rules_, Subpath::From::Eye),
      light_(scene, rules_, Subpath::From::Light),
      splitLampChains_(options.splitLampChains),
      lampChains_(scene, options.maxDepth) {}

LayeredRadiance Bidirectional::sample(const Ray& cameraRay, Sampler& eye, Sampler& light,
                                      std::vector<LightSplat>& splats, FirstHit* first, StringSums* strings) noexcept {
    LayeredRadiance sum;
    sum.strings = strings;
    traceLight(light, splats);
    eye_.startAtEye(camera_, cameraRay);
    bool lampsFollowed = false;  // over delta lobes, by LampChains
    const auto countsLamps = [&] { return !left_.has(eye_.string()) && !(lampsFollowed && eye_.deltaChain()); };
    for (;;) {
        const std::uint64_t dimension = kEyeDimensions + kDimensionsPerVertex * eye_.vertices().size();
        eye.setDimension(dimension + kCoin);
        ++rays_;
        if (!eye_.advance(eye.next1D(), eye)) {
            if (countsLamps()) sum.add(eye_.string(), eye_.escaped());
            return sum;
        }
        const PathVertex& z = eye_.last();
        if (first != nullptr && eye_.vertices().size() == 1)
            *first = {z.bsdf.diffuse().reflectance, z.bsdf.shadingNormal(), z.hit.distance, 0.0F};
        if (countsLamps()) sum.add(eye_.string(), eye_.emitted());
        const std::size_t depth = eye_.vertices().size(), limit = static_cast<std::size_t>(rules_.maxDepth);
        if (splitLampChains_ && eye_.deltaChain() && !lampsFollowed && (limit == 0 || depth <= limit)) {
            lampsFollowed = lampChains_.follow({z.hit, z.bsdf, z.toPrevious, z.throughput, z.absorption,
                                                eye_.etaScale(), z.before, static_cast<int>(depth), eye_.wave()},
                                               eye, sum);
        }
        eye.setDimension(dimension + kConnectChoice);
        const float fine = eye.next1D();
        const glm::vec2 point = eye.next2D();
        if (z.bsdf.connects() && (limit == 0 || depth <= limit)) {
            addDirect(z, fine, point, sum);
            for (std::size_t i = 0; i < light_.vertices().size(); ++i)
                if (limit == 0 || depth + i + 1 <= limit) connect(z, i, sum);
        }
        eye.setDimension(dimension + kScatter);
        if (!eye_.scatter(eye)) return sum;
    }
}

/// The light path, with a splat from each of its vertices.
void Bidirectional::traceLight(Sampler& sampler, std::vector<LightSplat>& splats) noexcept {
    if (!light_.startAtLight(sampler)) return;
    for (;;) {
        const std::uint64_t dimension = kLightDimensions + kDimensionsPerVertex * light_.vertices().size();
        sampler.setDimension(dimension + kCoin);
        ++rays_;
        if (!light_.advance(sampler.next1D(), sampler)) return;
        sampler.setDimension(dimension + kConnectPoint);
        const glm::vec2 lens = sampler.next2D();
        const std::size_t depth = light_.vertices().size();
        if (light_.last().bsdf.connects() &&
            (rules_.maxDepth == 0 || depth <= static_cast<std::size_t>(rules_.maxDepth)))
            splat(light_.last(), depth - 1, lens, splats);
        sampler.setDimension(dimension + kScatter);
        if (!light_.scatter(sampler)) return;
    }
}

/// Beer's law and alpha along a connection.
Rgb Bidirectional::transmittance(const PathVertex& from, const glm::vec3& direction, const Ray& shadow,
                                 float distance) noexcept {
    ++rays_;
    const float visible = shadow.tMax > 0.0F ? scene_.visibility(shadow) : 1.0F;
    if (visible <= 0.0F) return Rgb(0.0F);
    const bool through = glm::dot(direction, from.bsdf.geometricNormal()) < 0.0F;
    return visible * medium::transmittance(
                         medium::afterHit(scene_, from.hit.point, from.bsdf, from.absorption, through), distance);
}

/// `path` and then the light path's first `vertices` ones, the last of them first.
PathString Bidirectional::withLightEnd(PathString path, std::size_t vertices) const noexcept {
    for (std::size_t i = vertices; i-- > 0;) path.pass(light_.vertices()[i].passed);
    return path;
}

/// Light path to lens. The eye's density of the same path: its one sample a pixel over the pixel's area.
void Bidirectional::splat(const PathVertex& y, std::size_t index, const glm::vec2& lens,
                          std::vector<LightSplat>& splats) noexcept {
    const auto film = camera_.project(y.hit.point.position, lens);
    if (!film || !(film->importance > 0.0F)) return;
    const int px = static_cast<int>(film->position.x), py = static_cast<int>(film->position.y);
    if (px < 0 || py < 0 || px >= camera_.width() || py >= camera_.height()) return;
    const auto value = light_.valueTowards(y, film->direction);
    if (!value) return;
    const Ray shadow{offsetOrigin(y.hit.point.position, sideOf(y, film->direction)), film->direction,
                     shadowLength(film->distance)};
    const Rgb visible = transmittance(y, film->direction, shadow, film->distance);
    if (isBlack(visible)) return;
    const double arrival = static_cast<double>(film->importance) * geometricCosine(y, film->direction);
    const double other = rules_.power(arrival / rules_.lightPaths) *
                         (y.mis.connect + y.mis.onward * rules_.power(static_cast<double>(value->pdfBack)));
    const auto scale = static_cast<float>(arrival / (rules_.lightPaths * (1.0 + other)));
    for (std::size_t k = 0; k < 3; ++k) {
        if (isBlack(value->byKind[k])) continue;
        PathString path;
        path.pass(static_cast<LobeKinds>(1U << k));
        path = withLightEnd(path, index);
        if (!left_.has(path))
            splats.push_back({static_cast<std::uint32_t>(py * camera_.width() + px),
                              y.throughput * value->byKind[k] * visible * scale, path});
    }
}

/// Next-event estimation: the light path is a point on a light, drawn for this vertex.
void Bidirectional::addDirect(const PathVertex& z, float fine, const glm::vec2& u, LayeredRadiance& sum) noexcept {
    const Lights& lights = scene_.lights();
    const auto light = lights.sample(z.hit.point.position, z.horizon, fine, u);
    if (!light) return;
    const auto value = eye_.valueTowards(z, light->wi);
    if (!value) return;
    const Ray shadow = shadowRay(z.hit.point.position, sideOf(z, light->wi), light->wi, light->distance);
    const Rgb visible = transmittance(z, light->wi, shadow, light->distance);
    if (isBlack(visible)) return;
    const auto direct = static_cast<double>(light->pdfSolidAngle);
    const double hit = light->delta ? 0.0 : rules_.power(static_cast<double>(value->pdfOnward) / direct);
    // Emission towards here over next-event estimation, both per area at the light (a point's is discrete) and here.
    const EmissionPdf emission = lights.pdfEmission(light->light, -light->wi);
    double emit = static_cast<double>(emission.position) * static_cast<double>(emission.direction) *
                  geometricCosine(z, light->wi) / direct;
    const bool punctual = light->delta && std::isfinite(light->distance);
    const auto distance = static_cast<double>(light->distance);
    emit /= punctual ? distance * distance : static_cast<double>(lights.cosineAt(light->light, light->wi));
    const double others =
        hit + rules_.power(emit) * (z.mis.connect + z.mis.onward * rules_.power(static_cast<double>(value->pdfBack)));
    const Rgb arriving = z.throughput * light->radiance * visible * static_cast<float>(1.0 / (direct * (1.0 + others)));
    for (std::size_t k = 0; k < 3; ++k) {
        if (isBlack(value->byKind[k])) continue;
        PathString path = z.before;
        path.pass(static_cast<LobeKinds>(1U << k));
        if (!left_.has(path)) sum.add(path, arriving * value->byKind[k]);
    }
}

/// A vertex of the eye path and one of the light path.
void Bidirectional::connect(const PathVertex& z, std::size_t lightVertex, LayeredRadiance& sum) noexcept {
    const PathVertex& y = light_.vertices()[lightVertex];
    if (!y.bsdf.connects()) return;
    const glm::vec3 to = y.hit.point.position - z.hit.point.position;
    const float distance2 = glm::dot(to, to), distance = std::sqrt(distance2);
    if (!(distance2 > 0.0F)) return;
    const glm::vec3 direction = to / distance;
    const auto atEye = eye_.valueTowards(z, direction);
    if (!atEye) return;
    const auto atLight = light_.valueTowards(y, -direction);
    if (!atLight) return;
    const glm::vec3 origin = offsetOrigin(z.hit.point.position, sideOf(z, direction)),
                    target = offsetOrigin(y.hit.point.position, sideOf(y, -direction));
    const float length = glm::length(target - origin);
    const Ray shadow{origin, length > 0.0F ? (target - origin) / length : direction, shadowLength(length)};
    const Rgb visible = transmittance(z, direction, shadow, distance);
    if (isBlack(visible)) return;
    const double cosEye = geometricCosine(z, direction), cosLight = geometricCosine(y, direction),
                 d2 = static_cast<double>(distance2);
    const double toLight = static_cast<double>(atEye->pdfOnward) * cosLight / d2,
                 toEye = static_cast<double>(atLight->pdfOnward) * cosEye / d2;
    const double others =
        rules_.power(toLight) * (y.mis.connect + y.mis.onward * rules_.power(static_cast<double>(atLight->pdfBack))) +
        rules_.power(toEye) * (z.mis.connect + z.mis.onward * rules_.power(static_cast<double>(atEye->pdfBack)));
    const Rgb scale = z.throughput * y.throughput * visible * static_cast<float>(cosLight / (d2 * (1.0 + others)));
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
            if (isBlack(atEye->byKind[a]) || isBlack(atLight->byKind[b])) continue;
            PathString path = z.before;
            path.pass(static_cast<LobeKinds>(1U << a));
            path.pass(static_cast<LobeKinds>(1U << b));
            path = withLightEnd(path, lightVertex);
            if (!left_.has(path)) sum.add(path, scale * atEye->byKind[a] * atLight->byKind[b]);
        }
}

}  // namespace pellucid
