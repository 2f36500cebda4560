#include "eye_side.h"

#include <algorithm>
#include <numeric>

#include "pass_keys.h"
#include "setting_choices.h"
#include "surface_edges.h"

namespace pellucid {

namespace {

constexpr int kTile = 16;

[[nodiscard]] int tilesIn(int pixels) noexcept { return (pixels + kTile - 1) / kTile; }

[[nodiscard]] glm::vec2 cornerOf(PixelAt at) noexcept { return {static_cast<float>(at.x), static_cast<float>(at.y)}; }

}  // namespace

std::size_t EyeSide::tiles() const noexcept {
    return static_cast<std::size_t>(tilesIn(view_.camera.width())) *
           static_cast<std::size_t>(tilesIn(view_.camera.height()));
}

template <class Body>
void EyeSide::forTiles(const Body& body) const {
    const int across = tilesIn(view_.camera.width());
    view_.workers.forEach(tiles(), 1, [&](std::size_t tile) {
        const int x0 = static_cast<int>(tile) % across * kTile, y0 = static_cast<int>(tile) / across * kTile;
        body(tile, [&](const auto& visit) {
            for (int y = y0; y < std::min(y0 + kTile, view_.camera.height()); ++y)
                for (int x = x0; x < std::min(x0 + kTile, view_.camera.width()); ++x) visit(PixelAt{x, y});
        });
    });
}

PixelKernels EyeSide::kernelsAt(const PhotonSides& photons, PixelAt at) const {
    PixelKernels kernels;
    kernels.caustic.footprints = photons.caustics.kernelFootprints(at.x, at.y);
    kernels.others.footprints = photons.others.kernelFootprints(at.x, at.y);
    const std::string& edges = view_.request.settings.edges;
    if (edges == "off") return kernels;
    const auto leaves = [&](const PixelKernel& kernel) {
        return nearEdge(view_.survey.points, view_.camera.width(), at.x, at.y, kernel.footprints);
    };
    kernels.caustic.edge = edges == "on" && view_.plan.causticMap && leaves(kernels.caustic);
    kernels.others.edge = view_.plan.otherPhotons && leaves(kernels.others);
    return kernels;
}

LayeredRadiance EyeSide::sample(Walk& walk, const Film& film, const PixelKernels& kernels, PixelAt at, int number,
                                FirstHit& first, StringSums* strings, ShadowTally* shadows) const {
    const std::size_t pixel = view_.pixelIndex(at.x, at.y);
    const std::uint32_t before = view_.plan.adaptive ? film.taken(pixel) : film.samples();
    Sampler sampler(view_.request.seed, pixel, before + static_cast<std::uint32_t>(number),
                    samplerKind(view_.request.settings.sampler));
    const glm::vec2 jitter = sampler.next2D(), lens = sampler.next2D();
    const CameraRay ray = view_.camera.ray(cornerOf(at) + jitter, lens);
    walk.sampleLamps(penumbrae_.lampSamples(at.x, at.y), shadows);
    return walk.fromEye({ray.ray, ray.footprintAtOrigin, ray.footprintSpread, Rgb(0.0F), kernels}, sampler, &first,
                        strings);
}

void EyeSide::addSamples(Walk& walk, Strings& strings, PixelAt at, const PhotonSides& photons, Film& film) {
    const std::size_t pixel = view_.pixelIndex(at.x, at.y);
    const std::uint64_t before = walk.rays();
    const int share = film.share(pixel);
    LayeredRadiance sum;
    FirstHit firsts;
    ShadowTally shadows;
    strings.ofPixel.clear();
    if (film.keepsStrings()) sum.strings = &strings.ofPixel;
    const PixelKernels kernels = kernelsAt(photons, at);
    for (int k = 0; k < share; ++k) {
        FirstHit first;
        PhotonTally tally;
        // The further samples of an iteration meet the same photons.
        const bool counts = k == 0 && (photons.caustics.wantsTally() || view_.plan.otherPhotons);
        walk.tallyTo(counts ? &tally : nullptr);
        strings.ofSample.clear();
        const LayeredRadiance radiance =
            sample(walk, film, kernels, at, k, first, film.keepsStrings() ? &strings.ofSample : nullptr, &shadows);
        if (counts) photons.caustics.met(pixel, tally.caustic), photons.others.met(pixel, tally.other);
        if (!film.admit(pixel, film.samples(), radiance)) continue;
        sum.addShare(radiance, 1.0F / static_cast<float>(share));
        firsts.addShare(first, 1.0F / static_cast<float>(share));
    }
    film.add(pixel, film.samples(), sum, firsts, share, walk.rays() - before);
    if (view_.plan.cache || view_.plan.otherPhotons) penumbrae_.met(at.x, at.y, shadows);
}

std::uint64_t EyeSide::pass(const TransportContext& context, const PhotonSides& photons, Film& film,
                            RenderClock& clock) {
    const StageTimer timer(stage_, clock, view_.pixels.scale());
    std::vector<std::uint64_t> rays(tiles(), 0);
    forTiles([&](std::size_t tile, const auto& forPixels) {
        Walk walk(context);
        Strings strings;
        forPixels([&](PixelAt at) {
            if (view_.pixels.contains(view_.pixelIndex(at.x, at.y))) addSamples(walk, strings, at, photons, film);
        });
        rays[tile] = walk.rays();
    });
    film.countSamples(1);
    const std::uint64_t total = view_.pixels.ofWholeImage(std::accumulate(rays.begin(), rays.end(), std::uint64_t{0}));
    stage_.rays += total;
    return total;
}

Bidirectional EyeSide::bidirectional() const noexcept {
    return {view_.scene, view_.camera, view_.options, static_cast<std::uint32_t>(view_.pixelCount())};
}

LayeredRadiance EyeSide::sample(Bidirectional& paths, const Film& film, PixelAt at, std::vector<LightSplat>& splats,
                                FirstHit& first, StringSums* strings) const {
    const SamplerKind numbers = samplerKind(view_.request.settings.sampler);
    const std::size_t pixel = view_.pixelIndex(at.x, at.y);
    Sampler eye(view_.request.seed, pixel, film.samples(), numbers);
    Sampler light(view_.request.seed, kBidirectionalPass + film.samples(), static_cast<std::uint32_t>(pixel), numbers);
    const glm::vec2 jitter = eye.next2D(), lens = eye.next2D();
    return paths.sample(view_.camera.ray(cornerOf(at) + jitter, lens).ray, eye, light, splats, &first, strings);
}

/// Splats wait in their tile and are added in the order of the tiles.
void EyeSide::bidirectionalPass(std::vector<LightSplat> splats, Film& film) {
    const StageTimer timer(stage_);
    std::vector<std::uint64_t> rays(tiles(), 0);
    std::vector<std::vector<LightSplat>> ofTile(tiles());
    forTiles([&](std::size_t tile, const auto& forPixels) {
        Bidirectional paths = bidirectional();
        StringSums strings;
        forPixels([&](PixelAt at) {
            FirstHit first;
            strings.clear();
            const LayeredRadiance radiance =
                sample(paths, film, at, ofTile[tile], first, film.keepsStrings() ? &strings : nullptr);
            film.add(view_.pixelIndex(at.x, at.y), film.samples(), radiance, first);
        });
        rays[tile] = paths.rays();
    });
    for (const auto& s : ofTile) splats.insert(splats.end(), s.begin(), s.end());
    film.addSplats(splats, film.samples());
    film.countSamples(1);
    stage_.rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    stage_.photonsEmitted += film.pixels();
}

}  // namespace pellucid
