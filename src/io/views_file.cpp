#include <pellucid/io/views_file.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <pellucid/base/error.h>
#include <pellucid/math/constants.h>

namespace pellucid {

namespace {

constexpr std::size_t kMostViews = 100'000;

[[noreturn]] void refuse(const std::string& what, const std::filesystem::path& file, std::size_t line) {
    throw Error(ErrorKind::BadInput, what, file.string() + ", line " + std::to_string(line),
                "write `eye X Y Z target X Y Z [up X Y Z] [fov DEGREES]`");
}

/// One line's words in order, each with its numbers.
struct LineReader {
    std::istringstream words;
    const std::filesystem::path& file;
    std::size_t line;

    [[nodiscard]] double number(const std::string& of) {
        std::string word;
        words >> word;
        double value = 0.0;
        std::istringstream text(word);
        text >> value;
        if (word.empty() || text.fail() || !text.eof() || !std::isfinite(value))
            refuse("'" + word + "' is no number of `" + of + "`", file, line);
        return value;
    }
    [[nodiscard]] glm::dvec3 vector(const std::string& of) {
        const double x = number(of), y = number(of), z = number(of);
        return {x, y, z};
    }
};

[[nodiscard]] CameraSpec viewOf(LineReader& reader, double verticalFov) {
    glm::dvec3 eye(0.0), target(0.0), up(0.0, 1.0, 0.0);
    bool hasEye = false, hasTarget = false;
    CameraSpec spec;
    spec.verticalFov = verticalFov;
    for (std::string word; reader.words >> word;) {
        if (word == "eye")
            eye = reader.vector(word), hasEye = true;
        else if (word == "target")
            target = reader.vector(word), hasTarget = true;
        else if (word == "up")
            up = reader.vector(word);
        else if (word == "fov")
            spec.verticalFov = reader.number(word) * kPiD / 180.0;
        else
            refuse("'" + word + "' is not known", reader.file, reader.line);
    }
    if (!hasEye || !hasTarget)
        refuse(hasEye ? "the target is missing" : "the eye is missing", reader.file, reader.line);
    if (!(spec.verticalFov > 0.0) || spec.verticalFov >= kPiD)
        refuse("the field of view must lie between 0 and 180 degrees", reader.file, reader.line);
    const glm::dvec3 back = eye - target, side = glm::cross(up, back);
    if (!(glm::length(back) > 0.0)) refuse("eye and target are the same point", reader.file, reader.line);
    if (!(glm::length(side) > 1e-9 * glm::length(up) * glm::length(back)))
        refuse("up points along the view", reader.file, reader.line);
    const glm::dvec3 z = glm::normalize(back), x = glm::normalize(side);
    spec.toWorld = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(eye, 1));
    return spec;
}

}  // namespace

std::vector<CameraSpec> parseViews(std::string_view text, const std::filesystem::path& file, double verticalFov) {
    std::vector<CameraSpec> views;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        line.resize(std::min(line.size(), line.find('#')));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        LineReader reader{std::istringstream(line), file, number};
        views.push_back(viewOf(reader, verticalFov));
        views.back().name = file.filename().string() + ":" + std::to_string(number);
        if (views.size() > kMostViews) refuse("these are too many views", file, number);
    }
    if (views.empty()) refuse("there is no view", file, number);
    return views;
}

std::vector<CameraSpec> loadViews(const std::filesystem::path& file, double verticalFov) {
    std::ifstream in(file, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (!in)
        throw Error(ErrorKind::BadInput, "the file of views cannot be read", file.string(),
                    "name a file that is there, or `all`");
    return parseViews(text, file, verticalFov);
}

}  // namespace pellucid
