// Strata of a spectrum, their erosion and their clusters.
#include "methods/sparse/strata.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace textonbench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const Stream stream = Stream(Seed{5}).child("strata test");

/// Power that falls off from a ridge, with noise.
PowerPlane rough_plane(int side) {
  PowerPlane plane(side);
  RandomSequence numbers(stream.child("power"));
  for (const Pixel& bin : plane.half()) {
    plane.set(bin.x, bin.y, -std::log(numbers.uniform()) / (1 + 0.05 * (bin.x * bin.x + 4 * bin.y * bin.y)));
  }
  return plane;
}

std::set<std::pair<int, int>> as_set(const std::vector<Pixel>& bins) {
  std::set<std::pair<int, int>> all;
  for (const Pixel& bin : bins) all.insert({bin.x, bin.y});
  return all;
}

TEST(PowerPlane, HalfStandsForTheWholePlane) {
  const PowerPlane plane(16);
  int bins = 0;
  for (const Pixel& bin : plane.half()) bins += plane.multiplicity(bin);
  EXPECT_EQ(bins, 256);
  EXPECT_EQ(as_set(plane.half()).size(), plane.half().size());
  PowerPlane marked(16);
  marked.set(3, -2, 7);
  EXPECT_EQ(marked.at(-3, 2), 7);
  EXPECT_EQ(marked.at(13, 18), 7);
  EXPECT_EQ(marked.total(), 14);
}

TEST(Stratify, EnergiesAreEqualWithinOneBin) {
  for (const int strata : {1, 2, 4, 7}) {
    const PowerPlane plane = rough_plane(32);
    const auto all = stratify(plane, {.strata = strata, .cosines = 50, .kept = 1}, stream);
    ASSERT_EQ(all.size(), static_cast<std::size_t>(strata));
    double largest_bin = 0;
    for (const Pixel& bin : plane.half()) {
      largest_bin = std::max(largest_bin, plane.multiplicity(bin) * plane.at(bin.x, bin.y));
    }
    double last = INFINITY, energy = 0;
    std::size_t bins = 0;
    int area = 0, cosines = 0;
    for (const Stratum& stratum : all) {
      EXPECT_NEAR(stratum.energy, plane.total() / strata, largest_bin);
      energy += stratum.energy;
      bins += stratum.bins.size();
      area += stratum.area;
      cosines += stratum.cosines;
      for (const Pixel& bin : stratum.bins) EXPECT_LE(plane.at(bin.x, bin.y), last) << "strata descend in power";
      for (const Pixel& bin : stratum.bins) last = std::min(last, plane.at(bin.x, bin.y));
    }
    EXPECT_NEAR(energy, plane.total(), 1e-9 * plane.total());
    EXPECT_EQ(bins, plane.half().size());
    EXPECT_EQ(area, 32 * 32);
    EXPECT_EQ(cosines, 50);
  }
}

TEST(Stratify, PartsAreDisjointSetsOfBinsAndNoneIsEmpty) {
  for (const Stratum& stratum : stratify(rough_plane(32), {.strata = 4, .cosines = 30}, stream)) {
    const auto bins = as_set(stratum.bins);
    std::set<std::pair<int, int>> seen;
    EXPECT_EQ(stratum.parts.size(), static_cast<std::size_t>(stratum.cosines));
    ASSERT_EQ(stratum.part_energy.size(), stratum.parts.size());
    double energy = 0;
    for (const double one : stratum.part_energy) energy += one;
    EXPECT_NEAR(energy, stratum.energy, 1e-9 * energy);
    EXPECT_DOUBLE_EQ(stratum.spacing, 32 * std::sqrt(stratum.cosines / (2.0 * stratum.area)));
    for (const auto& part : stratum.parts) {
      EXPECT_FALSE(part.empty());
      for (const Pixel& bin : part) {
        EXPECT_TRUE(bins.contains({bin.x, bin.y}));
        EXPECT_TRUE(seen.insert({bin.x, bin.y}).second) << "twice";
      }
    }
  }
}

TEST(Stratify, IsDeterministic) {
  const auto a = stratify(rough_plane(32), {}, stream), b = stratify(rough_plane(32), {}, stream);
  const auto other = stratify(rough_plane(32), {}, stream.child("other"));
  ASSERT_EQ(a.size(), b.size());
  bool differs = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].parts, b[i].parts);
    differs = differs || a[i].parts != other[i].parts;
  }
  EXPECT_TRUE(differs) << "another seed, other clusters";
}

TEST(Stratify, SpectrumOfOneLineIsOneStratumOfOneCosine) {
  PowerPlane plane(32);
  plane.set(4, 3, 2.5);
  const auto all = stratify(plane, {.strata = 4, .cosines = 50}, stream);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all.front().cosines, 1);
  EXPECT_EQ(all.front().area, 2);
  EXPECT_EQ(all.front().energy, 5);
  EXPECT_EQ(all.front().spacing, 16);
  EXPECT_EQ(all.front().parts, (std::vector<std::vector<Pixel>>{{{4, 3}}}));
}

TEST(Stratify, CosinesThatSmallStrataCannotTakeGoToOthers) {
  PowerPlane plane(32);
  for (const Pixel& bin : plane.half()) plane.set(bin.x, bin.y, 1e-3);
  plane.set(4, 3, 10);
  const auto all = stratify(plane, {.strata = 2, .cosines = 21, .kept = 1}, stream);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].cosines, 1);
  EXPECT_EQ(all[1].cosines, 20);
}

TEST(Stratify, LeavesOutTheWeakestBins) {
  const PowerPlane plane = rough_plane(32);
  double energy = 0, least = INFINITY;
  std::size_t bins = 0;
  for (const Stratum& stratum : stratify(plane, {.kept = 0.9}, stream)) {
    energy += stratum.energy;
    bins += stratum.bins.size();
    for (const Pixel& bin : stratum.bins) least = std::min(least, plane.at(bin.x, bin.y));
  }
  EXPECT_GE(energy, 0.9 * plane.total());
  EXPECT_LE(energy, 0.9 * plane.total() + 2 * least);
  EXPECT_LT(bins, plane.half().size() * 3 / 4);
}

TEST(Stratify, TellsWhatIsWrong) {
  EXPECT_THAT([] { stratify(rough_plane(32), {.strata = 4, .cosines = 3}, stream); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("3 cosines in 4 strata")));
  EXPECT_THAT([] { stratify(PowerPlane(32), {}, stream); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("without power")));
}

/// Against distances by looking at all bins of the torus.
TEST(ErodeBins, KeepsWhatIsFarFromTheOutsideAndTheHeartOfSmallPieces) {
  constexpr int side = 24;
  std::vector<Pixel> bins;
  const PowerPlane plane(side);
  for (const Pixel& bin : plane.half()) {
    const bool disc = std::hypot(bin.x - 6, bin.y + 4) < 4.5, speck = bin == Pixel{2, 9} || bin == Pixel{3, 9};
    if (disc || speck) bins.push_back(bin);
  }
  const auto distance = [&](const Pixel& bin) {
    double nearest = side;
    for (int y = -side / 2; y < side / 2; ++y) {
      for (int x = -side / 2; x < side / 2; ++x) {
        const auto inside = [&](Pixel p) { return std::ranges::find(bins, p) != bins.end(); };
        if (inside({x, y}) || inside({-x, -y})) continue;
        const double dx = std::remainder(x - bin.x, side), dy = std::remainder(y - bin.y, side);
        nearest = std::min(nearest, std::hypot(dx, dy));
      }
    }
    return nearest;
  };
  for (const double by : {0.5, 1.5, 2.3, 3.0}) {
    const auto rest = as_set(erode_bins(bins, side, by, 1));
    for (const Pixel& bin : bins) {
      const bool speck = bin.y == 9;
      EXPECT_EQ(rest.contains({bin.x, bin.y}), speck || distance(bin) >= by) << by << " " << bin.x << " " << bin.y;
    }
  }
  const auto heart = as_set(erode_bins(bins, side, 100, 1));
  EXPECT_TRUE(heart.contains({6, -4})) << "a piece is never wiped out";
  EXPECT_TRUE(heart.contains({2, 9}));
  EXPECT_LT(heart.size(), 8U);
  EXPECT_GE(erode_bins(bins, side, 100, 20).size(), 20U);
  EXPECT_EQ(erode_bins(bins, side, 100, 1000).size(), bins.size());
}

/// A ring that is narrower than the distance keeps its middle all around.
TEST(ErodeBins, KeepsTheMiddleOfARing) {
  constexpr int side = 64;
  std::vector<Pixel> bins;
  for (const Pixel& bin : PowerPlane(side).half()) {
    if (std::abs(std::hypot(bin.x, bin.y) - 16) < 4) bins.push_back(bin);
  }
  const std::vector<Pixel> rest = erode_bins(bins, side, 20, 1);
  int octants[8] = {};
  for (const Pixel& bin : rest) {
    EXPECT_NEAR(std::hypot(bin.x, bin.y), 16, 1.6);
    const double turn = std::atan2(bin.y, bin.x) / std::numbers::pi + 0.5;  // of the right half: 0 to 1
    ++octants[std::clamp(static_cast<int>(8 * turn), 0, 7)];
  }
  for (const int count : octants) EXPECT_GE(count, 3);
}

TEST(ClusterBins, FindsSeparateHeaps) {
  std::vector<Pixel> bins;
  for (const Pixel& center : {Pixel{0, 0}, Pixel{40, 3}, Pixel{20, 30}}) {
    for (int y = -2; y <= 2; ++y) {
      for (int x = -2; x <= 2; ++x) bins.push_back({center.x + x, center.y + y});
    }
  }
  const auto parts = cluster_bins(bins, 3, stream);
  ASSERT_EQ(parts.size(), 3U);
  for (const auto& part : parts) EXPECT_EQ(part.size(), 25U);
  EXPECT_EQ(cluster_bins(bins, 75, stream).size(), 75U) << "as many parts as bins";
}

}  // namespace
}  // namespace textonbench
