/// A flythrough: one image for each of several cameras, all from the same cache records and the same global map, so that what
/// does not move does not flicker. What all the views want is learnt before the first frame; then nothing is added.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <pellucid/render/render.h>

namespace pellucid {

/// `frame` counts from 0 in the order of the cameras.
using FrameDone = std::function<void(std::size_t frame, RenderResult result)>;

/// The request's budget is that of each frame, beside what is learnt for all; its cache file is read before and written after
/// that. Ends early when `progress` asks for it: the frame that was under way is still handed over, as interrupted.
void renderViews(const Scene& scene, const RenderRequest& request, const std::vector<std::string>& cameras,
                 const FrameDone& done, const Workers& workers, const Progress& progress = {});

}  // namespace pellucid
