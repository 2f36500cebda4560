// Which surface a ray meets where several lie in one place.
#include <optional>
#include <string>
#include <utility>

#include "scene_impl.h"

namespace pellucid {

namespace {

/// Whether light crosses from one clear body to the other as within one.
[[nodiscard]] bool sameGlass(const Material& a, const Material& b) noexcept {
    return a.ior == b.ior && a.dispersion == b.dispersion && a.absorption == b.absorption;
}

}  // namespace

void Scene::Impl::findCoincidentFaces(const LogSink& log) {
    coincident = CoincidentFaces(description, placements);
    if (coincident.pairs() > 0)
        logTo(
            log, LogLevel::Info,
            std::to_string(coincident.pairs()) +
                " pairs of faces lie in one place: glass in an opaque face is not met, nor are two faces of one glass");
    if (coincident.gaveUp())
        logTo(log, LogLevel::Warning,
              "so many faces of glass, lamps or covers overlap in one place that not all were held against each other; "
              "light may be lost where faces coincide");
}

FacesMet Scene::Impl::meet(const SurfacePoint& p) const noexcept {
    FacesMet met;
    const FaceRank rank = coincident.rankOf(p.material);
    const auto inPlace = [&](FaceRank wanted) -> std::optional<SurfacePoint> {
        if (wanted == rank) return p;
        const auto raw = coincident.find(wanted, p);
        return raw ? std::optional(surfacePoint(*raw)) : std::nullopt;
    };
    if (const auto cover = inPlace(FaceRank::Cover)) met.add(*cover);
    for (const FaceRank next : {FaceRank::Lamp, FaceRank::Solid, FaceRank::Body, FaceRank::Pane}) {
        const auto face = inPlace(next);
        if (!face) continue;
        if (next == FaceRank::Body)
            addGlass(*face, met);
        else
            met.add(*face);
        break;
    }
    return met;
}

/// Two bodies of clear glass that touch have one interface: the face of the one that comes first, with the other beyond it.
void Scene::Impl::addGlass(const SurfacePoint& p, FacesMet& met) const noexcept {
    const auto raw = coincident.touching(p);
    if (!raw) return met.add(p);
    SurfacePoint other = surfacePoint(*raw), face = p;
    if (sameGlass(description.materials[p.material], description.materials[other.material])) return;
    if (FaceId{other.geometry, other.primitive} < FaceId{p.geometry, p.primitive}) std::swap(face, other);
    face.beyond = other.material;
    met.add(face);
}

}  // namespace pellucid
