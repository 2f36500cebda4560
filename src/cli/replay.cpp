// `pellucid render --debug-sample X,Y,S`: take one sample again and print its path, in metres, vertex by vertex.
#include <array>
#include <string>

#include <fmt/format.h>

#include <pellucid/study/record_json.h>

#include "commands.h"
#include "process.h"
#include "scene_loading.h"
#include "terminal.h"
#include "terminal_progress.h"

namespace pellucid {
namespace {

[[nodiscard]] std::string rgb(const Rgb& value) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", value.r, value.g, value.b);
}

[[nodiscard]] std::string lobesText(LobeKinds kinds) {
    std::string text;
    for (const auto& [kind, letter] : {std::pair(kSpecular, "S"), std::pair(kGlossy, "G"), std::pair(kDiffuse, "D")})
        if ((kinds & kind) != kNoLobe) text += (text.empty() ? "" : "+") + std::string(letter);
    return text.empty() ? "none" : text;
}

[[nodiscard]] std::string vertexText(const TracedVertex& v, const Scene& scene, std::size_t number) {
    const Normalisation& n = scene.normalisation();
    if (!v.hit)
        return fmt::format("{:3}  leaves the scene along {:.6g} {:.6g} {:.6g}, throughput {}\n", number, v.position.x,
                           v.position.y, v.position.z, rgb(v.throughput));
    const glm::dvec3 metres = glm::dvec3(v.position) / n.scale() + n.centre;
    const std::string& material = scene.description().materials[v.material].name;
    return fmt::format(
        "{:3}  at {:.7g} {:.7g} {:.7g} m after {:.6g} m, normal {:.4f} {:.4f} {:.4f}{}\n"
        "     material {}{}, lobes {}{}, geometry {}, triangle {}\n"
        "     throughput {}, radiance so far {}\n",
        number, metres.x, metres.y, metres.z, static_cast<double>(v.distance) / n.scale(), v.normal.x, v.normal.y,
        v.normal.z, v.backSide ? ", from behind" : "", v.material, material.empty() ? "" : " '" + material + "'",
        lobesText(v.kinds),
        v.wave.chosen() && (v.kinds & kSpecular) != kNoLobe ? fmt::format(" at {:.1f} nm", v.wave.nanometres) : "",
        v.geometry, v.primitive, rgb(v.throughput), rgb(v.before.total()));
}

[[nodiscard]] std::string replayText(const SampleReplay& replay, const Scene& scene) {
    std::string text;
    for (std::size_t i = 0; i < replay.vertices.size(); ++i) text += vertexText(replay.vertices[i], scene, i + 1);
    if (!replay.lightVertices.empty())
        text += "the light path beside it, its throughput in watts of the normalised scene:\n";
    for (std::size_t i = 0; i < replay.lightVertices.size(); ++i)
        text += vertexText(replay.lightVertices[i], scene, i + 1);
    constexpr std::array kNames{"emission", "direct", "caustic", "indirect"};
    for (std::size_t c = 0; c < kNames.size(); ++c)
        text += fmt::format("{:<9} {}\n", kNames[c], rgb(replay.radiance.layer[c]));
    return text + fmt::format("radiance  {}{}\n", rgb(replay.radiance.total()),
                              isFinite(replay.radiance.total()) ? "" : "   (not finite)");
}

}  // namespace

int runReplay(const RenderArguments& arguments) {
    const SceneArguments& common = arguments.common;
    const Workers workers(common.threads);
    const auto scene = loadScene(common, true, workers, terminalLog(common.quiet));
    const SampleName& name = *arguments.debugSample;
    SampleReplay replay;
    {
        TerminalProgress terminal(common.quiet);
        Progress progress;
        progress.report = [&terminal](const ProgressReport& report) { terminal.report(report); };
        replay = replaySample(*scene, makeRequest(common), name.x, name.y, name.sample, workers, progress);
    }
    printResult(fmt::format("pixel {},{} of {}x{}, sample {}, seed {}, method {}\n", name.x, name.y, replay.width,
                            replay.height, name.sample, common.seed, methodName(common.method)) +
                replayText(replay, *scene));
    return 0;
}

}  // namespace pellucid
