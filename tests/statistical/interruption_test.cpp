/// A render that is asked to stop, whatever it is doing, goes on from its checkpoint to the bits of one that never was.
#include <algorithm>
#include <atomic>
#include <string>

#include <gtest/gtest.h>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "../support/files.h"
#include "../support/same_bits.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

/// Stops for good when asked for the `last`-th time.
class Patience {
public:
    explicit Patience(int last) : last_(last) {}
    [[nodiscard]] Progress progress() {
        return {{}, [this] { return ++asked_ >= last_; }};
    }
    [[nodiscard]] int asked() const noexcept { return asked_; }

private:
    int last_;
    std::atomic<int> asked_{0};
};

/// Interrupts at every question that an unbroken render is asked; every fourth time once more on the way back.
void expectSameBitsOverAnyBreak(const Scene& scene, const RenderRequest& request, const RenderResult& whole,
                                int questions, const Workers& workers) {
    for (int question = 1; question <= questions; ++question) {
        const test::TemporaryFolder folder;
        RenderRequest broken = request;
        broken.checkpoint = folder / "checkpoint";
        Patience once(question);
        EXPECT_TRUE(render(scene, broken, workers, once.progress()).interrupted);
        broken.resume = true;
        if (question % 4 == 0) {
            Patience soon(2);
            EXPECT_TRUE(render(scene, broken, workers, soon.progress()).interrupted);
        }
        SCOPED_TRACE("stopped at question " + std::to_string(question) + " of " + std::to_string(questions));
        test::expectSameBits(whole.image, render(scene, broken, workers).image);
    }
}

TEST(Interruption, AtAnyMomentLeavesTheBitsOfTheUnbroken) {
    const Workers workers(2);
    const Scene scene(roomLitByItsCeiling(), std::nullopt, SceneOptions{}, workers);
    RenderRequest request;
    request.width = 32;
    request.height = 24;
    request.budget.samples = 24;
    for (const bool generations : {false, true}) {
        // Records made again with more rays; or without a map several generations of few rays.
        setParameter(request.settings, "photon.global", generations ? "0" : "1000");
        if (generations) setParameter(request.settings, "cache.rays", "16");
        Patience endless(1 << 30);
        const RenderResult whole = render(scene, request, workers, endless.progress());
        const bool again = std::ranges::any_of(whole.record.decisions,
                                               [](const Decision& d) { return d.name == "records made again"; });
        EXPECT_EQ(again, !generations);
        expectSameBitsOverAnyBreak(scene, request, whole, endless.asked(), workers);
    }
}

}  // namespace
}  // namespace pellucid
