#include "check_formulas.h"

#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>

namespace pellucid::check {

double meanOverSquare(const std::function<double(double, double)>& f, int steps) {
    double sum = 0.0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) sum += f((i + 0.5) / steps, (j + 0.5) / steps);
    return sum / (steps * steps);
}

double integral(double a, double b, const std::function<double(double)>& f, int steps) {
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += f(a + (b - a) * (i + 0.5) / steps);
    return sum * (b - a) / steps;
}

double root(double a, double b, const std::function<double(double)>& f) {
    const bool rising = f(a) < 0.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (a + b);
        ((f(middle) < 0.0) == rising ? a : b) = middle;
    }
    return 0.5 * (a + b);
}

double fresnel(double cosine, double n) {
    const double cos2 = 1.0 - (1.0 - cosine * cosine) / (n * n);
    if (cos2 <= 0.0) return 1.0;
    const double t = std::sqrt(cos2);
    const double s = (cosine - n * t) / (cosine + n * t), p = (n * cosine - t) / (n * cosine + t);
    return 0.5 * (s * s + p * p);
}

double schlick(double cosine, double f0) { return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0); }

double slabTransmittance(double cosine, double n, double opticalDepth) {
    const double r = fresnel(cosine, n), inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (n * n));
    const double e = std::exp(-opticalDepth / inside);
    return (1.0 - r) * (1.0 - r) * e / (1.0 - r * r * e * e);
}

double polygonIrradiance(const glm::dvec3& point, const glm::dvec3& normal, std::span<const glm::dvec3> polygon) {
    double sum = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a = glm::normalize(polygon[i] - point),
                         b = glm::normalize(polygon[(i + 1) % polygon.size()] - point);
        const glm::dvec3 cross = glm::cross(a, b);
        const double sine = glm::length(cross);
        if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, cross / sine);
    }
    return 0.5 * std::fabs(sum);
}

double discIrradiance(double height, double offset, double radius) {
    const double h2 = height * height, a2 = offset * offset, r2 = radius * radius, s = h2 + a2 + r2;
    return 0.5 * kPiD * (1.0 - (h2 + a2 - r2) / std::sqrt(s * s - 4.0 * a2 * r2));
}

double pointIrradiance(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& light, double intensity) {
    const glm::dvec3 to = light - point;
    const double d2 = glm::dot(to, to);
    return intensity * std::max(0.0, glm::dot(normal, to)) / (d2 * std::sqrt(d2));
}

}  // namespace pellucid::check
