// The curves of convergence as a table, as JSON, and drawn as SVG.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <pellucid/study/convergence.h>
#include <pellucid/study/text_table.h>

#include "log_axis.h"

namespace pellucid {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kColours{"#0b78c2", "#0b78c2", "#d1591a", "#d1591a", "#777"};
constexpr std::array kDashes{"none", "6 3", "none", "6 3", "2 3"};
constexpr double kLeft = 58.0, kTop = 20.0, kWidth = 380.0, kHeight = 300.0, kLegend = 220.0;

[[nodiscard]] std::string slopeText(const Interval& slope) {
    return std::isnan(slope.low) ? fmt::format("{:.2f}", slope.value)
                                 : fmt::format("{:.2f} ({:.2f} to {:.2f})", slope.value, slope.low, slope.high);
}

void drawGrid(std::string& svg, const LogAxis& x, const LogAxis& y) {
    for (double e = x.low; e <= x.high; ++e) {
        const double at = x.at(std::pow(10.0, e));
        svg += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>", at,
                           y.to, y.from);
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:g}</text>\n", at, y.from + 16,
                           std::pow(10.0, e));
    }
    for (double e = y.low; e <= y.high; ++e) {
        const double at = y.at(std::pow(10.0, e));
        svg += fmt::format("<line class=\"grid\" x1=\"{1:.1f}\" x2=\"{2:.1f}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>", at,
                           x.from, x.to);
        svg +=
            fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">1e{:g}</text>\n", x.from - 6, at + 4, e);
    }
}

}  // namespace

std::string convergenceTable(const std::vector<ConvergenceCurve>& curves) {
    if (curves.empty()) return "";
    std::vector<std::string> head{"photon paths a pixel"};
    for (const double n : curves.front().photons) head.push_back(fmt::format("{:g}", n));
    head.emplace_back("slope (95 %)");
    TextTable table(head);
    for (const ConvergenceCurve& c : curves) {
        std::vector<std::string> row{c.label};
        for (const double e : c.relmse) row.push_back(fmt::format("{:.2e}", e));
        row.push_back(slopeText(c.slope));
        table.add(row);
    }
    return table.text();
}

std::string convergenceJson(const std::vector<ConvergenceCurve>& curves) {
    Json list = Json::array();
    for (const ConvergenceCurve& c : curves)
        list.push_back({{"method", c.label},
                        {"photons_per_pixel", c.photons},
                        {"relmse", c.relmse},
                        {"slope", {{"value", c.slope.value}, {"low", c.slope.low}, {"high", c.slope.high}}}});
    return list.dump(2) + "\n";
}

std::string convergenceSvg(const std::vector<ConvergenceCurve>& curves) {
    double least = 1e300, most = 0.0;
    for (const ConvergenceCurve& c : curves)
        for (const double e : c.relmse) least = std::min(least, e), most = std::max(most, e);
    const std::vector<double>& photons = curves.front().photons;
    const LogAxis x = axisOver(photons.front(), photons.back(), kLeft, kLeft + kWidth),
                  y = axisOver(least, most, kTop + kHeight, kTop);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"relMSE over "
        "photon paths a pixel; the table beside it holds the values\">\n<style>text{{font:11px "
        "system-ui,sans-serif;fill:#333}}.grid{{stroke:#ddd;stroke-width:1}}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        kLeft + kWidth + kLegend, kTop + kHeight + 44.0);
    drawGrid(svg, x, y);
    // What -2/3 looks like, from the first point of the first curve.
    const double first = curves.front().relmse.front() * 1.6, ratio = photons.back() / photons.front();
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#999\"/><text x=\"{:.1f}\" "
        "y=\"{:.1f}\">slope -2/3</text>\n",
        x.at(photons.front()), y.at(first), x.at(photons.back()), y.at(first * std::pow(ratio, -2.0 / 3.0)),
        x.at(photons.front()) + 40.0, y.at(first) + 12.0);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const ConvergenceCurve& c = curves[i];
        std::string points;
        for (std::size_t k = 0; k < c.photons.size(); ++k)
            points += fmt::format("{:.1f},{:.1f} ", x.at(c.photons[k]), y.at(c.relmse[k]));
        const char* colour = kColours[i % kColours.size()];
        const char* dash = kDashes[i % kDashes.size()];
        const double line = kTop + 10.0 + 34.0 * static_cast<double>(i), left = x.to + 16.0;
        svg += fmt::format(
            "<polyline points=\"{0}\" fill=\"none\" stroke=\"{1}\" stroke-width=\"2\" stroke-dasharray=\"{2}\"/>\n"
            "<line x1=\"{3:.1f}\" x2=\"{4:.1f}\" y1=\"{5:.1f}\" y2=\"{5:.1f}\" stroke=\"{1}\" stroke-width=\"2\" "
            "stroke-dasharray=\"{2}\"/><text x=\"{6:.1f}\" y=\"{7:.1f}\">{8}</text><text x=\"{6:.1f}\" "
            "y=\"{9:.1f}\">slope {10}</text>\n",
            points, colour, dash, left, left + 28.0, line, left + 34.0, line + 4.0, c.label, line + 18.0,
            slopeText(c.slope));
    }
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">photon paths a pixel</text>\n",
                       kLeft + 0.5 * kWidth, kTop + kHeight + 36.0);
    svg += fmt::format(
        "<text transform=\"translate(14,{:.1f}) rotate(-90)\" text-anchor=\"middle\">relMSE of the caustic</text>\n",
        kTop + 0.5 * kHeight);
    return svg + "</svg>\n";
}

}  // namespace pellucid
