/// The finished runs of a comparison on disk: DIR/runs/NAME.exr and beside it NAME.json, which is written last and holds
/// what the run was (its key) and what it did. A run whose key is found there is done.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <pellucid/math/image.h>
#include <pellucid/render/render.h>
#include <pellucid/study/metrics.h>

namespace pellucid {

/// Path classes that are measured apart, as layers of the images.
inline constexpr std::array<std::string_view, 3> kMeasuredClasses{"direct", "caustic", "indirect"};

/// Everything that decides a run's image and its time.
struct RunKey {
    std::string label, text;  ///< `text` holds scene hash, settings hash, size, camera, threads, budget and seed
    double budget = 0.0;
    std::uint64_t seed = 0;
    [[nodiscard]] std::string name() const;    ///< of its files, without extension: readable and unique
    [[nodiscard]] std::string series() const;  ///< the same for all of its seeds
};

/// Figures of a run against one reference.
struct RunMetrics {
    std::string referenceHash;
    Metrics whole;
    std::map<std::string, double> classRelmse;  ///< by class; the denominator is that of the whole image
};

struct StoredRun {
    RunKey key;
    std::filesystem::path image;  ///< relative to the comparison's folder
    std::string imageHash;
    double seconds = 0.0, errorEstimate = 0.0;
    std::uint32_t iterations = 0, samplesPerPixel = 0;
    std::uint64_t peakRssBytes = 0, nonfinite = 0;
    int threads = 0;
    std::vector<StageRecord> stages;
    std::vector<Decision> decisions;
    std::vector<std::string> blindSpots;
    std::vector<std::pair<std::string, std::string>> resolved;  ///< settings
    std::optional<RunMetrics> metrics;
};

[[nodiscard]] std::string hashText(std::string_view text);
[[nodiscard]] std::string imageHash(const Image& image);

class RunStore {
public:
    /// Makes the folder. Throws Error{CannotFinish}.
    explicit RunStore(std::filesystem::path folder);

    [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
    /// Empty when the run is not there, belongs to another key or cannot be read.
    [[nodiscard]] std::optional<StoredRun> find(const RunKey& key) const;
    /// The image, then the record: whole or absent.
    void save(StoredRun& run, const Image& image, const std::map<std::string, std::string>& metadata) const;
    /// The record alone, after it has been measured.
    void saveRecord(const StoredRun& run) const;
    [[nodiscard]] Image readImage(const StoredRun& run) const;

private:
    std::filesystem::path folder_;
};

}  // namespace pellucid
