/// record.json and the plan as text: what a render did, or would do, with every number that decided it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pellucid/render/render.h>

namespace pellucid {

/// As --method takes it.
[[nodiscard]] std::string methodName(Method method);

/// What a RenderRecord does not know of itself.
struct RecordContext {
    std::string version, sceneFile, sceneHash;
    Method method = Method::Photon;
    int width = 0, height = 0;
    std::uint64_t seed = 0;
    std::vector<std::string> images;  ///< files written, as the user named them
    std::uint64_t peakRssBytes = 0;
    bool interrupted = false;
};

/// record.json of the command line's contract. Figures that are not finite become null.
[[nodiscard]] std::string recordJson(const RenderRecord& record, const RecordContext& context);

/// `plan --json`: the same keys as far as they are known before rendering; stages[] holds predictions.
[[nodiscard]] std::string planJson(const RenderRecord& plan, const RecordContext& context);

/// `plan`: decision, choice and reason; the predicted passes; the blind spots.
[[nodiscard]] std::string planText(const RenderRecord& plan, const RecordContext& context);

}  // namespace pellucid
