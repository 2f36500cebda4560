/// What one view has learnt serves another: by a file, and in a flythrough. The same light, fewer gather rays, nothing stale.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/io/views_file.h>
#include <pellucid/render/views.h>
#include <pellucid/scene/scene.h>

#include "../../src/render/point_cloud.h"
#include "../support/files.h"
#include "../support/same_bits.h"
#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;
using test::expectSameBits;
using namespace testing::detail;

/// A corner with a glass ball under a lamp; three cameras side by side that look the same way, and one that is near.
[[nodiscard]] SceneDescription ballInCorner() {
    check::SceneBuilder b;
    addCorner(b, coloured({0.7F, 0.6F, 0.5F}), coloured({0.3F, 0.6F, 0.7F}));
    b.sphere({-0.4, 0.45, 0.1}, 0.4, 12, check::glass(1.5F), true);
    b.box({0.3, 0.0, -0.4}, {0.7, 0.8, 0.1}, coloured({0.5F, 0.5F, 0.5F}));
    b.square({0.2, 1.9, 0.3}, {0, -1, 0}, 0.35, check::lamp(9.0F));
    b.perspective({0.5, 1.0, 3.3}, {0.1, 0.6, 0}, 0.62);
    b.perspective({0.7, 1.0, 3.2}, {0.2, 0.6, 0}, 0.62);
    b.perspective({0.45, 0.5, 0.9}, {0.3, 0.1, 0.1}, 0.62);
    b.perspective({0.6, 0.25, 0.95}, {0.6, 0.0, 0.75}, 0.62);
    for (std::size_t i = 0; i < b.description().cameras.size(); ++i)
        b.description().cameras[i].name = "camera " + std::to_string(i);
    b.description().contentHash = "ball in corner";
    return b.description();
}

[[nodiscard]] RenderRequest smallRequest(const std::string& camera, std::uint32_t samples = 4) {
    RenderRequest request;
    request.width = 48;
    request.height = 36;
    request.camera = camera;
    request.budget.samples = samples;
    request.settings.globalPhotons = 20'000;
    request.settings.maxSpacing = 8.0;
    request.settings.minSpacing = 1.0;
    return request;
}

[[nodiscard]] const StageRecord& stage(const RenderRecord& record, const std::string& name) {
    for (const StageRecord& s : record.stages)
        if (s.name == name) return s;
    throw std::runtime_error("no stage " + name);
}

[[nodiscard]] double mean(const Image& image, const std::string& channel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels(); ++i) sum += static_cast<double>(image.at(i, image.channel(channel)));
    return sum / static_cast<double>(image.pixels());
}

class Views : public ::testing::Test {
protected:
    [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }

    [[nodiscard]] RenderResult renderWith(const RenderRequest& request, const std::string& file) const {
        RenderRequest own = request;
        if (!file.empty()) own.cacheFile = path(file);
        return render(scene_, own, workers_);
    }
    /// The words of the error that a render with this file ends in.
    [[nodiscard]] std::string refusal(const Scene& scene, const RenderRequest& request, const std::string& file) const {
        RenderRequest own = request;
        own.cacheFile = path(file);
        try {
            (void)render(scene, own, workers_);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::BadInput);
            return e.what();
        }
        return "not refused";
    }

    Workers workers_{2};
    Scene scene_{ballInCorner(), std::nullopt, SceneOptions{}, workers_};

private:
    test::TemporaryFolder folder_;
};

TEST_F(Views, TheSameViewFromItsFileHasTheSameBits) {
    const RenderResult without = renderWith(smallRequest("camera 1"), "");
    const RenderResult first = renderWith(smallRequest("camera 1"), "cache");
    const std::string written = test::bytesOf(path("cache"));
    const RenderResult again = renderWith(smallRequest("camera 1"), "cache");
    expectSameBits(without.image, first.image);
    expectSameBits(first.image, again.image);
    EXPECT_EQ(test::bytesOf(path("cache")), written) << "nothing was added, so nothing is to be written";
    EXPECT_FALSE(without.record.reuse.asked);
    EXPECT_EQ(first.record.reuse.recordsReused, 0U);
    EXPECT_GT(first.record.reuse.recordsNew, 50U);
    EXPECT_EQ(again.record.reuse.recordsReused, first.record.reuse.recordsNew);
    EXPECT_EQ(again.record.reuse.recordsNew, 0U);
    EXPECT_EQ(again.record.reuse.placesNew, 0U);
    EXPECT_EQ(stage(again.record, "irradiance cache").rays, 0U);
    EXPECT_EQ(stage(again.record, "global photons").rays, 0U);
}

/// The noise of 20,000 photons and of a record's gather rays makes 1.5 % a seed.
TEST_F(Views, AMovedCameraSeesTheSameLight) {
    std::vector<double> known, own;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto seen = [&](const char* camera, const std::string& file) {
            RenderRequest request = smallRequest(camera);
            request.seed = seed;
            return mean(renderWith(request, file).image, "indirect.G");
        };
        const std::string file = "cache " + std::to_string(seed);
        (void)seen("camera 1", file);
        known.push_back(seen("camera 2", file));
        own.push_back(seen("camera 2", ""));
    }
    const testing::MeanOfSeeds a = testing::meanOfSeeds(known), b = testing::meanOfSeeds(own);
    EXPECT_GT(testing::welch(a, b), testing::sidakLevel(1)) << a.mean << " for " << b.mean;
    EXPECT_LT(std::sqrt(a.variance + b.variance), 0.015 * b.mean) << "tells a loss";
    EXPECT_NEAR(a.mean / b.mean, 1.0, 0.02);
}

TEST_F(Views, AMovedCameraAddsOnlyWhatItLacks) {
    const RenderResult first = renderWith(smallRequest("camera 1"), "cache");
    fs::copy_file(path("cache"), path("for one thread"));
    const RenderResult moved = renderWith(smallRequest("camera 2"), "cache");
    const RenderResult fresh = renderWith(smallRequest("camera 2"), "");
    const auto gathered = static_cast<double>(stage(moved.record, "irradiance cache").rays);
    EXPECT_LT(gathered, 0.4 * static_cast<double>(stage(fresh.record, "irradiance cache").rays));
    EXPECT_EQ(moved.record.reuse.recordsReused, first.record.reuse.recordsNew);
    EXPECT_GT(moved.record.reuse.recordsNew, 0U);
    // The file knows both views now.
    const RenderResult back = renderWith(smallRequest("camera 2"), "cache");
    EXPECT_EQ(back.record.reuse.recordsNew, 0U);
    EXPECT_EQ(back.record.reuse.recordsReused, moved.record.reuse.recordsReused + moved.record.reuse.recordsNew);

    RenderRequest alone = smallRequest("camera 2");
    alone.cacheFile = path("for one thread");
    expectSameBits(render(scene_, alone, Workers(1)).image, moved.image);
    EXPECT_EQ(test::bytesOf(path("for one thread")), test::bytesOf(path("cache")));
}

/// The last camera looks at a patch of the floor from a tenth of the distance at which the first has seen it whole: there is
/// no point without a record there, only records too coarse for it.
TEST_F(Views, RecordsFromFarAwayAreRefinedForANearView) {
    std::uint64_t seed = 0;
    const auto openly = [&seed](const std::string& camera) {  // only the pixels' footprints bound how far records speak
        RenderRequest request = smallRequest(camera);
        request.seed = seed;
        request.settings.cacheError = 1.0;
        request.settings.causticMap = "on";  // for each, whatever it sees: their records leave the same light to it
        request.settings.gatherRays = 1024;
        return request;
    };
    (void)renderWith(openly("camera 1"), "cache");
    RenderRequest request = openly("camera 4");
    request.layers = {"record_radius", "record_age"};
    const RenderResult near = renderWith(request, "cache"), fresh = renderWith(request, "");
    EXPECT_GT(near.record.reuse.recordsReused, 20U);
    const double refined = mean(near.image, "record_radius.Y"), own = mean(fresh.image, "record_radius.Y");
    EXPECT_GT(own, 0.0);
    EXPECT_LT(refined, 2.0 * own) << "what speaks here reaches as far as a view from here would have it";
    EXPECT_LT(mean(near.image, "record_age.Y"), 0.5) << "most of what speaks was made for this view";
    EXPECT_EQ(mean(fresh.image, "record_age.Y"), 0.0);
    // 20,000 photons make 3.5 % a seed; on the mean of eight the two differ by 3 %.
    double ratio = 0.0;
    for (seed = 1; seed <= 4; ++seed) {
        const std::string file = "cache " + std::to_string(seed);
        (void)renderWith(openly("camera 1"), file);
        ratio += mean(renderWith(openly("camera 4"), file).image, "indirect.G") /
                 mean(renderWith(openly("camera 4"), "").image, "indirect.G") / 4;
    }
    EXPECT_NEAR(ratio, 1.0, 0.08);
}

TEST_F(Views, AStaleFileIsRefusedWithTheReason) {
    (void)renderWith(smallRequest("camera 1", 1), "cache");
    RenderRequest other = smallRequest("camera 1", 1);
    other.settings.gatherRays = 200;
    EXPECT_NE(refusal(scene_, other, "cache").find("cache.rays=auto there, 200 here"), std::string::npos)
        << refusal(scene_, other, "cache");
    other = smallRequest("camera 1", 1);
    other.settings.maxDepth = 3;
    EXPECT_NE(refusal(scene_, other, "cache").find("path.max_depth=0 there, 3 here"), std::string::npos);
    SceneDescription changed = ballInCorner();
    changed.materials[0].baseColor.r = 0.6F;
    const Scene scene(std::move(changed), std::nullopt, SceneOptions{}, workers_);
    EXPECT_NE(
        refusal(scene, smallRequest("camera 1", 1), "cache").find("made from something else: geometry, materials"),
        std::string::npos);
    // What only concerns the view is free.
    other = smallRequest("camera 1", 1);
    other.settings.alpha = 0.8;
    other.seed = 9;
    const ReuseReport reuse = renderWith(other, "cache").record.reuse;
    EXPECT_GT(reuse.recordsReused, 5 * reuse.recordsNew);
}

TEST_F(Views, AShorterTimeReadsTheFileOfALongerOne) {
    RenderRequest request = smallRequest("camera 1", 1);
    request.settings.globalPhotons = Settings{}.globalPhotons;
    request.budget.seconds = 1000.0;
    const ReuseReport first = renderWith(request, "cache").record.reuse;
    request.budget.seconds = 2.0;  // the plan gives so short a time fewer photons
    EXPECT_EQ(renderWith(request, "cache").record.reuse.recordsReused, first.recordsNew);
    request.settings.globalPhotons = 20'000;  // an asked number is a setting like others
    EXPECT_NE(refusal(scene_, request, "cache").find("photon.global=auto there, 20000 here"), std::string::npos)
        << refusal(scene_, request, "cache");
}

TEST_F(Views, ACameraThatMovedInTheSceneFileReusesWhatIsLearnt) {
    (void)renderWith(smallRequest("camera 1", 1), "cache");
    SceneDescription moved = ballInCorner();
    moved.contentHash = "the file with a moved camera";
    moved.cameras[1].toWorld[3] += glm::dvec4(0.02, 0.01, 0.0, 0.0);
    const Scene scene(std::move(moved), std::nullopt, SceneOptions{}, workers_);
    RenderRequest request = smallRequest("camera 1", 1);
    request.cacheFile = path("cache");
    const ReuseReport reuse = render(scene, request, workers_).record.reuse;
    EXPECT_GT(reuse.recordsReused, 5 * reuse.recordsNew);
}

TEST_F(Views, ADamagedFileIsRefused) {
    (void)renderWith(smallRequest("camera 1", 1), "cache");
    const std::string whole = test::bytesOf(path("cache"));
    const auto refused = [&](const std::string& bytes) {
        std::ofstream(path("bad"), std::ios::binary | std::ios::trunc) << bytes;
        const std::string words = refusal(scene_, smallRequest("camera 1", 1), "bad");
        EXPECT_EQ(test::bytesOf(path("bad")), bytes) << "a refused file stays as it is";
        return words;
    };
    for (const std::size_t at : {whole.size() - 1, whole.size() / 2, std::size_t{40}}) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 1);
        EXPECT_NE(refused(flipped).find("damaged"), std::string::npos) << at;
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{20}, whole.size() / 2, whole.size() - 1})
        EXPECT_NE(refused(whole.substr(0, size)).find("damaged"), std::string::npos) << size;
    std::string version = whole;
    version.replace(version.find('\n') - 1, 1, "0");
    EXPECT_NE(refused(version).find("version"), std::string::npos);
}

/// A floor beside a wall, under a sequence of orthographic cameras that are shifted by exactly four pixels each.
[[nodiscard]] SceneDescription shiftedViews() {
    check::SceneBuilder b;
    b.quad({-2, 0, 1}, {4, 0, 0}, {0, 0, -2}, coloured({0.7F, 0.6F, 0.5F}));
    b.quad({-2, 0, -1}, {4, 0, 0}, {0, 2, 0}, coloured({0.6F, 0.6F, 0.7F}));
    b.box({0.1, 0.0, -0.6}, {0.3, 0.4, -0.4}, coloured({0.5F, 0.5F, 0.5F}));
    b.square({-0.3, 1.9, -0.3}, {0, -1, 0}, 0.4, check::lamp(9.0F));
    for (int i = 0; i < 3; ++i) {
        CameraSpec camera;
        camera.name = "frame " + std::to_string(i);
        camera.orthographic = true;
        camera.xmag = camera.ymag = 0.6;
        const double pixel = 2.0 * camera.ymag / 36.0;
        camera.toWorld = glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0),
                                    glm::dvec4(4 * pixel * i, 1.5, 0, 1));
        b.description().cameras.push_back(camera);
    }
    b.description().contentHash = "shifted views";
    return b.description();
}

/// Root mean square of the difference of two frames' indirect light where they show the same.
[[nodiscard]] double flicker(const Image& a, const Image& b, int shift) {
    double sum = 0.0, light = 0.0;
    int count = 0;
    const int channel = a.channel("indirect.G");
    for (int y = 0; y < a.height(); ++y)
        for (int x = shift; x < a.width(); ++x, ++count) {
            const auto at = [&](const Image& image, int column) {
                return static_cast<double>(image.at(static_cast<std::size_t>(y * image.width() + column), channel));
            };
            sum += std::pow(at(a, x) - at(b, x - shift), 2.0);
            light += at(a, x);
        }
    return std::sqrt(sum / count) / (light / count);
}

/// Mean square of the difference of two frames where they show the same, over what their pixels' noise alone would make.
[[nodiscard]] double differenceByNoise(const Image& a, const Image& b, int shift) {
    double sum = 0.0, noise = 0.0;
    const int red = a.channel("R"), variance = a.channel("variance.Y");
    const auto luminanceAt = [red](const Image& image, std::size_t pixel) {
        return static_cast<double>(
            luminance(Rgb(image.at(pixel, red), image.at(pixel, red + 1), image.at(pixel, red + 2))));
    };
    for (int y = 0; y < a.height(); ++y)
        for (int x = shift; x < a.width(); ++x) {
            const auto pixel = static_cast<std::size_t>(y * a.width() + x),
                       same = pixel - static_cast<std::size_t>(shift);
            sum += std::pow(luminanceAt(a, pixel) - luminanceAt(b, same), 2.0);
            noise += static_cast<double>(a.at(pixel, variance)) + static_cast<double>(b.at(same, variance));
        }
    return sum / noise;
}

TEST_F(Views, AFlythroughDoesNotFlicker) {
    const Scene scene(shiftedViews(), std::nullopt, SceneOptions{}, workers_);
    RenderRequest request = smallRequest("", 16);
    request.layers = {"variance"};
    std::vector<RenderResult> frames;
    renderViews(
        scene, request, {"frame 0", "frame 1", "frame 2"},
        [&](std::size_t i, RenderResult result) {
            EXPECT_EQ(i, frames.size());
            frames.push_back(std::move(result));
        },
        workers_);
    ASSERT_EQ(frames.size(), 3U);
    for (const RenderResult& frame : frames) {
        EXPECT_EQ(frame.record.reuse.recordsReused, frames[0].record.reuse.recordsReused);
        EXPECT_EQ(frame.record.reuse.recordsNew, 0U);
        EXPECT_EQ(stage(frame.record, "irradiance cache").rays, 0U);
    }
    const auto alone = [&](const std::string& camera) {
        RenderRequest own = request;
        own.camera = camera;
        return render(scene, own, workers_).image;
    };
    const double shared = flicker(frames[0].image, frames[1].image, 4),
                 apart = flicker(alone("frame 0"), alone("frame 1"), 4);
    EXPECT_LT(shared, 0.5 * apart) << shared << " against " << apart;
    EXPECT_LT(differenceByNoise(frames[0].image, frames[1].image, 4), 1.3);
    EXPECT_LT(differenceByNoise(frames[1].image, frames[2].image, 4), 1.3);
    EXPECT_NEAR(mean(frames[1].image, "G") / mean(alone("frame 1"), "G"), 1.0, 0.02);
}

TEST_F(Views, AFlythroughReadsAndFillsTheCacheFile) {
    std::size_t records = 0;
    RenderRequest request = smallRequest("", 1);
    request.cacheFile = path("cache");
    const auto keep = [&](std::size_t, const RenderResult& result) { records = result.record.reuse.recordsReused; };
    renderViews(scene_, request, {"camera 1", "camera 2"}, keep, workers_);
    const std::size_t first = records;
    EXPECT_GT(first, 50U);
    const std::string written = test::bytesOf(path("cache"));
    renderViews(scene_, request, {"camera 2", "camera 1"}, keep, workers_);
    EXPECT_EQ(records, first);
    EXPECT_EQ(test::bytesOf(path("cache")), written);
}

TEST(ViewsFile, LinesBecomeCameras) {
    const auto views = parseViews(
        "# a path\n\neye 0 1 4 target 0 1 0\r\n  target 1 1 1 fov 90 eye 1 1 3 up 1 0 0 # lies on its side\n",
        "path.txt", 0.5);
    ASSERT_EQ(views.size(), 2U);
    EXPECT_EQ(views[0].toWorld, glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0),
                                           glm::dvec4(0, 1, 4, 1)));
    EXPECT_EQ(views[0].verticalFov, 0.5);
    EXPECT_EQ(views[1].toWorld[1], glm::dvec4(1, 0, 0, 0));
    EXPECT_EQ(views[1].toWorld[0], glm::dvec4(0, -1, 0, 0));
    EXPECT_NEAR(views[1].verticalFov, 1.5707963, 1e-6);
    EXPECT_NE(views[0].name, views[1].name);
}

TEST(ViewsFile, WhatCannotBeIsNamedWithItsLine) {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            (void)parseViews(text, "path.txt", 0.5);
        } catch (const Error& e) {
            return e.what();
        }
        return "not refused";
    };
    for (const auto& [text, words] :
         std::vector<std::pair<std::string, std::string>>{{"", "no view"},
                                                          {"# nothing", "no view"},
                                                          {"eye 0 1 4 target 0 1 0\neye 1 2 3", "line 2"},
                                                          {"target 1 2 3", "the eye is missing"},
                                                          {"eye 0 1 x target 0 1 0", "'x'"},
                                                          {"eye 0 1 4 target 0 1", "''"},
                                                          {"eye 0 1 4 target 0 1 nan", "'nan'"},
                                                          {"eye 0 1 4 target 0 1 4", "the same point"},
                                                          {"eye 0 1 4 target 0 -1 4", "up points along"},
                                                          {"eye 0 1 4 target 0 1 0 fov 180", "180"},
                                                          {"eye 0 1 4 target 0 1 0 fovy 30", "'fovy'"}})
        EXPECT_NE(refusal(text).find(words), std::string::npos) << text << ": " << refusal(text);
}

/// Header lines, and the floats of each vertex (the colour's three bytes left out).
struct Ply {
    std::vector<std::string> properties;
    std::vector<std::vector<float>> vertices;
};

[[nodiscard]] Ply readPly(const std::string& bytes) {
    Ply ply;
    std::size_t at = 0, count = 0, floats = 0;
    for (std::string line; line != "end_header";) {
        const std::size_t end = bytes.find('\n', at);
        if (end == std::string::npos) throw std::runtime_error("no end of the header");
        line = bytes.substr(at, end - at);
        at = end + 1;
        if (line.starts_with("element vertex ")) count = std::stoul(line.substr(15));
        if (line.starts_with("property ")) ply.properties.push_back(line.substr(line.rfind(' ') + 1));
        if (line.starts_with("property float")) ++floats;
    }
    const std::size_t stride = 4 * floats + (ply.properties.size() - floats);
    EXPECT_EQ(bytes.size() - at, count * stride);
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<float> vertex(floats);
        std::memcpy(vertex.data(), bytes.data() + at + i * stride, 4 * floats);
        ply.vertices.push_back(std::move(vertex));
    }
    return ply;
}

TEST_F(Views, PointCloudsStandInTheScenesOwnMetres) {
    const double scale = 37.0;
    const glm::dvec3 moved(1000, -200, 50);
    SceneDescription far = check::transformed(ballInCorner(), scale, moved);
    const Scene scene(std::move(far), std::nullopt, SceneOptions{}, workers_);
    RenderRequest request = smallRequest("camera 1", 1);
    request.pointsFolder = path("points");
    const RenderResult result = render(scene, request, workers_);
    const std::string records = test::bytesOf(path("points") / "records.ply");
    EXPECT_TRUE(records.starts_with("ply\nformat binary_little_endian 1.0\n"));
    const Ply ply = readPly(records);
    EXPECT_EQ(ply.vertices.size(), stage(result.record, "irradiance cache").records);
    EXPECT_EQ(ply.properties.size(), 13U);
    for (const std::vector<float>& v : ply.vertices) {
        const glm::dvec3 p = (glm::dvec3(v[0], v[1], v[2]) - moved) / scale;
        EXPECT_TRUE(p.x >= -1.01 && p.x <= 1.01 && p.y >= -0.01 && p.y <= 2.01 && p.z >= -1.01 && p.z <= 1.01)
            << p.x << " " << p.y << " " << p.z;
        EXPECT_GT(v[9], 0.0F);
    }
    const Ply photons = readPly(test::bytesOf(path("points") / "caustic-photons.ply"));
    EXPECT_EQ(photons.vertices.size(), stage(result.record, "caustic photons").photonsStored);
    EXPECT_EQ(photons.properties[11], "flux_blue");
    // Flux in watts grows with the area of the lamp.
    RenderRequest small = smallRequest("camera 1", 1);
    small.pointsFolder = path("small");
    (void)render(scene_, small, workers_);
    const auto flux = [](const Ply& cloud) {
        double sum = 0.0;
        for (const std::vector<float>& v : cloud.vertices) sum += static_cast<double>(v[10]);
        return sum;
    };
    EXPECT_NEAR(flux(photons) / flux(readPly(test::bytesOf(path("small") / "caustic-photons.ply"))) / (scale * scale),
                1.0, 0.05);
}

}  // namespace
}  // namespace pellucid
