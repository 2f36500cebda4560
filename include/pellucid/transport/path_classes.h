/// The ledger: which class a light path belongs to and which estimator carries it. Written down here and nowhere else.
///
/// Each lobe is Specular (S: casts caustics), Glossy (G: neither) or Diffuse (D: receives), a fixed property in every pass.
/// For the four layers G counts as a non-casting surface, written X for "G or D":
///   emission  E S* L            direct  E S* X L            caustic  E S* X S+ L            indirect  everything else
///
/// Estimators of the photon method, by the first D vertex x seen from the eye and, behind it, the next D vertex y:
///   no x                        E (S|G)* L                path tracing (next-event estimation with MIS at every G)
///   light reaches x at once     E (S|G)* D L              next-event estimation at x
///   light comes over S only     E (S|G)* D S+ L           the caustic map, which holds L S+ D photons only; a path from x
///                                                         that meets a lamp over S alone adds 0. Where lamps are large the
///                                                         plan may leave the map out: then beside the cache each eye path
///                                                         goes on from x over S lobes alone, and carries just this class
///   over S and at least one G   E (S|G)* D S* G (S|G)* L  path tracing inside the gather
///   over another D vertex y     E (S|G)* D (S|G)* D ...   irradiance cache / gather; at y the global map (all photons)
/// A pass that the plan leaves out hands its class back to path tracing, never to nothing.
///
/// Beyond the four layers every path has a class of its own, its string of vertices read from the eye: a run of S is one
/// letter, G and D are one each, at most three letters; what goes on after them ends the string with _ (PathString).
/// E S+ D S+ L is "ESDSL", E D D D D L is "EDDD_L". The photon method knows of light that its cache or map returns only
/// what stands before the receiver: its share of E p D ... L, without E p D L and E p D S+ L, stands in "EpD_L".
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <pellucid/math/rgb.h>
#include <pellucid/surface/bsdf.h>

namespace pellucid {

enum class PathClass : std::uint8_t { Emission, Direct, Caustic, Indirect };
inline constexpr int kPathClasses = 4;

/// The string of a path's vertices: letters of two bits (first letter lowest) and "goes on". Five letters are told apart, three
/// have names and codes.
class PathString {
public:
    static constexpr int kCodes = 128;

    constexpr PathString() noexcept = default;
    constexpr bool operator==(const PathString&) const noexcept = default;
    constexpr explicit PathString(std::uint8_t code) noexcept
        : letters_(code & kNamed), goesOn_((code & (kNamed + 1U)) != 0) {}

    /// The path goes over one more vertex by a lobe of this kind (exactly one bit).
    constexpr void pass(LobeKinds kind) noexcept {
        if (goesOn_) return;
        const unsigned letter = kind == kSpecular ? kS : kind == kGlossy ? kG : kD;
        unsigned place = 0;
        while (place < kLetters && (unsigned{letters_} >> (2 * place) & 3U) != 0) ++place;
        if (letter == kS && place > 0 && (unsigned{letters_} >> (2 * place - 2) & 3U) == kS) return;
        if (place < kLetters)
            letters_ = static_cast<std::uint16_t>(letters_ | letter << (2 * place));
        else
            goesOn_ = true;
    }
    /// The same with everything behind it left open.
    [[nodiscard]] constexpr PathString open() const noexcept {
        PathString all = *this;
        all.goesOn_ = true;
        return all;
    }

    /// Below kCodes: the first three letters, and whether anything comes after them.
    [[nodiscard]] constexpr std::uint8_t code() const noexcept {
        const bool more = goesOn_ || letters_ > kNamed;
        return static_cast<std::uint8_t>((letters_ & kNamed) | (more ? kNamed + 1U : 0U));
    }
    /// "EDSL", "ED_L".
    [[nodiscard]] std::string name() const;

    /// The layer of a path whose vertices are these.
    [[nodiscard]] constexpr PathClass layer() const noexcept {
        unsigned rest = letters_;
        if ((rest & 3U) == kS) rest >>= 2U;
        if (rest == 0) return goesOn_ ? PathClass::Indirect : PathClass::Emission;
        if (rest <= kD) return goesOn_ ? PathClass::Indirect : PathClass::Direct;
        return !goesOn_ && (rest == (kG | kS << 2U) || rest == (kD | kS << 2U)) ? PathClass::Caustic
                                                                                : PathClass::Indirect;
    }

private:
    static constexpr unsigned kS = 1, kG = 2, kD = 3, kLetters = 5;
    static constexpr unsigned kNamed = 63;  ///< bits of three letters
    std::uint16_t letters_ = 0;
    bool goesOn_ = false;
};

/// The string over these kinds of lobes, from the eye.
[[nodiscard]] constexpr PathString stringOver(std::initializer_list<LobeKinds> kinds) noexcept {
    PathString path;
    for (const LobeKinds kind : kinds) path.pass(kind);
    return path;
}

inline constexpr PathString kSeenCaustic = stringOver({kSpecular, kDiffuse, kSpecular});
inline constexpr PathString kSeenCausticOfCaustic = stringOver({kSpecular, kDiffuse, kSpecular, kDiffuse, kSpecular});

/// Classes that another estimator carries: a walk adds nothing to them.
struct LeftClasses {
    bool caustics = false;      ///< E X S+ L: light tracing
    bool seenCaustics = false;  ///< E S+ D S+ L and E S+ D S+ D S+ L: texel irradiance

    [[nodiscard]] constexpr bool has(PathString path) const noexcept {
        if (caustics && (path == stringOver({kDiffuse, kSpecular}) || path == stringOver({kGlossy, kSpecular})))
            return true;
        return seenCaustics && (path == kSeenCaustic || path == kSeenCausticOfCaustic);
    }
};

/// Every string that a path over lobes of these kinds can have, by code.
[[nodiscard]] std::vector<PathString> possibleStrings(LobeKinds kinds);

/// Radiance of one sample by path string; only kept when somebody asks for it.
using StringSums = std::vector<std::pair<PathString, Rgb>>;

/// Radiance by path class; their sum is the pixel.
struct LayeredRadiance {
    std::array<Rgb, kPathClasses> layer{Rgb(0.0F), Rgb(0.0F), Rgb(0.0F), Rgb(0.0F)};
    float shared = 0.0F;            ///< luminance of what photons gave, which other samples of the iteration see too
    float blur = 0.0F;              ///< luminance: estimated bias of the kernels in it
    float recordNoise = 0.0F;       ///< luminance: what the records' noise adds to it, a draw of theirs
    StringSums* strings = nullptr;  ///< not owned; receives the same radiance by string

    void add(PathString path, const Rgb& radiance) {
        (*this)[path.layer()] += radiance;
        if (strings != nullptr) strings->emplace_back(path, radiance);
    }

    /// For means over samples.
    void addShare(const LayeredRadiance& other, float weight) {
        for (std::size_t l = 0; l < layer.size(); ++l) layer[l] += other.layer[l] * weight;
        shared += other.shared * weight;
        blur += other.blur * weight;
        recordNoise += other.recordNoise * weight;
        if (strings != nullptr && other.strings != nullptr)
            for (const auto& [path, radiance] : *other.strings) strings->emplace_back(path, radiance * weight);
    }

    [[nodiscard]] Rgb& operator[](PathClass c) noexcept { return layer[static_cast<std::size_t>(c)]; }
    [[nodiscard]] const Rgb& operator[](PathClass c) const noexcept { return layer[static_cast<std::size_t>(c)]; }
    [[nodiscard]] Rgb total() const noexcept { return layer[0] + layer[1] + layer[2] + layer[3]; }
};

/// Reads a path's vertices from the eye on.
class EyeLedger {
public:
    /// The path goes over a vertex by a lobe of this kind.
    void pass(LobeKinds kind) noexcept { path_.pass(kind); }

    [[nodiscard]] PathString path() const noexcept { return path_; }
    [[nodiscard]] PathString pathAfter(LobeKinds kind) const noexcept {
        PathString next = path_;
        next.pass(kind);
        return next;
    }
    /// The class if the path ends at a light now.
    [[nodiscard]] PathClass atLight() const noexcept { return path_.layer(); }
    /// The class if it goes over one more vertex and then ends at a light.
    [[nodiscard]] PathClass atLightAfter(LobeKinds kind) const noexcept { return pathAfter(kind).layer(); }

private:
    PathString path_;
};

}  // namespace pellucid
