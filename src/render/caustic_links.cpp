#include <pellucid/render/caustic_links.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace pellucid {

namespace {

/// A lamp of more triangles is not tested for lying with its back to a caster.
constexpr std::size_t kMostTriangles = 4096;

[[nodiscard]] double percent(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

class Reasons {
public:
    Reasons(const Scene& scene, const CasterTally& tally, std::size_t receivers)
        : scene_(scene), tally_(tally), receivers_(receivers) {}

    [[nodiscard]] std::string of(std::size_t lamp, std::size_t caster) {
        const TalliedCaster& c = tally_.casters()[caster];
        const CasterFate f = tally_.fate(lamp, caster);
        const std::uint64_t emitted = tally_.emitted(lamp);
        if (f.useful > 0) return "";
        if (!c.smooth) return tooRough(c);
        if (receivers_ == 0) return "no receiver: the camera sees no diffuse surface";
        if (f.hit == 0 && behind(tally_.lamps()[lamp], caster)) return "behind the lamp: it shines the other way";
        if (f.hit == 0 && outsideCone(tally_.lamps()[lamp], caster)) return "outside of the spot's cone";
        if (emitted == 0) return std::string(kNoPilotPath);
        if (f.hit == 0)
            return fmt::format(
                "not met: {:.3g} % of the lamp's paths leave the scene, the rest meet other surfaces first",
                percent(tally_.missed(lamp), emitted));
        if (f.deposited == 0)
            return fmt::format(
                "no receiver behind it: {:.3g} % leave the scene, the rest end in it or at surfaces that are not "
                "diffuse",
                percent(f.escaped, f.hit));
        return "no receiver in view: its photons land where the camera does not look";
    }

private:
    [[nodiscard]] std::string tooRough(const TalliedCaster& c) const {
        const LobeRules& rules = scene_.surfaces().rules();
        const Material& m = scene_.description().materials[c.materials.front()];
        const bool body = m.transmission > 0.0F && m.thickness > 0.0F;
        return fmt::format("too rough to cast: {:.3g} is above surface.{}cast_roughness {:.3g}; path traced",
                           c.roughness, body ? "glass_" : "", body ? rules.glassCastRoughness : rules.castRoughness);
    }

    [[nodiscard]] const Bounds& boundsOf(std::size_t caster) {
        const auto [known, fresh] = bounds_.try_emplace(caster);
        if (!fresh) return known->second;
        const SceneDescription& d = scene_.description();
        const auto& materials = tally_.casters()[caster].materials;
        for (std::uint32_t g = 0; g < d.geometries.size(); ++g) {
            const Mesh& mesh = d.meshes[d.geometries[g].mesh];
            if (std::find(materials.begin(), materials.end(), mesh.material) == materials.end()) continue;
            for (std::uint32_t p = 0; p < mesh.triangles.size(); ++p)
                for (const glm::vec3& corner : scene_.corners(g, p)) known->second.extend(corner);
        }
        return known->second;
    }

    /// Whether every triangle of the lamp has the caster's bounds at its dark side: a half-space holds a box when it holds its corners.
    [[nodiscard]] bool behind(const TalliedLamp& lamp, std::size_t caster) {
        if (lamp.kind != LightKind::Triangle || lamp.lights.size() > kMostTriangles) return false;
        const SceneDescription& d = scene_.description();
        const Bounds& box = boundsOf(caster);
        std::size_t found = 0;
        for (std::uint32_t g = 0; g < d.geometries.size(); ++g) {
            const Mesh& mesh = d.meshes[d.geometries[g].mesh];
            if (mesh.material != lamp.source) continue;
            for (std::uint32_t p = 0; p < mesh.triangles.size(); ++p) {
                const std::uint32_t light = scene_.lights().lightOf(g, p);
                if (light == Lights::kNoLight) continue;
                ++found;
                const glm::vec3 from = scene_.corners(g, p)[0];
                for (int i = 0; i < 8; ++i) {
                    const glm::vec3 to((i & 1) != 0 ? box.upper.x : box.lower.x,
                                       (i & 2) != 0 ? box.upper.y : box.lower.y,
                                       (i & 4) != 0 ? box.upper.z : box.lower.z);
                    const glm::vec3 along = to - from;
                    if (!(glm::dot(along, along) > 0.0F) ||
                        scene_.lights().pdfEmission(light, glm::normalize(along)).direction > 0.0F)
                        return false;
                }
            }
        }
        return found > 0;
    }

    [[nodiscard]] bool outsideCone(const TalliedLamp& lamp, std::size_t caster) {
        if (lamp.kind != LightKind::Spot || lamp.source == TalliedLamp::kUnknown) return false;
        const PunctualLight& light = scene_.description().lights[lamp.source];
        const Normalisation& n = scene_.normalisation();
        const glm::dvec3 to = glm::dvec3(boundsOf(caster).centre()) - (light.position - n.centre) * n.scale();
        const double distance = glm::length(to), radius = static_cast<double>(boundsOf(caster).radius());
        if (!(distance > radius)) return false;
        const double angle = std::acos(std::clamp(glm::dot(to, light.direction) / distance, -1.0, 1.0));
        return angle - std::asin(radius / distance) > light.outerCone;
    }

    const Scene& scene_;
    const CasterTally& tally_;
    std::size_t receivers_;
    std::map<std::size_t, Bounds> bounds_;
};

}  // namespace

std::vector<CausticLink> causticLinks(const Scene& scene, const CasterTally& tally, std::size_t receivers) {
    Reasons reasons(scene, tally, receivers);
    struct Ranked {
        CausticLink link;
        double power;
    };
    std::vector<Ranked> ranked;
    for (std::size_t l = 0; l < tally.lamps().size(); ++l)
        for (std::size_t c = 0; c < tally.casters().size(); ++c) {
            const CasterFate f = tally.fate(l, c);
            CausticLink link;
            link.lamp = tally.lamps()[l].name;
            link.caster = tally.casters()[c].name;
            link.lampIndex = l;
            link.casterIndex = c;
            link.emitted = tally.emitted(l);
            link.hit = f.hit;
            link.deposited = f.deposited;
            link.useful = f.useful;
            link.reason = reasons.of(l, c);
            ranked.push_back({std::move(link), tally.lamps()[l].power});
        }
    std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
        if (a.link.useful != b.link.useful) return a.link.useful > b.link.useful;
        if (a.link.hit != b.link.hit) return a.link.hit > b.link.hit;
        return a.power > b.power;
    });
    std::vector<CausticLink> links;
    for (Ranked& r : ranked) links.push_back(std::move(r.link));
    return links;
}

std::vector<CausticLink> shortened(const std::vector<CausticLink>& links, std::size_t rows) {
    if (links.size() <= rows) return links;
    std::vector<CausticLink> few(links.begin(), links.begin() + static_cast<std::ptrdiff_t>(rows - 1));
    CausticLink rest;
    rest.lamp = fmt::format("{} more pairs", links.size() - few.size());
    for (std::size_t i = few.size(); i < links.size(); ++i) {
        rest.hit += links[i].hit;
        rest.deposited += links[i].deposited;
        rest.useful += links[i].useful;
        rest.watched = rest.watched || links[i].watched;
        rest.stored += links[i].stored;
        rest.used += links[i].used;
    }
    few.push_back(std::move(rest));
    return few;
}

}  // namespace pellucid
