/// Every model, environment and malformed file beside the repository, loaded and rendered small by both methods: no crash,
/// no sample that is not finite, and errors only of the kind that names file and place. Under asan-ubsan as well.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/io/gltf.h>
#include <pellucid/io/image_file.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

namespace pellucid {
namespace {

namespace fs = std::filesystem;

const fs::path kShared(PELLUCID_SHARED_SCENES);

std::vector<fs::path> filesUnder(const fs::path& folder, const std::vector<std::string>& extensions) {
    std::vector<fs::path> files;
    if (!fs::is_directory(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (std::ranges::find(extensions, entry.path().extension().string()) != extensions.end())
            files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

RenderResult renderSmall(const Scene& scene, Method method, const Workers& workers) {
    RenderRequest request;
    request.method = method;
    request.width = request.height = 32;
    request.budget.samples = 2;
    request.settings.globalPhotons = 20'000;
    return render(scene, request, workers);
}

void expectWholePicture(const RenderResult& result) {
    EXPECT_EQ(result.record.nonfinite.count, 0U)
        << "first at pixel " << result.record.nonfinite.x << "," << result.record.nonfinite.y << ", sample "
        << result.record.nonfinite.sample;
    const bool whole = std::ranges::all_of(result.image.data(), [](float v) { return std::isfinite(v); });
    EXPECT_TRUE(whole) << "the image holds values that are not finite";
}

/// With white light from all sides where the file has none.
std::unique_ptr<Scene> sceneFrom(const fs::path& file, const Workers& workers) {
    const SceneDescription description = loadGltf(file);
    try {
        return std::make_unique<Scene>(description, std::nullopt, SceneOptions{}, workers);
    } catch (const Error& error) {
        if (error.problem().find("no light") == std::string::npos) throw;
    }
    EnvironmentDescription white;
    white.constant = Rgb(1.0F);
    return std::make_unique<Scene>(description, white, SceneOptions{}, workers);
}

void expectRenders(const fs::path& file, const Workers& workers) {
    SCOPED_TRACE(file.string());
    std::unique_ptr<Scene> scene;
    ASSERT_NO_THROW(scene = sceneFrom(file, workers));
    for (const Method method : {Method::Path, Method::Photon}) {
        SCOPED_TRACE(method == Method::Path ? "path" : "photon");
        RenderResult result;
        ASSERT_NO_THROW(result = renderSmall(*scene, method, workers));
        expectWholePicture(result);
    }
}

TEST(SharedScenes, EveryModelRenders) {
    if (!fs::is_directory(kShared)) GTEST_SKIP() << "no shared scenes";
    const Workers workers(2);
    int files = 0;
    for (const char* folder : {"generated", "bitterli", "luxcore", "mitsuba-cbox", "khronos"})
        for (const fs::path& file : filesUnder(kShared / folder, {".glb", ".gltf"})) {
            // The one model that *requires* an extension that we do not know: it must be refused by that name.
            if (file.stem() == "IridescenceSuzanne") {
                try {
                    (void)loadGltf(file);
                    ADD_FAILURE() << "KHR_materials_iridescence is required, but the file loads";
                } catch (const Error& error) {
                    EXPECT_NE(error.problem().find("KHR_materials_iridescence"), std::string::npos) << error.what();
                }
                continue;
            }
            expectRenders(file, workers);
            ++files;
        }
    EXPECT_GT(files, 0);
}

TEST(SharedScenes, OurOwnScenesRender) {
    const Workers workers(2);
    for (const fs::path& file : filesUnder(fs::path(PELLUCID_SOURCE_DIR) / "scenes", {".glb"}))
        expectRenders(file, workers);
}

TEST(SharedScenes, EveryEnvironmentLights) {
    const std::vector<fs::path> maps = filesUnder(kShared / "envmaps", {".exr", ".hdr"});
    if (maps.empty()) GTEST_SKIP() << "no shared scenes";
    const Workers workers(2);
    const SceneDescription description = loadGltf(fs::path(PELLUCID_SOURCE_DIR) / "scenes/corner-open.glb");
    for (const fs::path& map : maps) {
        SCOPED_TRACE(map.string());
        const Scene scene(description, loadEnvironment(map.string()), SceneOptions{}, workers);
        expectWholePicture(renderSmall(scene, Method::Photon, workers));
    }
}

TEST(SharedScenes, MalformedFilesRenderOrAreRefused) {
    const std::vector<fs::path> files = filesUnder(kShared / "malformed", {".glb", ".gltf"});
    if (files.empty()) GTEST_SKIP() << "no shared scenes";
    const Workers workers(2);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.string());
        std::unique_ptr<Scene> scene;
        try {
            scene = sceneFrom(file, workers);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            EXPECT_FALSE(error.problem().empty() || error.where().empty() || error.mend().empty()) << error.what();
            continue;
        }
        expectWholePicture(renderSmall(*scene, Method::Photon, workers));
    }
}

}  // namespace
}  // namespace pellucid
