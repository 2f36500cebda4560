/// Energy by path class, in groups that every method can tell: with p the string before the first D, E p L, E p D L,
/// E p D S+ L and all the rest behind E p D, of which the photon method's cache does not know more.
#pragma once

#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "agreement.h"

namespace pellucid::testing {

/// "EDSDL" -> "ED..L".
inline std::string groupOf(const std::string& name) {
    const bool open = name.find('_') != std::string::npos;
    const std::string letters = name.substr(1, name.size() - 2 - (open ? 1U : 0U));
    const std::size_t d = letters.find('D');
    if (d == std::string::npos) return name;
    const std::string prefix = "E" + letters.substr(0, d + 1), rest = letters.substr(d + 1);
    if (rest.empty() && !open) return prefix + "L";
    if (rest == "S" && !open) return prefix + "SL";
    // A third letter leaves no room to tell E p D S+ L from what goes on.
    return prefix + "..L";
}

/// Whole-image means by group, one value a seed.
inline std::map<std::string, std::vector<double>> energyByGroup(const std::vector<Image>& images) {
    std::map<std::string, std::vector<double>> energy;
    for (std::size_t s = 0; s < images.size(); ++s)
        for (const std::string& channel : images[s].channelNames()) {
            if (!channel.starts_with("class.") || !channel.ends_with(".R")) continue;
            const std::string layer = channel.substr(0, channel.size() - 2);
            const std::vector<double> cells = blockMeans(images[s], images[s].width(), layer);
            auto& values = energy[groupOf(layer.substr(6))];
            values.resize(images.size(), 0.0);
            for (const double v : cells) values[s] += v / static_cast<double>(cells.size());
        }
    return energy;
}

struct GroupDifference {
    std::string group;
    double expected = 0.0, measured = 0.0, error = 0.0, allowance = 0.0;
    [[nodiscard]] bool holds() const { return std::fabs(measured - expected) <= allowance + 4.5 * error; }
};

/// What bias a method may have in a group, relative to it.
using Allowance = double (*)(const std::string& group);

/// Compares class by class. `floor`: share of the image's energy below which no bias counts.
inline std::vector<GroupDifference> compareGroups(const std::vector<Image>& reference,
                                                  const std::vector<Image>& measured, Allowance allowance,
                                                  double floor) {
    const auto a = energyByGroup(reference), b = energyByGroup(measured);
    double whole = 0.0;
    for (const auto& [group, values] : a) whole += meanOfSeeds(values).mean;
    std::vector<GroupDifference> differences;
    std::map<std::string, int> groups;
    for (const auto& map : {a, b})
        for (const auto& [group, values] : map) ++groups[group];
    const std::vector<double> zeroA(reference.size(), 0.0), zeroB(measured.size(), 0.0);
    for (const auto& [group, count] : groups) {
        const MeanOfSeeds x = meanOfSeeds(a.contains(group) ? a.at(group) : zeroA),
                          y = meanOfSeeds(b.contains(group) ? b.at(group) : zeroB);
        differences.push_back(
            {group, x.mean, y.mean, std::sqrt(x.variance + y.variance), allowance(group) * x.mean + floor * whole});
    }
    return differences;
}

/// What the photon method may be off by in a group: nothing where it samples lamps, the kernel's and the cache's bias else.
inline double photonAllowance(const std::string& group) {
    if (group.ends_with("..L")) return 0.05;
    return group.ends_with("DSL") ? 0.03 : 0.0;
}

/// Every class of `measured` has the energy that it has in `reference`. `name`: of the scene.
inline void expectSameEnergy(const std::string& name, const std::vector<Image>& reference,
                             const std::vector<Image>& measured) {
    for (const GroupDifference& d : compareGroups(reference, measured, photonAllowance, 0.004)) {
        std::ostringstream text;
        text << name << ", " << d.group << ": " << d.measured << " for " << d.expected << " +- " << d.error;
        std::cout << text.str() << "\n";
        EXPECT_TRUE(d.holds()) << text.str();
    }
}

}  // namespace pellucid::testing
