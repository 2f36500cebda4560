/// A render's state on disk: whole or absent (temporary name, then rename), with a checksum and the key of what made it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

namespace pellucid {

/// What made a checkpoint: only the same render goes on from it.
struct CheckpointKey {
    std::string text;
};

/// Scene hash, method, seed, camera, size, windows and every setting.
[[nodiscard]] CheckpointKey checkpointKey(const Scene& scene, const RenderRequest& request, const Camera& camera);

/// How far the generations of the indirect side have come.
struct GenerationState {
    std::uint32_t next = 0;            ///< number of the one to come
    std::int32_t leastGatherRays = 0;  ///< that its records have
    std::uint32_t refinements = 0;     ///< of the running one's records
    double recordRays = 0.0;           ///< of all records so far
    double raysOfGeneration = 0.0;     ///< that the running one took
    double raysSince = 0.0;            ///< of the eye, that it has served
    double raysServed = 0.0;           ///< and all before it
};

struct CheckpointState {
    std::uint32_t iteration = 0;
    GenerationState generations;
    std::vector<char> film;
    std::vector<char> training, radii;                  ///< what guide and kernel radii have learnt
    std::uint32_t causticPaths = 0;                     ///< of an iteration to come
    std::uint64_t causticRays = 0, causticEmitted = 0;  ///< of all caustic passes so far
    std::vector<char> shrunk, others;  ///< radii by what each pixel has met: of the caustics, and others
    std::vector<char> penumbrae;       ///< where shadow rays differ
};

/// The bytes of a checkpoint's file around its body: what it is, and the checksum. (Apart so that the fuzzer can seal bodies.)
[[nodiscard]] std::string sealedCheckpoint(const std::string& body);

void writeCheckpoint(const std::filesystem::path& file, const CheckpointKey& key, const CheckpointState& state);

/// Empty when there is no such file; throws Error{BadInput} when it is damaged or belongs to another render.
[[nodiscard]] std::optional<CheckpointState> readCheckpoint(const std::filesystem::path& file,
                                                            const CheckpointKey& key);

}  // namespace pellucid
