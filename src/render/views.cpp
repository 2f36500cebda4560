#include <pellucid/render/views.h>

#include <optional>
#include <utility>

#include "renderer.h"

namespace pellucid {

namespace {

/// Twice: what a later view adds shrinks the records of an earlier one beside it.
constexpr std::size_t kSweeps = 2;

/// The more views share the cost, the better the generation.
[[nodiscard]] std::uint32_t generationFor(std::size_t views) noexcept {
    if (views >= 8) return 2;
    return views >= 3 ? 1 : 0;
}

/// Learns what all views want of the light, view by view, then renders them from it.
class Flythrough {
public:
    Flythrough(const Scene& scene, const RenderRequest& request, const std::vector<std::string>& cameras,
               const Workers& workers, const Progress& progress)
        : scene_(scene), cameras_(cameras), workers_(workers), progress_(progress), frame_(request) {
        frame_.cacheFile.clear();
        if (frame_.settings.cache == "auto") frame_.settings.cache = "on";  // many views share its cost
    }

    /// One plan of the caustic map for all: records leave to it what it holds.
    void agreeOnCausticMap() {
        forViews(1, [&](std::size_t) {
            if (frame_.settings.causticMap == "auto" && prepareView(scene_, frame_, workers_).plan.causticMap)
                frame_.settings.causticMap = "on";
        });
    }

    /// Beginning with what `file` holds (empty: with nothing), and written there when something was added.
    void learn(const std::filesystem::path& file) {
        std::optional<LearntLight> light;
        if (!file.empty() && !cameras_.empty()) {
            frame_.camera = cameras_.front();
            light = readCacheFile(file, fileKey(prepareView(scene_, frame_, workers_)), scene_);
        }
        const double before = light ? light->rays : 0.0;
        forViews(kSweeps, [&](std::size_t i) {
            if (i >= cameras_.size() && (!light || light->rays == before)) return;
            if (i == cameras_.size()) light->seen.clear();
            light = withThisView(std::move(light));
        });
        if (!file.empty() && light && light->rays > before) {
            frame_.camera = cameras_.front();
            writeCacheFile(file, fileKey(prepareView(scene_, frame_, workers_)), *light);
        }
        light_ = std::move(light);
    }

    void render(const FrameDone& done) {
        std::size_t rendered = 0;
        const Progress ofAll{[&](ProgressReport r) { tell(rendered, r); }, progress_.interrupted};
        forViews(1, [&](std::size_t i) {
            Renderer renderer(scene_, frame_, workers_, progress_.report ? ofAll : progress_);
            if (light_) renderer.freeze(*light_);
            done(i, renderer.run());
            rendered = i + 1;
        });
    }

private:
    template <class Body>
    void forViews(std::size_t passes, const Body& body) {
        for (std::size_t i = 0; i < passes * cameras_.size() && !progress_.stopAsked(); ++i) {
            frame_.camera = cameras_[i % cameras_.size()];
            body(i);
        }
    }

    /// What is known and what this view adds to it; as it was where the view has no cache.
    [[nodiscard]] std::optional<LearntLight> withThisView(std::optional<LearntLight> known) const {
        RenderClock clock(frame_.budget);
        const PreparedView view = prepareView(scene_, frame_, workers_);
        if (!view.plan.cache) return known;
        IndirectLight indirect(view);
        indirect.startFrom(std::move(known), generationFor(cameras_.size()));
        indirect.renew(CausticSide(view).maps(PhotonSource(view, view.plan.training)), clock, progress_);
        return indirect.takeLight();
    }

    void tell(std::size_t rendered, ProgressReport r) const {
        r.fraction = (static_cast<double>(rendered) + r.fraction) / static_cast<double>(cameras_.size());
        r.secondsElapsed = secondsSince(start_);
        if (r.fraction > 0.0) r.secondsLeft = r.secondsElapsed * (1.0 / r.fraction - 1.0);
        progress_.report(r);
    }

    const Scene& scene_;
    const std::vector<std::string>& cameras_;
    const Workers& workers_;
    const Progress& progress_;
    WallClock::time_point start_ = WallClock::now();
    RenderRequest frame_;  ///< of the view under way
    std::optional<LearntLight> light_;
};

}  // namespace

void renderViews(const Scene& scene, const RenderRequest& request, const std::vector<std::string>& cameras,
                 const FrameDone& done, const Workers& workers, const Progress& progress) {
    Flythrough flythrough(scene, request, cameras, workers, progress);
    flythrough.agreeOnCausticMap();
    flythrough.learn(request.cacheFile);
    flythrough.render(done);
}

}  // namespace pellucid
