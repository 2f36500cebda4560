/// The image that trials are measured against, in two halves with independent noise. Their product (I - R1)(I - R2) has
/// the mean (I - R)^2 without any noise of the reference in it, so a reference noisier than the trials still ranks
/// them. [D: E[(I - R1)(I - R2)] = E[I - R1] E[I - R2] for R1, R2 independent of each other and of I]
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <pellucid/math/image.h>
#include <pellucid/render/render.h>
#include <pellucid/study/compare.h>
#include <pellucid/study/tune.h>

namespace pellucid {

struct TuneReference {
    Image mean;           ///< of the halves
    Image first, second;  ///< R G B; without pixels where a file was given: `mean` stands for both
    Image weights;        ///< R G B: 1 / (R^2 + 0.01 mean(R)^2), 0 where nothing counts
    std::string name;     ///< of the file
    std::string key;      ///< what it is of: trials against another reference do not count
    std::string remark;   ///< for people; empty when there is nothing to say
    double noise = 0.0;   ///< relmse of a given file's own noise, if it tells; else 0
    double spent = 0.0;   ///< seconds for making it, now or before
    bool interrupted = false;

    /// Makes `weights`. Noise in R would enter the product through its weight, so R is blurred there until its noise is
    /// below 3 %; a clean reference is not blurred at all.
    void weigh();

    /// relmse of `image` over the windows (none: everywhere) without the reference's noise, and without the worst thousandth of
    /// the pixels: a lamp's glint there, which one render of a thousand meets, would else decide between settings. May come out
    /// slightly below 0.
    [[nodiscard]] double relmseTrimmed(const Image& image, const std::vector<PixelWindow>& windows) const;
};

/// DIR/reference.exr and its halves. `limit` in seconds, or nominal ones, for both halves together.
[[nodiscard]] TuneReference referenceFor(const TuneRequest& request, const SceneSource& scenes, double limit,
                                         const Workers& workers, const Progress& progress, const LogSink& log);

}  // namespace pellucid
