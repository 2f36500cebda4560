// One sample of a render again, vertex by vertex.
#include <string>
#include <utility>

#include <pellucid/base/error.h>

#include "renderer.h"

namespace pellucid {

namespace {

[[nodiscard]] std::vector<TracedVertex> tracedVertices(const Subpath& path) {
    std::vector<TracedVertex> list;
    for (const PathVertex& v : path.vertices()) {
        TracedVertex t;
        t.position = v.hit.point.position;
        t.normal = v.bsdf.shadingNormal();
        t.distance = v.hit.distance;
        t.geometry = v.hit.point.geometry;
        t.primitive = v.hit.point.primitive;
        t.material = v.hit.point.material;
        t.kinds = v.bsdf.kinds();
        t.backSide = v.bsdf.backSide();
        t.throughput = v.throughput;
        list.push_back(t);
    }
    return list;
}

void refuseImpossible(const Camera& camera, Method method, int x, int y) {
    const std::string size = std::to_string(camera.width()) + "x" + std::to_string(camera.height());
    if (x < 0 || y < 0 || x >= camera.width() || y >= camera.height())
        throw Error(ErrorKind::Usage, "the image has no pixel " + std::to_string(x) + "," + std::to_string(y),
                    "--debug-sample", "it is " + size);
    if (method == Method::Light)
        throw Error(ErrorKind::Usage, "light tracing has no samples of a pixel", "--debug-sample",
                    "give another --method");
}

}  // namespace

SampleReplay Renderer::replay(PixelAt at, std::uint32_t sample) {
    // Without maps a sample depends on nothing that was before it.
    const Plan& plan = view_.plan;
    if (!plan.causticMap && !plan.otherPhotons && !plan.cache && !plan.adaptive) film_.countSamples(sample);
    while (film_.samples() < sample && !progress_.stopAsked()) {
        if (!iterate()) break;
        tell("iterations before the sample");
    }
    (void)makeRecords();
    shootPhotons();
    SampleReplay replay = view_.bidirectional() ? replayBidirectional(at) : replayWalk(at);
    replay.width = view_.camera.width();
    replay.height = view_.camera.height();
    return replay;
}

SampleReplay Renderer::replayBidirectional(PixelAt at) const {
    Bidirectional paths = eyes_.bidirectional();
    std::vector<LightSplat> splats;
    FirstHit first;
    SampleReplay replay;
    replay.radiance = eyes_.sample(paths, film_, at, splats, first);
    replay.vertices = tracedVertices(paths.eyePath());
    replay.lightVertices = tracedVertices(paths.lightPath());
    return replay;
}

/// Of the pixel's samples in this iteration the first one that is not finite, else the first.
SampleReplay Renderer::replayWalk(PixelAt at) {
    renewShares();
    const TransportContext context = eyeContext();
    Walk walk(context);
    FirstHit first;
    SampleReplay replay;
    const int share = film_.share(view_.pixelIndex(at.x, at.y));
    const PixelKernels kernels = eyes_.kernelsAt(photons(), at);
    for (int k = 0; k < share; ++k) {
        SampleReplay one;
        walk.writeTo(&one.vertices);
        one.radiance = eyes_.sample(walk, film_, kernels, at, k, first);
        const bool finite = isFinite(one.radiance.total());
        if (k > 0 && finite) continue;
        replay = std::move(one);
        if (!finite) break;
    }
    return replay;
}

SampleReplay replaySample(const Scene& scene, const RenderRequest& request, int x, int y, std::uint32_t sample,
                          const Workers& workers, const Progress& progress) {
    refuseImpossible(requestedCamera(scene, request), request.method, x, y);
    return Renderer(scene, request, workers, progress).replay({x, y}, sample);
}

}  // namespace pellucid
