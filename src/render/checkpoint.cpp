#include "checkpoint.h"

#include <pellucid/base/error.h>

#include "sealed_file.h"

namespace pellucid {

namespace {

constexpr SealedKind kCheckpoint{"pellucid checkpoint 10\n", "the checkpoint", "delete it and render from the start"};
constexpr std::int32_t kMostGatherRays = 1'000'000;

}  // namespace

CheckpointKey checkpointKey(const Scene& scene, const RenderRequest& request, const Camera& camera) {
    std::string key = scene.hash() + "|" + std::to_string(static_cast<int>(request.method)) + "|" +
                      std::to_string(request.seed) + "|" + request.camera + "|" + std::to_string(camera.width()) + "x" +
                      std::to_string(camera.height());
    for (const auto& [name, value] : settingsAsText(request.settings)) key += "|" + name + "=" + value;
    for (const PixelWindow& w : request.windows)
        for (const int side : {w.x0, w.y0, w.x1, w.y1}) key += "|" + std::to_string(side);
    return {key};
}

std::string sealedCheckpoint(const std::string& body) { return seal(kCheckpoint, body); }

void writeCheckpoint(const std::filesystem::path& file, const CheckpointKey& key, const CheckpointState& state) {
    ByteWriter body;
    body.putBlock(key.text);
    body.put(state.iteration);
    const GenerationState& g = state.generations;
    body.put(g.next);
    body.put(g.leastGatherRays);
    body.put(g.refinements);
    for (const double rays : {g.recordRays, g.raysOfGeneration, g.raysSince, g.raysServed}) body.put(rays);
    body.put(state.causticPaths);
    body.put(state.causticRays);
    body.put(state.causticEmitted);
    for (const std::vector<char>* block :
         {&state.film, &state.training, &state.radii, &state.shrunk, &state.others, &state.penumbrae})
        body.putBlock(*block);
    writeSealed(file, kCheckpoint, body.bytes());
}

std::optional<CheckpointState> readCheckpoint(const std::filesystem::path& file, const CheckpointKey& key) {
    const auto body = readSealed(file, kCheckpoint);
    if (!body) return std::nullopt;
    ByteReader reader(*body);
    if (reader.getBlock<std::string>() != key.text)
        throw Error(ErrorKind::BadInput,
                    "the checkpoint belongs to another render (scene, camera, size, seed, method or settings differ)",
                    file.string(), "give the same arguments as before, or delete it");
    CheckpointState state;
    state.iteration = reader.get<std::uint32_t>();
    GenerationState& g = state.generations;
    g.next = reader.get<std::uint32_t>();
    g.leastGatherRays = reader.get<std::int32_t>();
    g.refinements = reader.get<std::uint32_t>();
    for (double* rays : {&g.recordRays, &g.raysOfGeneration, &g.raysSince, &g.raysServed}) *rays = reader.get<double>();
    state.causticPaths = reader.get<std::uint32_t>();
    state.causticRays = reader.get<std::uint64_t>();
    state.causticEmitted = reader.get<std::uint64_t>();
    for (std::vector<char>* block :
         {&state.film, &state.training, &state.radii, &state.shrunk, &state.others, &state.penumbrae})
        *block = reader.getBlock<std::vector<char>>();
    const bool rays = g.leastGatherRays >= 0 && g.leastGatherRays <= kMostGatherRays;
    if (!reader.good() || !rays) refuseDamaged(file, kCheckpoint);
    return state;
}

}  // namespace pellucid
