#include <pellucid/transport/caster_tally.h>

#include <bit>
#include <map>

namespace pellucid {

namespace {

constexpr std::size_t kMostCasters = 64;  ///< bits of a path; the last stands for all others
/// From this share on a metal or glass that is too rough is told of; a plastic's rough coat is not.
constexpr float kWouldCast = 0.5F;

[[nodiscard]] std::string nameOr(const std::string& name, const char* what, std::size_t number) {
    return name.empty() ? what + (' ' + std::to_string(number)) : name;
}

/// Which of the description's lights of this kind are lights of the scene: black ones are dropped.
[[nodiscard]] std::vector<std::uint32_t> shining(const SceneDescription& scene, PunctualKind kind) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
        if (scene.lights[i].kind == kind && isFinite(scene.lights[i].intensity) &&
            average(scene.lights[i].intensity) > 0.0F)
            kept.push_back(i);
    return kept;
}

[[nodiscard]] bool punctual(LightKind kind, PunctualKind& as) noexcept {
    if (kind == LightKind::Point)
        as = PunctualKind::Point;
    else if (kind == LightKind::Spot)
        as = PunctualKind::Spot;
    else if (kind == LightKind::Directional)
        as = PunctualKind::Directional;
    else
        return false;
    return true;
}

void count(std::atomic<std::uint64_t>& counter) noexcept { counter.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

CasterTally::CasterTally(const Scene& scene) {
    findLamps(scene);
    findCasters(scene);
    emitted_ = std::vector<std::atomic<std::uint64_t>>(lamps_.size());
    missed_ = std::vector<std::atomic<std::uint64_t>>(lamps_.size());
    counts_ = std::vector<std::atomic<std::uint64_t>>(lamps_.size() * casters_.size() * kCounts);
}

void CasterTally::findLamps(const Scene& scene) {
    const Lights& lights = scene.lights();
    const SceneDescription& description = scene.description();
    const auto number = static_cast<std::uint32_t>(lights.count());
    std::vector<std::uint32_t> materialOf(number, TalliedLamp::kUnknown);
    for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
        const Mesh& mesh = description.meshes[description.geometries[g].mesh];
        if (maxComponent(description.materials[mesh.material].emission) <= 0.0F) continue;
        for (std::uint32_t p = 0; p < mesh.triangles.size(); ++p)
            if (const std::uint32_t light = lights.lightOf(g, p); light != Lights::kNoLight)
                materialOf[light] = mesh.material;
    }
    std::map<std::uint32_t, std::uint32_t> lampOfMaterial;
    std::map<LightKind, std::size_t> seen;
    lampOf_.resize(number);
    for (std::uint32_t light = 0; light < number; ++light) {
        TalliedLamp lamp;
        lamp.kind = lights.kind(light);
        lamp.source = TalliedLamp::kUnknown;
        PunctualKind kind{};
        if (lamp.kind == LightKind::Triangle) {
            lamp.source = materialOf[light];
            const auto [known, fresh] =
                lampOfMaterial.try_emplace(lamp.source, static_cast<std::uint32_t>(lamps_.size()));
            if (fresh && lamp.source != TalliedLamp::kUnknown)
                lamp.name = nameOr(description.materials[lamp.source].name, "material", lamp.source);
            lampOf_[light] = known->second;
        } else {
            lampOf_[light] = static_cast<std::uint32_t>(lamps_.size());
            if (punctual(lamp.kind, kind)) {
                const auto kept = shining(description, kind);
                const std::size_t index = seen[lamp.kind]++;
                if (index < kept.size()) lamp.source = kept[index];
                lamp.name = nameOr(lamp.source == TalliedLamp::kUnknown ? "" : description.lights[lamp.source].name,
                                   "light", light);
            } else {
                lamp.name = "environment";
            }
        }
        if (lampOf_[light] == lamps_.size()) lamps_.push_back(std::move(lamp));
        lamps_[lampOf_[light]].lights.push_back(light);
        lamps_[lampOf_[light]].power += lights.power(light);
    }
}

void CasterTally::findCasters(const Scene& scene) {
    const SceneDescription& description = scene.description();
    bits_.assign(description.materials.size(), 0);
    std::vector<bool> used(description.materials.size(), false);
    for (const Geometry& g : description.geometries) used[description.meshes[g.mesh].material] = true;
    for (const bool smooth : {true, false})
        for (std::uint32_t m = 0; m < description.materials.size(); ++m) {
            const Material& material = description.materials[m];
            const LobeKinds kinds = scene.surfaces().possibleKinds(m);
            const bool casts = (kinds & kSpecular) != kNoLobe;
            const bool would = (kinds & kGlossy) != kNoLobe &&
                               (material.metallic >= kWouldCast || material.transmission >= kWouldCast);
            if (!used[m] || casts != smooth || !(casts || would)) continue;
            if (casters_.size() < kMostCasters)
                casters_.push_back({nameOr(material.name, "material", m), {}, casts, material.roughness});
            else
                casters_.back().name = "further materials", casters_.back().smooth = casters_.back().smooth || casts;
            casters_.back().materials.push_back(m);
            bits_[m] = std::uint64_t{1} << (casters_.size() - 1);
        }
}

void CasterTally::add(std::uint32_t light, const Path& path, int vertices, bool escaped) noexcept {
    const std::size_t lamp = lampOf_[light];
    count(emitted_[lamp]);
    if (vertices == 0) count(missed_[lamp]);
    for (std::uint64_t rest = path.met; rest != 0; rest &= rest - 1) {
        const std::uint64_t bit = rest & (~rest + 1);
        const std::size_t at = cell(lamp, static_cast<std::size_t>(std::countr_zero(rest)));
        count(counts_[at + kHit]);
        if ((path.deposited & bit) != 0)
            count(counts_[at + kDeposited]);
        else if (escaped)
            count(counts_[at + kEscaped]);
        if ((path.useful & bit) != 0) count(counts_[at + kUseful]);
    }
}

std::uint64_t CasterTally::emitted(std::size_t lamp) const noexcept { return emitted_[lamp]; }
std::uint64_t CasterTally::missed(std::size_t lamp) const noexcept { return missed_[lamp]; }

CasterFate CasterTally::fate(std::size_t lamp, std::size_t caster) const noexcept {
    const std::size_t at = cell(lamp, caster);
    return {counts_[at + kHit], counts_[at + kDeposited], counts_[at + kUseful], counts_[at + kEscaped]};
}

}  // namespace pellucid
