#include "methods/spot/impacts.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/base/statistics.h"

namespace textonbench::impacts_test {

TEST(Impacts, PoissonNumbersOfPixelsArePoissonAndIndependent) {
  // Thousands of small windows: threads would wait for each other.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  // χ² of the numbers of each pixel and kernel against the Poisson law, and of each pixel's sum over many seeds; false
  // alarms 1e-6 each.
  for (const double intensity : {0.05, 1.3, 3.9, 4.1, 30.0}) {
    const PlaneWindow window{-11, 70, {23, 17}};
    const int kernels = 2;
    const double mean = intensity / kernels;
    std::vector<double> histogram(80);
    std::vector<double> totals(static_cast<std::size_t>(window.size.area() * kernels));
    double product = 0;
    constexpr int repeats = 400;
    for (std::uint64_t seed = 0; seed < repeats; ++seed) {
      const ImpactSet set = draw_poisson(Stream(Seed{seed}), intensity, kernels, window);
      std::vector<double> numbers(totals.size(), intensity < dense_intensity ? 0 : mean);
      for (const ImpactStrip& strip : set.strips) {
        for (const Impact& impact : strip.impacts) {
          ASSERT_TRUE(impact.y >= strip.first_row && impact.y < strip.end_row);
          const std::int64_t pixel = std::int64_t{23} * impact.y + impact.x;
          numbers[static_cast<std::size_t>(pixel * kernels + impact.kernel)] += impact.weight;
        }
      }
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto n = static_cast<std::size_t>(std::lround(numbers[i]));
        ASSERT_NEAR(numbers[i], static_cast<double>(n), 1e-3);
        histogram[std::min<std::size_t>(n, 79)] += 1;
        totals[i] += static_cast<double>(n);
        product += i == 0 ? 0 : (numbers[i] - mean) * (numbers[i - 1] - mean);
      }
    }
    const double draws = repeats * static_cast<double>(totals.size());
    std::vector<double> counts(1);
    std::vector<double> expected(1);
    double probability = std::exp(-mean);
    for (std::size_t n = 0; n < 80; probability *= mean / static_cast<double>(++n)) {
      counts.back() += histogram[n];
      expected.back() += draws * probability;
      if (expected.back() > 20 && n < 79) {
        counts.push_back(0);
        expected.push_back(0);
      }
    }
    counts[counts.size() - 2] += counts.back();
    expected[expected.size() - 2] += expected.back();
    counts.pop_back();
    expected.pop_back();
    EXPECT_GT(chi_square_p_value(counts, expected), 1e-6) << intensity;
    double statistic = 0;
    for (const double total : totals) {
      statistic += (total - repeats * mean) * (total - repeats * mean) / (repeats * mean);
    }
    EXPECT_GT(chi_square_p_value(statistic, static_cast<double>(totals.size())), 1e-6) << intensity;
    EXPECT_GT(normal_p_value(product / std::sqrt(draws * mean * mean)), 1e-6) << intensity;
  }
}

TEST(Impacts, WindowsHoldTheSameImpacts) {
  const auto inside = [](const ImpactSet& set, const PlaneWindow& from, const PlaneWindow& to) {
    std::vector<std::array<std::int64_t, 4>> found;
    for (const ImpactStrip& strip : set.strips) {
      for (const Impact& impact : strip.impacts) {
        const std::int64_t x = from.x + impact.x;
        const std::int64_t y = from.y + impact.y;
        if (x >= to.x && x < to.x + to.size.width && y >= to.y && y < to.y + to.size.height) {
          found.push_back({x, y, impact.kernel, std::lround(1e4 * impact.weight)});
        }
      }
    }
    return found;
  };
  for (const std::int64_t origin : {std::int64_t{-20}, std::int64_t{1} << 52}) {
    const PlaneWindow large{origin, -origin, {100, 90}};
    const PlaneWindow small{origin + 31, 7 - origin, {20, 44}};
    for (const double intensity : {0.01, 1.0, 7.0}) {
      const Stream stream(Seed{9});
      const auto a = inside(draw_poisson(stream, intensity, 2, large), large, small);
      EXPECT_EQ(a, inside(draw_poisson(stream, intensity, 2, small), small, small));
      EXPECT_FALSE(a.empty());
      const CellLattice lattice = plane_lattice(intensity);
      const auto b = inside(draw_stratified(stream, lattice, 2, large), large, small);
      EXPECT_EQ(b, inside(draw_stratified(stream, lattice, 2, small), small, small));
      EXPECT_FALSE(b.empty());
    }
  }
}

TEST(Impacts, StratifiedPixelsExpectTheIntensityWhereverTheCellsLie) {
  // Thousands of small windows: threads would wait for each other.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  // Each pixel's number has the mean λ and, being a sum of few indicator variables, at most that variance. False alarm
  // of the χ² over the pixels below 1e-6.
  for (const double side : {0.6, 1.5, 3.3, 4.0}) {
    for (const bool torus : {true, false}) {
      const PlaneWindow window{torus ? 0 : 37, torus ? 0 : -5, {17, 13}};
      const CellLattice lattice =
          torus ? torus_lattice(1 / (side * side), window.size) : plane_lattice(1 / (side * side));
      std::vector<double> totals(static_cast<std::size_t>(window.size.area()));
      double signs = 0;
      std::int64_t impacts = 0;
      constexpr int repeats = 3000;
      for (std::uint64_t seed = 0; seed < repeats; ++seed) {
        const ImpactSet set = draw_stratified(Stream(Seed{seed}), lattice, 1, window);
        if (torus) {
          ASSERT_EQ(set.size(), lattice.x.denominator * lattice.y.denominator) << "one in each cell";
        }
        for (const ImpactStrip& strip : set.strips) {
          for (const Impact& impact : strip.impacts) {
            totals[static_cast<std::size_t>(std::int64_t{17} * impact.y + impact.x)] += 1;
            signs += impact.weight;
            ++impacts;
          }
        }
      }
      const double expected = repeats * lattice.intensity();
      double statistic = 0;
      for (const double total : totals) statistic += (total - expected) * (total - expected) / expected;
      EXPECT_GT(chi_square_p_value(statistic, 17 * 13), 1e-6) << side << " " << torus;
      EXPECT_GT(normal_p_value(signs / std::sqrt(static_cast<double>(impacts))), 1e-6);
    }
  }
}

}  // namespace textonbench::impacts_test
