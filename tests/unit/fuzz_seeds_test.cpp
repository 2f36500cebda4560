// The seeds that the fuzzers of binary formats start from must still be of today's formats: else every mutation of them
// ends at the first field. A format that changed says so here; PELLUCID_WRITE_SEEDS=1 writes the checkpoint's seeds anew.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/render/film.h>

#include "../../src/render/cache_file.h"
#include "../../src/render/checkpoint.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

const fs::path kSeeds = fs::path(PELLUCID_SOURCE_DIR) / "tests/fuzz/seeds";

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A checkpoint of a film of 2 x 2, as the fuzzer's film is, with two samples a pixel, a splat and a sample that is not finite.
CheckpointState stateOfTwoSamples() {
    Film film(2, 2);
    for (std::uint32_t n = 0; n < 2; ++n) {
        for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
            LayeredRadiance radiance;
            radiance.add(stringOver({kDiffuse}), Rgb(0.5F + 0.25F * static_cast<float>(pixel + n)));
            FirstHit first;
            first.albedo = Rgb(0.5F);
            film.add(pixel, n, radiance, first);
        }
        film.addSplats({{n, Rgb(0.125F), stringOver({kDiffuse, kSpecular})}}, n);
        film.countSamples(1);
    }
    CheckpointState state;
    state.iteration = 2;
    state.generations.next = 1;
    state.generations.raysOfGeneration = 1e5;
    state.generations.raysSince = 3e4;
    state.film = film.save();
    for (int i = 0; i < 24; ++i) state.training.push_back(static_cast<char>(i));
    state.radii = std::vector<char>(16, 1);
    state.causticPaths = 65536;
    state.causticRays = 200'000;
    state.causticEmitted = 131'072;
    return state;
}

/// The body alone: without what stands before it in the file.
std::string bodyOf(const CheckpointState& state) {
    const fs::path file = fs::path(testing::TempDir()) / "pellucid_seed.state";
    writeCheckpoint(file, {"key"}, state);
    const std::string all = bytesOf(file);
    fs::remove(file);
    return all.substr(sealedCheckpoint({}).size());
}

TEST(FuzzSeeds, CheckpointsAreOfTodaysFormat) {
    CheckpointState empty = stateOfTwoSamples();
    empty.film.clear(), empty.training.clear(), empty.radii.clear();
    const std::string body = bodyOf(stateOfTwoSamples()), blocks = bodyOf(empty);
    // Lengths follow: a block that says it goes on for 2^63 bytes.
    std::string endless = blocks.substr(0, blocks.size() - 3 * sizeof(std::uint64_t));
    endless += std::string(7, '\0') + "\x80" + "abc";
    for (const auto& [name, bytes] :
         {std::pair("body", body), std::pair("empty-blocks", blocks), std::pair("long-block", endless)}) {
        const fs::path file = kSeeds / "checkpoint" / name;
        if (std::getenv("PELLUCID_WRITE_SEEDS") != nullptr) writeFile(file, bytes);
        EXPECT_EQ(bytesOf(file).size(), bytes.size())
            << file << " is of an older format: run this test with PELLUCID_WRITE_SEEDS=1 and look at what it wrote";
    }
    const fs::path file = fs::path(testing::TempDir()) / "pellucid_seed.state";
    writeFile(file, sealedCheckpoint(bytesOf(kSeeds / "checkpoint/body")));
    const auto state = readCheckpoint(file, {"key"});
    ASSERT_TRUE(state);
    Film film(2, 2);
    EXPECT_TRUE(film.restore(state->film));
    EXPECT_EQ(film.samples(), 2U);
    fs::remove(file);
}

TEST(FuzzSeeds, CacheFilesAreOfTodaysFormat) {
    Bounds scene;
    scene.extend(glm::vec3(-1.0F));
    scene.extend(glm::vec3(1.0F));
    for (const char* name : {"records", "records-and-map"}) {
        const std::string bytes = bytesOf(kSeeds / "cache_file" / name);
        const LearntLight light = parseCacheBody(bytes, name, nullptr, scene);
        EXPECT_GT(light.cache->records().size(), 0U) << name;
        EXPECT_EQ(light.map != nullptr, std::string(name) == "records-and-map");
    }
}

}  // namespace
}  // namespace pellucid
