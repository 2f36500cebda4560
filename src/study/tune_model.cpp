#include "tune_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pellucid {
namespace {

constexpr double kRidge = 0.02;               // in units of one observation of weight 1
constexpr double kLeast = -2.0, kMost = 2.5;  // outliers say no more than that they are bad

/// Solves A x = b for a symmetric positive definite A by Cholesky's decomposition; A is n x n in rows.
[[nodiscard]] std::vector<double> solved(std::vector<double> a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k)
            for (std::size_t i = j; i < n; ++i) a[i * n + j] -= a[i * n + k] * a[j * n + k];
        const double root = std::sqrt(std::max(a[j * n + j], 1e-12));
        for (std::size_t i = j; i < n; ++i) a[i * n + j] /= root;
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i * n + k] * b[k];
        b[i] /= a[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k * n + i] * b[k];
        b[i] /= a[i * n + i];
    }
    return b;
}

[[nodiscard]] std::vector<double> features(const std::vector<double>& x) {
    std::vector<double> f{1.0};
    for (const double v : x) {
        f.push_back(v - 0.5);
        f.push_back((v - 0.5) * (v - 0.5));
    }
    return f;
}

}  // namespace

AdditiveModel::AdditiveModel(const std::vector<Observation>& observations, std::size_t dimensions) {
    if (observations.size() < 2 * dimensions + 1) return;
    const std::size_t n = 2 * dimensions + 1;
    std::vector<double> a(n * n, 0.0), b(n, 0.0);
    for (std::size_t i = 1; i < n; ++i) a[i * n + i] = kRidge;
    a[0] = 1e-6;
    for (const Observation& o : observations) {
        const std::vector<double> f = features(o.coordinates);
        const double y = std::clamp(o.score, kLeast, kMost);
        for (std::size_t i = 0; i < n; ++i) {
            b[i] += o.weight * f[i] * y;
            for (std::size_t j = 0; j < n; ++j) a[i * n + j] += o.weight * f[i] * f[j];
        }
    }
    const std::vector<double> c = solved(std::move(a), std::move(b));
    for (std::size_t i = 0; i < dimensions; ++i) {
        slope_.push_back(c[1 + 2 * i]);
        curve_.push_back(c[2 + 2 * i]);
    }
}

double AdditiveModel::part(std::size_t i, double x) const noexcept {
    return slope_[i] * (x - 0.5) + curve_[i] * (x - 0.5) * (x - 0.5);
}

std::vector<double> AdditiveModel::best() const {
    std::vector<double> x;
    for (std::size_t i = 0; i < slope_.size(); ++i) {
        const double inner = curve_[i] > 0.0 ? std::clamp(0.5 - slope_[i] / (2.0 * curve_[i]), 0.0, 1.0) : 0.0;
        const double candidates[] = {0.0, inner, 1.0};
        x.push_back(*std::ranges::min_element(candidates, {}, [&](double v) { return part(i, v); }));
    }
    return x;
}

}  // namespace pellucid
