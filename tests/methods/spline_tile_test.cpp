#include "methods/spot/spline_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/random.h"

namespace textonbench::spline_tile_test {

constexpr float start = 0.25F;
constexpr int tiles = 3;

/// Random kernels and visits of three tiles, of weights with the sum 1.
struct Scene {
  Image kernel{{90, 70}, 2};
  std::vector<TapWeights> weights;
  std::vector<TileVisit> visits;
  std::vector<std::size_t> first;

  explicit Scene(int order) {
    RandomSequence random(Stream(Seed{7}).child("tiles"));
    for (int i = 0; i < 2 * kernel.height(); ++i) {
      for (float& v : kernel.row(i / kernel.height(), i % kernel.height())) {
        v = static_cast<float>(random.uniform() - 0.5);
      }
    }
    for (int i = 0; i < 20; ++i) {
      TapWeights& w = weights.emplace_back();
      w.x[order] = w.y[order] = 1;
      for (int j = 0; j < order; ++j) {
        w.x[order] -= w.x[j] = static_cast<float>(random.uniform() / order);
        w.y[order] -= w.y[j] = static_cast<float>(random.uniform() / order);
      }
    }
    // Twenty visits run through all of the tiles, as they do where a kernel is wide.
    for (int tile = 0; tile < tiles; ++tile) {
      first.push_back(visits.size());
      for (int i = 0; i < 20; ++i) {
        visits.push_back({&kernel.at(0, i + 16 * tile, 2 * i), &weights[static_cast<std::size_t>(i)]});
      }
    }
    first.push_back(visits.size());
  }

  Image sum(int order, int channel, int rows) const {
    Image out({tiles * tile_width, tile_height(order)}, 1);
    sum_tiles(order, {visits, first, kernel.row_stride()}, channel * kernel.height() * kernel.row_stride(), start,
              {out.plane(0), out.row_stride(), rows});
    return out;
  }
};

/// The definition, at pixels whose tiles and right-hand neighbors all have their visits.
double definition(const Scene& scene, int order, int channel, int x, int y) {
  double sum = start;
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j <= order; ++j) {
      for (int i = 0; i <= order; ++i) {
        const TapWeights& w = scene.weights[static_cast<std::size_t>(k)];
        sum += double{w.y[j]} * w.x[i] * scene.kernel.at(channel, k + x + i, 2 * k + y + j);
      }
    }
  }
  return sum;
}

TEST(SplineTile, SumsAreTheDefinition) {
  for (int order = 0; order <= 5; ++order) {
    const Scene scene(order);
    for (const int channel : {0, 1}) {
      const Image out = scene.sum(order, channel, tile_height(order));
      for (int y = 0; y < tile_height(order); ++y) {
        for (int x = 0; x < 2 * tile_width; ++x) {
          EXPECT_NEAR(out.at(0, x, y), definition(scene, order, channel, x, y), 5e-6) << order;
        }
      }
    }
  }
}

TEST(SplineTile, BitsAreThoseOfScalarFusedMultiplyAdds) {
  // Of order 1: what any processor computes.
  const Scene scene(1);
  const Image out = scene.sum(1, 0, tile_height(1));
  for (int y = 0; y < tile_height(1); ++y) {
    for (int x = 0; x < 2 * tile_width; ++x) {
      float s[2] = {};
      float all[2] = {start, start};
      for (const int i : {0, 1}) {
        for (int k = 0; k < 20; ++k) {
          const TapWeights& w = scene.weights[static_cast<std::size_t>(k)];
          const float top = scene.kernel.at(0, k + x + i, 2 * k + y);
          const float below = scene.kernel.at(0, k + x + i, 2 * k + y + 1);
          const float g = std::fma(w.y[0], top - below, below);
          s[i] = std::fma(w.x[0], g, s[i]);
          all[i] += g;
        }
      }
      ASSERT_EQ(out.at(0, x, y), s[0] + (all[1] - s[1])) << x << " " << y;
    }
  }
}

TEST(SplineTile, WritesTheRowsAndLinesOfTheImageOnly) {
  for (int order = 0; order <= 5; ++order) {
    const Scene scene(order);
    Image out({2 * tile_width - 2, 4}, 1);
    ASSERT_EQ(out.row_stride(), 2 * tile_width);
    sum_tiles(order, {scene.visits, scene.first, scene.kernel.row_stride()}, 0, start,
              {out.row(0, 1).data(), out.row_stride(), 2});
    const Image whole = scene.sum(order, 0, tile_height(order));
    const auto is_zero = [](float v) { return v == 0; };
    EXPECT_TRUE(std::ranges::all_of(out.row(0, 0), is_zero));
    EXPECT_TRUE(std::ranges::all_of(out.row(0, 3), is_zero));
    for (int y = 0; y < 2; ++y) {
      EXPECT_TRUE(std::ranges::equal(out.row(0, y + 1), whole.row(0, y).first(2 * tile_width - 2)));
    }
  }
}

}  // namespace textonbench::spline_tile_test
