#include <pellucid/render/render.h>

#include "renderer.h"

namespace pellucid {

RenderResult render(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress,
                    const LogSink& log) {
    (void)log;
    return Renderer(scene, request, workers, progress).run();
}

RenderRecord planOnly(const Scene& scene, const RenderRequest& request, const Workers& workers, const LogSink& log) {
    (void)log;
    return Renderer(scene, request, workers, {}).plan();
}

}  // namespace pellucid
