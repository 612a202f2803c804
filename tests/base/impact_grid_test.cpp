#include "methods/base/impact_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "tests/base/statistics.h"

namespace textonbench::impact_grid_test {

/// False-alarm rate of each test of a law below; seeds are fixed.
constexpr double false_alarm = 1e-6;

constexpr std::uint64_t key = 0x9E3779B97F4A7C15ULL;

std::vector<CellImpact> cell(const ImpactGrid& grid, std::int64_t cx, std::int64_t cy, std::uint64_t of_key = key) {
  std::vector<CellImpact> impacts;
  grid.draw_cell(of_key, cx, cy, impacts);
  return impacts;
}

double poisson_probability(double mean, double n) { return std::exp(n * std::log(mean) - mean - std::lgamma(n + 1)); }

TEST(ImpactGrid, ThresholdsAreTheDistributionFunction) {
  for (const double mean : {0.0, 1e-6, 0.3, 7.5, 60.0, max_cell_mean}) {
    const auto thresholds = poisson_thresholds(mean);
    double sum = 0;
    for (std::size_t n = 0; n < thresholds.size(); ++n) {
      sum += mean == 0 ? (n == 0 ? 1 : 0) : poisson_probability(mean, static_cast<double>(n));
      // lgamma of a number near 600 is good to 1e-12.
      EXPECT_NEAR(thresholds[n] * 0x1p-32, sum, 2e-12 * 600 + 0x1p-32) << mean << " " << n;
    }
    EXPECT_GE(sum, mean == 0 ? 0.0 : 1 - 2 * 0x1p-32);
  }
  EXPECT_THROW(poisson_thresholds(-1), std::invalid_argument);
  EXPECT_THROW(poisson_thresholds(601), std::invalid_argument);
  EXPECT_THROW(poisson_thresholds(std::nan("")), std::invalid_argument);
}

/// What shaders have to find: words by the definition in the header.
TEST(ImpactGrid, ImpactsAreMadeOfTheWordsThatTheHeaderSays) {
  const ImpactGrid poisson(ImpactProcess::poisson, 0.02, 20, 5);
  const ImpactGrid stratified(ImpactProcess::stratified, 0.01, 0, 5);
  const auto thresholds = poisson_thresholds(poisson.cell_mean());
  for (std::int64_t cx = -3; cx < 30; ++cx) {
    const std::int64_t cy = (std::int64_t{1} << 40) - 7 * cx;
    const auto word = [&](std::uint64_t i) {
      return philox_block(key ^ (i / 4), static_cast<std::uint64_t>(cy), static_cast<std::uint64_t>(cx))[i % 4];
    };
    const auto expect = [&](const CellImpact& impact, std::uint64_t i) {
      const std::uint32_t u = word(2 * i + 2);
      const std::uint32_t v = word(2 * i + 3);
      EXPECT_EQ(impact.x, u >> 8U);
      EXPECT_EQ(impact.y, v >> 8U);
      EXPECT_EQ(impact.kernel, static_cast<int>(((u % 256 * 256 + v % 256) * 5) / 65536));
    };
    const auto impacts = cell(poisson, cx, cy);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(impacts.size()),
              std::ranges::count_if(thresholds, [&](std::uint32_t t) { return t <= word(0); }));
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      expect(impacts[i], i);
      EXPECT_EQ(impacts[i].weight, 1);
    }
    const auto one = cell(stratified, cx, cy);
    ASSERT_EQ(one.size(), 1U);
    expect(one[0], 0);
    EXPECT_EQ(one[0].weight, word(0) >> 31U == 1 ? -1 : 1);
  }
}

TEST(ImpactGrid, NumbersArePoissonAndCellsIndependent) {
  for (const double mean : {0.4, 7.0, 12.5}) {
    const ImpactGrid grid(ImpactProcess::poisson, mean / 64, 8, 1);
    ASSERT_DOUBLE_EQ(grid.cell_mean(), mean);
    constexpr int side = 300;
    std::vector<double> numbers;
    for (int i = 0; i < side * side; ++i) {
      // Half of the cells are beyond 2^31.
      const std::int64_t cx = i % side + (i % side < side / 2 ? 0 : std::int64_t{1} << 33);
      numbers.push_back(static_cast<double>(cell(grid, cx - 75, i / side - 99).size()));
    }
    std::vector<double> counts;
    std::vector<double> expected;
    for (double n = 0, rest = 1; rest * side * side > 40; ++n) {
      const double p = poisson_probability(mean, n);
      rest -= p;
      const bool last = rest * side * side <= 40;
      const double drawn =
          static_cast<double>(std::ranges::count_if(numbers, [&](double m) { return m == n || (last && m > n); }));
      const double of_law = (p + (last ? rest : 0)) * side * side;
      if (!expected.empty() && expected.back() < 20) {
        counts.back() += drawn;
        expected.back() += of_law;
      } else {
        counts.push_back(drawn);
        expected.push_back(of_law);
      }
    }
    EXPECT_GT(chi_square_p_value(counts, expected), false_alarm) << mean;
    // Correlation of neighbors to the right, below, on the diagonals, and of the far half with the near one.
    for (const int lag : {1, side, side + 1, side - 1, side / 2}) {
      double sum = 0;
      const auto pairs = static_cast<std::size_t>(side * side - lag);
      for (std::size_t i = 0; i < pairs; ++i) {
        sum += (numbers[i] - mean) * (numbers[i + static_cast<std::size_t>(lag)] - mean) / mean;
      }
      EXPECT_GT(normal_p_value(sum / std::sqrt(static_cast<double>(pairs))), false_alarm) << mean << " " << lag;
    }
  }
}

TEST(ImpactGrid, SignsLeaveThePlacesAsTheyAre) {
  const ImpactGrid plain(ImpactProcess::poisson, 0.1, 10, 3);
  const ImpactGrid with_signs(ImpactProcess::signed_poisson, 0.1, 10, 3);
  EXPECT_EQ(with_signs.mean_weight(), 0);
  for (int i = 0; i < 100; ++i) {
    const auto expected = cell(plain, i, -i);
    const auto found = cell(with_signs, i, -i);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t j = 0; j < found.size(); ++j) {
      EXPECT_EQ(found[j].x, expected[j].x);
      EXPECT_EQ(found[j].y, expected[j].y);
      EXPECT_EQ(std::abs(found[j].weight), 1);
    }
  }
}

TEST(ImpactGrid, KernelsCanBeChosenByPlace) {
  ImpactGrid grid(ImpactProcess::stratified, 0.01, 0, 5);
  grid.choose_kernels([](std::int64_t x, std::int64_t) { return x < 0 ? 1 : 4; });
  std::vector<PlaneImpact> impacts;
  const std::int64_t reach = std::int64_t{100} << plane_bits;
  grid.draw(7, {-reach, -reach, reach, reach}, impacts);
  EXPECT_GT(impacts.size(), 300U);
  for (const PlaneImpact& impact : impacts) {
    EXPECT_EQ(impact.kernel, impact.x < 0 ? 1 : 4);
  }
}

TEST(ImpactGrid, PositionsKernelsAndSignsAreUniformAndIndependent) {
  const ImpactGrid poisson(ImpactProcess::poisson, 0.1, 10, 3);
  const ImpactGrid stratified(ImpactProcess::stratified, 0.1, 0, 3);
  const ImpactGrid paper(ImpactProcess::paper, 0.1, 10, 3);
  const ImpactGrid with_signs(ImpactProcess::signed_poisson, 0.1, 10, 3);
  for (const ImpactGrid* grid : {&poisson, &with_signs, &stratified, &paper}) {
    // 16 x 16 places, 3 kernels, 2 signs; of an impact, and of its place with that of the next one drawn.
    std::vector<double> counts(256 * 6);
    std::vector<double> pairs(256 * 256);
    std::uint32_t before = 0;
    double total = 0;
    for (int i = 0; i < 700 * 700; ++i) {
      for (const CellImpact& impact : cell(*grid, i % 700, i / 700 + (std::int64_t{1} << 34))) {
        ASSERT_LT(std::max(impact.x, impact.y), 1U << 24U);
        const std::uint32_t place = (impact.x >> 20U) * 16 + (impact.y >> 20U);
        const std::uint32_t kind = static_cast<std::uint32_t>(impact.kernel) * 2 + (impact.weight < 0 ? 1 : 0);
        counts[place * 6 + kind] += 1;
        pairs[before * 256 + place] += 1;
        before = place;
        total += 1;
      }
    }
    std::vector<double> drawn;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (grid == &stratified || grid == &with_signs || i % 2 == 0) {
        drawn.push_back(counts[i]);
      } else {
        EXPECT_EQ(counts[i], 0);
      }
    }
    const double share = total / static_cast<double>(drawn.size());
    EXPECT_GT(chi_square_p_value(drawn, std::vector<double>(drawn.size(), share)), false_alarm);
    EXPECT_GT(chi_square_p_value(pairs, std::vector<double>(pairs.size(), total / 65536)), false_alarm);
  }
}

TEST(ImpactGrid, RectanglesAgreeWhereTheyOverlapAndHoldTheCells) {
  for (const ImpactProcess process : {ImpactProcess::poisson, ImpactProcess::stratified, ImpactProcess::paper}) {
    const ImpactGrid grid(process, 0.03, 13.37, 2);
    constexpr std::int64_t pixel = std::int64_t{1} << plane_bits;
    for (const std::int64_t corner : {-70 * pixel - 5, (std::int64_t{1} << 40) * pixel}) {
      const PlaneRectangle whole{corner, 3 - corner, corner + 200 * pixel, 3 - corner + 150 * pixel};
      const PlaneRectangle part{corner + 31 * pixel, 3 - corner + 17 * pixel, corner + 90 * pixel,
                                3 - corner + 99 * pixel};
      std::vector<PlaneImpact> all;
      std::vector<PlaneImpact> some;
      std::vector<PlaneImpact> by_rows;
      grid.draw(key, whole, all);
      grid.draw(key, part, some);
      for (const PlaneRectangle& row : grid.cell_rows(part)) grid.draw(key, row, by_rows);
      std::erase_if(all, [&](const PlaneImpact& i) {
        return i.x < part.left || i.x >= part.right || i.y < part.top || i.y >= part.bottom;
      });
      ASSERT_GT(all.size(), 80U);
      const auto same = [](const PlaneImpact& a, const PlaneImpact& b) {
        return std::tie(a.x, a.y, a.kernel, a.weight) == std::tie(b.x, b.y, b.kernel, b.weight);
      };
      EXPECT_TRUE(std::ranges::equal(all, some, same));
      EXPECT_TRUE(std::ranges::equal(all, by_rows, same));
    }
    std::vector<PlaneImpact> of_cell;
    const auto side = static_cast<std::int64_t>(grid.side() * pixel);
    grid.draw(key, {-5 * side, 9 * side, -4 * side, 10 * side}, of_cell);
    const auto drawn = cell(grid, -5, 9);
    ASSERT_EQ(of_cell.size(), drawn.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      EXPECT_EQ(of_cell[i].x, static_cast<std::int64_t>(std::floor((-5 + drawn[i].x * 0x1p-24) * grid.side() * pixel)));
    }
  }
}

TEST(ImpactGrid, FarCellsKeysAndKernelsDiffer) {
  const ImpactGrid grid(ImpactProcess::stratified, 0.01, 0, 1);
  std::set<std::uint32_t> seen;
  for (int bit = 0; bit < 64; ++bit) {
    const auto far = static_cast<std::int64_t>(std::uint64_t{1} << bit);
    seen.insert(cell(grid, far, 0)[0].x);
    seen.insert(cell(grid, 0, far)[0].x);
    seen.insert(cell(grid, 0, 0, key ^ (std::uint64_t{1} << bit))[0].x);
  }
  EXPECT_GT(seen.size(), 189U);  // of 192 numbers of 24 bits
}

TEST(ImpactGrid, ThePapersNoiseIsPeriodicAndItsSeedsAreShifts) {
  const ImpactGrid grid(ImpactProcess::paper, 0.12, 10, 1);
  const auto x_of = [&](std::int64_t cx, std::int64_t cy, std::uint64_t of_key) {
    std::vector<std::uint32_t> x;
    for (const CellImpact& impact : cell(grid, cx, cy, of_key)) x.push_back(impact.x);
    return x;
  };
  for (std::int64_t i = 0; i < 50; ++i) {
    EXPECT_EQ(x_of(i, 2 * i, 7), x_of(i + 1024, 2 * i - 3 * 1024, 7));
    EXPECT_EQ(x_of(i, 2 * i, 8), x_of(i + 1, 2 * i, 7));
    EXPECT_NE(x_of(i, 2 * i, 7), x_of(i + 512, 2 * i, 7));
  }
}

TEST(ImpactGrid, ThePapersNumbersAreRoundedGaussiansAndMayBeNegative) {
  constexpr int draws = 2000000;
  for (const double mean : {11.7, 1.95}) {  // MNI 30 and 5 in cells of 0.625 sides
    RandomSequence random(Stream(Seed{3}).child("paper"));
    double sum = 0;
    double squares = 0;
    double negative = 0;
    for (int i = 0; i < draws; ++i) {
      const std::uint32_t u = std::max(random.next(), 1U);
      const auto n = static_cast<double>(paper_count(mean, u, random.next()));
      sum += n - mean;
      squares += (n - mean) * (n - mean);
      negative += n < 0 ? 1 : 0;
    }
    // Rounding adds 1/12; the sample variance of a Gaussian has the standard error sqrt(2 / draws) of itself.
    const double variance = mean + 1.0 / 12;
    EXPECT_GT(normal_p_value(sum / std::sqrt(draws * variance)), false_alarm);
    EXPECT_GT(normal_p_value((squares / draws - variance) / (variance * std::sqrt(2.0 / draws))), false_alarm);
    EXPECT_LT(normal_p_value((squares / draws - mean) / (variance * std::sqrt(2.0 / draws))), false_alarm);
    const double p = normal_cdf(-(mean + 0.5) / std::sqrt(mean));
    EXPECT_NEAR(p, mean > 10 ? 1.8e-4 : 0.04, mean > 10 ? 1e-5 : 1e-3);
    EXPECT_GT(normal_p_value((negative - draws * p) / std::sqrt(draws * p)), false_alarm);
  }
}

TEST(ImpactGrid, RefusesIntensitiesAndCellsOutOfRange) {
  EXPECT_THROW(ImpactGrid(ImpactProcess::poisson, 0, 1, 1), std::invalid_argument);
  EXPECT_THROW(ImpactGrid(ImpactProcess::poisson, 65, 1, 1), std::invalid_argument);
  EXPECT_THROW(ImpactGrid(ImpactProcess::poisson, 1, 25, 1), std::invalid_argument);
  EXPECT_THROW(ImpactGrid(ImpactProcess::poisson, 1, 0, 1), std::invalid_argument);
  EXPECT_THROW(ImpactGrid(ImpactProcess::paper, 1e-9, 0x1p21, 1), std::invalid_argument);
  EXPECT_THROW(ImpactGrid(ImpactProcess::stratified, 1, 0, 0), std::invalid_argument);
  EXPECT_NO_THROW(ImpactGrid(ImpactProcess::stratified, 1, 0, 1));
  // Intensity of stratified cells after rounding.
  const ImpactGrid grid(ImpactProcess::stratified, 0.0123, 0, 1);
  EXPECT_EQ(grid.intensity() * grid.side() * grid.side(), 1);
  EXPECT_NEAR(grid.intensity(), 0.0123, 0.0123 * 1e-3);
}

}  // namespace textonbench::impact_grid_test
