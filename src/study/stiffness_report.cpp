// The sweeps as a table, as JSON, as a section of docs/validation.md, and drawn as SVG.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <pellucid/study/stiffness.h>
#include <pellucid/study/text_table.h>

#include "log_axis.h"

namespace pellucid {

namespace {

using Json = nlohmann::ordered_json;

[[nodiscard]] std::string percent(double value) { return fmt::format("{:.3g} %", 100.0 * value); }
[[nodiscard]] std::string biasText(const SweepFigures& f) {
    return fmt::format("{:+.2g} ± {:.1g} %", 100.0 * f.bias, 100.0 * f.interval);
}

[[nodiscard]] std::string powerOfTen(double exponent, bool asPercent) {
    const double value = std::pow(10.0, exponent + (asPercent ? 2.0 : 0.0));
    const std::string text =
        std::fabs(exponent + (asPercent ? 2.0 : 0.0)) < 4.5 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
    return asPercent ? text + "%" : text;
}

constexpr double kPanelWidth = 330.0, kPanelHeight = 300.0, kMargin = 54.0;
constexpr std::array kColours{"#0b78c2", "#d1591a"};
constexpr std::array kDashes{"none", "6 3"};

struct Chart {
    double left, top, width, height;
    bool asPercent;
    double (*value)(const SweepFigures&);
};

void drawChart(std::string& svg, const Sweep& sweep, const Chart& chart, bool valuesBelow) {
    double least = 1e300, most = 0.0, low = 1e300, high = 0.0;
    for (const SweepStep& s : sweep.steps) {
        least = std::min(least, s.value), most = std::max(most, s.value);
        for (const SweepFigures& f : s.by)
            low = std::min(low, std::max(chart.value(f), 1e-6)), high = std::max(high, chart.value(f));
    }
    const LogAxis x = axisOver(least, most, chart.left, chart.left + chart.width);
    const LogAxis y = axisOver(low, std::max(high, low), chart.top + chart.height, chart.top);
    const double xStep = std::max(1.0, std::ceil((x.high - x.low) / 6.0)),
                 yStep = std::max(1.0, std::ceil((y.high - y.low) / 4.0));
    for (double e = y.low; e <= y.high + 0.5; e += yStep) {
        const double at = y.at(std::pow(10.0, e));
        svg += fmt::format("<line class=\"grid\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", chart.left,
                           chart.left + chart.width, at, at);
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", chart.left - 5, at + 3.5,
                           powerOfTen(e, chart.asPercent));
    }
    for (double e = x.low; e <= x.high + 0.5; e += xStep) {
        const double at = x.at(std::pow(10.0, e));
        svg += fmt::format("<line class=\"grid\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", at, at,
                           chart.top, chart.top + chart.height);
        if (valuesBelow)
            svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", at,
                               chart.top + chart.height + 13, powerOfTen(e, false));
    }
    std::vector<const SweepStep*> steps;
    for (const SweepStep& s : sweep.steps) steps.push_back(&s);
    std::ranges::sort(steps, {}, &SweepStep::value);
    for (std::size_t m = 0; m < kSweepMethods.size(); ++m) {
        std::string points, marks;
        for (const SweepStep* s : steps) {
            const double px = x.at(s->value), py = y.at(std::max(chart.value(s->by[m]), 1e-6));
            points += fmt::format("{:.1f},{:.1f} ", px, py);
            marks += m == 0
                         ? fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>", px, py, kColours[m])
                         : fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"6\" height=\"6\" fill=\"{}\"/>", px - 3,
                                       py - 3, kColours[m]);
        }
        svg += fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>{}\n",
            points, kColours[m], kDashes[m], marks);
    }
}

}  // namespace

std::string sweepVerdict(const Sweep& sweep, std::size_t method) {
    std::vector<std::string> troubles;
    const auto at = [&](std::size_t i) -> const SweepFigures& { return sweep.steps[i].by[method]; };
    if (!sweep.steps.empty() && at(0).error > kBrokenFactor * kSmallError)
        troubles.push_back(
            fmt::format("is short of samples from the first step on, with an error of {}", percent(at(0).error)));
    if (const auto i = breakdown(sweep, method))
        troubles.push_back(fmt::format("breaks down at {:g}: error {}, of it bias {}", sweep.steps[*i].value,
                                       percent(at(*i).error), biasText(at(*i))));
    if (const auto i = blindness(sweep, method))
        troubles.push_back(fmt::format("finds no light at all from {:g} on", sweep.steps[*i].value));
    if (const auto i = certainBias(sweep, method))
        troubles.push_back(fmt::format("is biased at {:g}, by {}", sweep.steps[*i].value, biasText(at(*i))));
    std::string text(kSweepMethods[method]);
    if (troubles.empty()) return text + " holds over the whole sweep.";
    for (std::size_t i = 0; i < troubles.size(); ++i) text += (i == 0 ? " " : "; it ") + troubles[i];
    return text + ".";
}

std::string sweepsTable(const std::vector<Sweep>& sweeps) {
    std::string text;
    for (const Sweep& sweep : sweeps) {
        TextTable table({sweep.dial, "path: error", "bias", "s", "photon: error", "bias", "s"});
        for (const SweepStep& s : sweep.steps) {
            std::vector<std::string> row{fmt::format("{:g}", s.value)};
            for (const SweepFigures& f : s.by)
                row.insert(row.end(), {percent(f.error), biasText(f), figure(f.seconds)});
            table.add(std::move(row));
        }
        text += sweep.name + "\n\n" + table.text() + sweepVerdict(sweep, 0) + "\n" + sweepVerdict(sweep, 1) + "\n\n";
    }
    return text;
}

std::string sweepsJson(const std::vector<Sweep>& sweeps) {
    Json list = Json::array();
    for (const Sweep& sweep : sweeps) {
        Json entry{{"name", sweep.name},           {"dial", sweep.dial},     {"scene", sweep.scene},
                   {"reference", sweep.reference}, {"source", sweep.source}, {"steps", Json::array()}};
        for (const SweepStep& s : sweep.steps) {
            Json step{{"value", s.value}};
            for (std::size_t m = 0; m < kSweepMethods.size(); ++m) {
                const SweepFigures& f = s.by[m];
                step[std::string(kSweepMethods[m])] = {{"error", f.error},
                                                       {"bias", f.bias},
                                                       {"bias_interval", f.interval},
                                                       {"seconds", f.seconds},
                                                       {"rays", f.rays}};
            }
            entry["steps"].push_back(std::move(step));
        }
        for (std::size_t m = 0; m < kSweepMethods.size(); ++m) {
            const std::string name(kSweepMethods[m]);
            for (const auto& [key, step] :
                 {std::pair("breaks_down_at", breakdown(sweep, m)), std::pair("blind_from", blindness(sweep, m)),
                  std::pair("biased_at", certainBias(sweep, m))})
                entry[key][name] = step ? Json(sweep.steps[*step].value) : Json(nullptr);
        }
        list.push_back(std::move(entry));
    }
    return list.dump(2) + "\n";
}

std::string sweepsMarkdown(const std::vector<Sweep>& sweeps, std::string_view picture) {
    std::string page =
        "\n## Stiffness\n\nEach dial is turned over decades in a scene whose picture is known. Error is the root of "
        "the mean over pixels "
        "and 4 seeds of the\nsquared relative error at a fixed number of samples; bias is that of the mean, with its "
        "95 % interval; seconds "
        "are those of one render\non the machine that made this page. A method is said to break down at the first step "
        "where its error is three\ntimes "
        "that of the first step, or above 30 % where that one was below 10 %; to be biased where the bias is twice "
        "its\n"
        "interval and above 2 %; and to find no light where every picture of all seeds is black.\n";
    if (!picture.empty()) page += fmt::format("\n![Error and seconds over each dial, path and photon]({})\n", picture);
    for (const Sweep& sweep : sweeps) {
        page += fmt::format("\n### {}\n\n{} Expected: {}. Source: {}.\n\n", sweep.name, sweep.scene, sweep.reference,
                            sweep.source);
        page += fmt::format(
            "| {} | path: error | bias | s | photon: error | bias | s |\n|---:|---:|---:|---:|---:|---:|---:|\n",
            sweep.dial);
        for (const SweepStep& s : sweep.steps) {
            page += fmt::format("| {:g} |", s.value);
            for (const SweepFigures& f : s.by)
                page += fmt::format(" {} | {} | {:.2g} |", percent(f.error), biasText(f), f.seconds);
            page += "\n";
        }
        page += fmt::format("\nHere {} And {}\n", sweepVerdict(sweep, 0), sweepVerdict(sweep, 1));
    }
    return page;
}

std::string sweepsSvg(const std::vector<Sweep>& sweeps) {
    const std::size_t columns = 3, rows = (sweeps.size() + columns - 1) / columns;
    const double width = kPanelWidth * columns, height = kPanelHeight * static_cast<double>(rows) + 30.0;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"Error and "
        "seconds over "
        "each dial for path tracing and photons; the tables below hold the values\">\n",
        width, height);
    svg +=
        "<style>text{font:10.5px "
        "system-ui,sans-serif;fill:#333}.name{font-size:13px;font-weight:600}.grid{stroke:#ddd;stroke-width:1}</"
        "style>\n";
    svg += fmt::format("<rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#fff\"/>\n", width, height);
    for (std::size_t m = 0; m < kSweepMethods.size(); ++m)
        svg += fmt::format(
            "<line x1=\"{0}\" x2=\"{1}\" y1=\"14\" y2=\"14\" stroke=\"{2}\" stroke-width=\"2\" "
            "stroke-dasharray=\"{3}\"/><text x=\"{4}\" y=\"18\">{5}</text>\n",
            kMargin + 110.0 * static_cast<double>(m), kMargin + 30.0 + 110.0 * static_cast<double>(m), kColours[m],
            kDashes[m], kMargin + 36.0 + 110.0 * static_cast<double>(m), kSweepMethods[m]);
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
        const double left = kPanelWidth * static_cast<double>(i % columns) + kMargin,
                     top = kPanelHeight * static_cast<double>(i / columns) + 56.0;
        const double chartWidth = kPanelWidth - kMargin - 14.0;
        svg += fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left, top - 8, sweeps[i].name);
        drawChart(svg, sweeps[i], {left, top, chartWidth, 120.0, true, [](const SweepFigures& f) { return f.error; }},
                  false);
        drawChart(svg, sweeps[i],
                  {left, top + 138.0, chartWidth, 60.0, false, [](const SweepFigures& f) { return f.seconds; }}, true);
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", left + 0.5 * chartWidth,
                           top + 226.0, sweeps[i].dial);
        svg +=
            fmt::format("<text transform=\"translate({:.1f},{:.1f}) rotate(-90)\" text-anchor=\"middle\">error</text>",
                        left - 42, top + 60);
        svg += fmt::format(
            "<text transform=\"translate({:.1f},{:.1f}) rotate(-90)\" text-anchor=\"middle\">seconds</text>\n",
            left - 42, top + 168);
    }
    return svg + "</svg>\n";
}

}  // namespace pellucid
