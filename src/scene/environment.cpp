/// The sampling density of a map is constant per solid angle within a texel and proportional there to the texel's
/// mean of the interpolated radiance, a little blurred: a filter of 3/16, 10/16, 3/16 in both directions over the
/// average channel. The exact mean of bilinear interpolation would be 1/8, 3/4, 1/8; the wider one nearly minimises
/// the variance around a single burning texel (proportional to the root mean square), and like it reaches wherever
/// interpolation does. Being uniform in solid angle, the density has no sin(theta) to divide by at the poles.
#include <pellucid/scene/environment.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <pellucid/math/constants.h>
#include <pellucid/math/distribution.h>
#include <pellucid/math/warps.h>

namespace pellucid {

namespace {

constexpr double kMaxCells = 8.5e6;  ///< 4096 x 2048 and a little: 68 MB of table
constexpr std::array<double, 3> kFilter{3.0 / 16.0, 10.0 / 16.0, 3.0 / 16.0};

/// Continuous texel coordinates of a direction: x in [0, width), y in [0, height]. atan2 keeps its precision at the
/// poles.
struct MapPoint {
    double x, y;
};
MapPoint toMap(const glm::vec3& d, int width, int height) noexcept {
    const double u = 0.5 + static_cast<double>(std::atan2(d.z, d.x)) / (2.0 * kPiD);
    const double v = static_cast<double>(std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y)) / kPiD;
    return {std::clamp(u, 0.0, 1.0) * width, std::clamp(v, 0.0, 1.0) * height};
}

glm::vec3 toDirection(double cosTheta, double phi) noexcept {
    const double sinTheta = std::sqrt(std::max(0.0, (1.0 - cosTheta) * (1.0 + cosTheta)));
    return glm::normalize(glm::vec3(sinTheta * std::cos(phi), cosTheta, sinTheta * std::sin(phi)));
}

int wrap(int x, int width) noexcept { return x < 0 ? x + width : (x >= width ? x - width : x); }

double brightness(const Image& map, int x, int y) noexcept {
    const Rgb c =
        map.rgb(static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width()) + static_cast<std::size_t>(x));
    return (static_cast<double>(c.r) + static_cast<double>(c.g) + static_cast<double>(c.b)) / 3.0;
}

}  // namespace

Environment::Environment(EnvironmentDescription description)
    : constant_(description.constant), mean_(description.constant), map_(std::move(description.map)) {
    if (isConstant()) return;
    rowCosine_.resize(static_cast<std::size_t>(map_.height()) + 1);
    for (std::size_t j = 0; j < rowCosine_.size(); ++j)
        rowCosine_[j] = std::cos(kPiD * static_cast<double>(j) / map_.height());
    computeMean();
    buildTables();
}

/// A row's share of the sphere under interpolation is the integral of its hat function times sin(theta), in closed
/// form; beyond the centres of the first and last rows the hat stays at 1.
void Environment::computeMean() {
    const int height = map_.height(), width = map_.width();
    const double h = kPiD / height;
    std::array<double, 3> sum{};
    for (int j = 0; j < height; ++j) {
        const double theta = (j + 0.5) * h, s = std::sin(theta), c = std::cos(theta);
        const double above = j == 0 ? 1.0 - c : (s - std::sin(theta - h)) / h - c;
        const double below = j == height - 1 ? 1.0 + c : c - (std::sin(theta + h) - s) / h;
        std::array<double, 3> row{};
        for (int i = 0; i < width; ++i) {
            const Rgb texel =
                map_.rgb(static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i));
            for (int k = 0; k < 3; ++k) row[static_cast<std::size_t>(k)] += static_cast<double>(texel[k]);
        }
        for (std::size_t k = 0; k < 3; ++k) sum[k] += 0.5 * (above + below) * row[k] / width;
    }
    mean_ = Rgb(static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2]));
}

double Environment::texelWeight(int x, int y) const noexcept {
    const int width = map_.width();
    const int left = wrap(x - 1, width), right = wrap(x + 1, width);
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        const int row = std::clamp(y + k - 1, 0, map_.height() - 1);
        sum += kFilter[static_cast<std::size_t>(k)] *
               (kFilter[0] * brightness(map_, left, row) + kFilter[1] * brightness(map_, x, row) +
                kFilter[2] * brightness(map_, right, row));
    }
    return sum;
}

/// Solid angle of one texel of row `y`.
double Environment::rowSolidAngle(int y) const noexcept {
    const auto j = static_cast<std::size_t>(y);
    return 2.0 * kPiD / map_.width() * (rowCosine_[j] - rowCosine_[j + 1]);
}

void Environment::buildTables() {
    while (static_cast<double>(map_.pixels()) / (static_cast<double>(cell_) * cell_) > kMaxCells) ++cell_;
    cellRows_ = (map_.height() + cell_ - 1) / cell_;
    cellColumns_ = (map_.width() + cell_ - 1) / cell_;
    const auto stride = static_cast<std::size_t>(cellColumns_) + 1;
    rowCdf_.assign(static_cast<std::size_t>(cellRows_) + 1, 0.0);
    columnCdf_.assign(static_cast<std::size_t>(cellRows_) * stride, 0.0);
    for (int row = 0; row < cellRows_; ++row) {
        double* const columns = &columnCdf_[static_cast<std::size_t>(row) * stride];
        for (int y = row * cell_; y < std::min((row + 1) * cell_, map_.height()); ++y) {
            const double solidAngle = rowSolidAngle(y);
            for (int x = 0; x < map_.width(); ++x) columns[x / cell_ + 1] += texelWeight(x, y) * solidAngle;
        }
        for (int i = 0; i < cellColumns_; ++i) columns[i + 1] += columns[i];
        const auto r = static_cast<std::size_t>(row);
        rowCdf_[r + 1] = rowCdf_[r] + columns[cellColumns_];
    }
    total_ = rowCdf_.back();
}

Rgb Environment::radiance(const glm::vec3& direction) const noexcept {
    if (isConstant()) return constant_;
    const int width = map_.width(), height = map_.height();
    const MapPoint p = toMap(direction, width, height);
    const double x = p.x - 0.5, y = p.y - 0.5;
    const double floorX = std::floor(x), floorY = std::floor(y);
    const auto fx = static_cast<float>(x - floorX), fy = static_cast<float>(y - floorY);
    const auto i = static_cast<int>(floorX), j = static_cast<int>(floorY);
    const auto texel = [&](int column, int row) {
        const auto c = static_cast<std::size_t>(wrap(column, width));
        const auto r = static_cast<std::size_t>(std::clamp(row, 0, height - 1));
        return map_.rgb(r * static_cast<std::size_t>(width) + c);
    };
    return (1.0F - fy) * ((1.0F - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1.0F - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

std::optional<DirectionSample> Environment::sample(const glm::vec2& u) const noexcept {
    if (black()) return std::nullopt;
    if (isConstant()) return DirectionSample{sampleUniformSphere(u), pdfSolidAngleUniformSphere()};

    const IntervalSample row = sampleInterval(rowCdf_, static_cast<double>(u.y));
    const auto stride = static_cast<std::size_t>(cellColumns_) + 1;
    const IntervalSample column =
        sampleInterval(std::span(columnCdf_).subspan(row.index * stride, stride), static_cast<double>(u.x));

    // Within the cell: its texels one after the other. (One only, unless the map is huge.)
    const int x0 = static_cast<int>(column.index) * cell_, y0 = static_cast<int>(row.index) * cell_;
    const int x1 = std::min(x0 + cell_, map_.width()), y1 = std::min(y0 + cell_, map_.height());
    const std::size_t cellAt = row.index * stride + column.index;
    double left = column.remapped * (columnCdf_[cellAt + 1] - columnCdf_[cellAt]);
    int x = x0, y = y0;
    double weight = 0.0, within = column.remapped;
    for (int k = 0; cell_ > 1 && k < (x1 - x0) * (y1 - y0); ++k) {
        const int tx = x0 + k % (x1 - x0), ty = y0 + k / (x1 - x0);
        const double texel = texelWeight(tx, ty), share = texel * rowSolidAngle(ty);
        if (share > 0.0) {  // the last texel with weight stands for what rounding leaves over
            x = tx, y = ty, weight = texel;
            within = std::min(left / share, kLargestBelowOne);
            if (left < share) break;
        }
        left -= share;
    }
    if (cell_ == 1) weight = texelWeight(x, y);

    const auto j = static_cast<std::size_t>(y);
    const double cosTheta = rowCosine_[j] + row.remapped * (rowCosine_[j + 1] - rowCosine_[j]);
    const double phi = ((x + within) / map_.width() - 0.5) * 2.0 * kPiD;
    return DirectionSample{toDirection(cosTheta, phi), static_cast<float>(weight / total_)};
}

float Environment::pdf(const glm::vec3& direction) const noexcept {
    if (black()) return 0.0F;
    if (isConstant()) return pdfSolidAngleUniformSphere();
    const MapPoint p = toMap(direction, map_.width(), map_.height());
    const int x = std::min(static_cast<int>(p.x), map_.width() - 1);
    const int y = std::min(static_cast<int>(p.y), map_.height() - 1);
    return static_cast<float>(texelWeight(x, y) / total_);
}

bool Environment::black() const noexcept { return isConstant() ? isBlack(constant_) : !(total_ > 0.0); }

}  // namespace pellucid
