/// Iterations of unequal weight: the film's mean, the variance that it states, and its two halves.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <pellucid/render/film.h>

namespace pellucid {
namespace {

[[nodiscard]] LayeredRadiance grey(float value) {
    LayeredRadiance radiance;
    radiance.layer[0] = Rgb(value);
    return radiance;
}

/// Of iteration i every pixel's value is 1 +- 1 / sqrt(k): as of k samples.
struct Iteration {
    double weight;
    float samples;
};
const std::vector<Iteration> kIterations{{1.0, 1.0F}, {1.0, 1.0F}, {1.0, 1.0F},   {1.0, 1.0F},   {6.0, 4.0F},
                                         {6.0, 4.0F}, {6.0, 4.0F}, {16.0, 16.0F}, {16.0, 16.0F}, {16.0, 16.0F}};

TEST(FilmWeights, MeanVarianceAndNoiseAreThoseOfAWeightedMean) {
    constexpr int kSide = 64;
    Film film(kSide, kSide);
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coin(0, 1);
    std::uint32_t n = 0;
    for (const Iteration& iteration : kIterations) {
        film.setWeight(iteration.weight);
        for (std::size_t p = 0; p < film.pixels(); ++p)
            film.add(p, n, grey(1.0F + static_cast<float>(2 * coin(random) - 1) / std::sqrt(iteration.samples)), {});
        film.countSamples(1);
        ++n;
    }
    double sum = 0.0, variance = 0.0;
    for (const Iteration& i : kIterations) {
        sum += i.weight;
        variance += i.weight * i.weight / static_cast<double>(i.samples);
    }
    variance /= sum * sum;
    const Image image = film.image({"variance"});
    const int y = image.channel("variance.Y");
    double mean = 0.0, square = 0.0, stated = 0.0;
    for (std::size_t p = 0; p < image.pixels(); ++p) {
        const double value = static_cast<double>(image.rgb(p).g);
        mean += value;
        square += (value - 1.0) * (value - 1.0);
        stated += static_cast<double>(image.at(p, y));
    }
    const double pixels = kSide * kSide;
    EXPECT_NEAR(mean / pixels, 1.0, 5.0 * std::sqrt(variance / pixels));
    EXPECT_NEAR(square / pixels, variance, 0.1 * variance);
    EXPECT_NEAR(stated / pixels, variance, 0.25 * variance);  // few terms, and those that count are of unequal variance
    EXPECT_NEAR(film.relativeNoise2(), variance, 0.15 * variance);
    // The plain mean of the same terms would be worse than half of this.
    double plain = 0.0;
    for (const Iteration& i : kIterations) plain += 1.0 / static_cast<double>(i.samples);
    EXPECT_GT(plain / static_cast<double>(kIterations.size() * kIterations.size()), 1.4 * variance);
}

TEST(FilmWeights, AreSavedWithTheFilm) {
    Film film(2, 1);
    film.add(0, 0, grey(1.0F), {});
    film.countSamples(1);
    film.setWeight(3.0);
    Film other(2, 1);
    ASSERT_TRUE(other.restore(film.save()));
    for (Film* f : {&film, &other}) {
        f->add(0, 1, grey(5.0F), {});
        f->countSamples(1);
    }
    EXPECT_FLOAT_EQ(other.image({}).rgb(0).g, 4.0F);
    EXPECT_EQ(film.image({}).rgb(0).g, other.image({}).rgb(0).g);
}

}  // namespace
}  // namespace pellucid
