// The kernels that the shader of Gabor noise draws are those of GaborImpacts, bit for bit.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "methods/sparse/gabor.h"
#include "methods/sparse/gabor_shader.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::gabor_kernels_test {

constexpr Seed seed{29};
constexpr int cells_aside = 32;

/// Two bands of unlike cells, the second of 5000 entries that are not drawn alike.
GaborField drawn_field(ImpactProcess process, GaborPhase phase, GaborWeight weight) {
  const GaborOptions options{.bandwidth = 0.2, .mni = 3, .process = process};
  GaborField field = gabor_field(options);
  field.phase = phase;
  field.weight = weight;
  GaborBand& band = field.bands.emplace_back(field.bands.front());
  band.intensity *= 0.7;
  band.cell = 6.3;
  std::vector<double> weights;
  weights.reserve(5000);
  for (int e = 0; e < 5000; ++e) weights.push_back(1.0 + e * e % 97);
  band.frequency.assign(weights.size(), {0.1, 0.2});
  band.color.assign(weights.size(), 1);
  band.draw_by(weights);
  return field;
}

class GaborKernels : public testing::TestWithParam<ContextKind> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(GetParam(), reason);
    if (!context_) GTEST_SKIP() << reason;
  }

  /// Kernels number `impact` of a band's cells from `corner` on, a number of pixels from the recipe's base.
  Image draw(ShaderRecipe recipe, std::size_t band, const Eigen::Vector2d& corner, double side, int impact) {
    recipe.shader = "gabor_probe";
    recipe.channels = 8;
    recipe.uniforms.emplace_back("probe_band", static_cast<std::int32_t>(band));
    recipe.uniforms.emplace_back("probe_impact", std::int32_t{impact});
    // A sixteenth of a side is well inside.
    const Frame frame{.size = {cells_aside, cells_aside},
                      .origin = recipe.base + corner + Eigen::Vector2d::Constant(side / 16),
                      .step = side};
    return Renderer(*context_, recipe, ShaderPath::fragment).draw(frame);
  }

  std::unique_ptr<Context> context_;
};

/// A kernel as gabor_probe.glsl shows it, from a base in 2^−22 pixel.
std::array<float, 8> shown(const GaborImpact& kernel, std::int64_t base_x, std::int64_t base_y) {
  const std::int64_t x = kernel.x - base_x, y = kernel.y - base_y;
  const auto number = [](auto v) { return static_cast<float>(v); };
  return {number(x >> 12),
          number(y >> 12),
          number(x & 4095),
          number(y & 4095),
          number(kernel.entry),
          number(kernel.phase >> 16U),
          number(kernel.phase & 0xFFFFU),
          kernel.weight};
}

TEST_P(GaborKernels, AreThoseOfTheProcessorBitForBit) {
  constexpr double unit = 0x1p22;
  for (const auto& [process, phase, weight] :
       {std::tuple{ImpactProcess::poisson, GaborPhase::random, GaborWeight::uniform},
        std::tuple{ImpactProcess::signed_poisson, GaborPhase::sine, GaborWeight::uniform},
        std::tuple{ImpactProcess::stratified, GaborPhase::random, GaborWeight::impacts}}) {
    const GaborField field = drawn_field(process, phase, weight);
    for (const auto& near : {Eigen::Vector2d(0, 0), Eigen::Vector2d(-0x1p20 + 0.3, 77),
                             Eigen::Vector2d(0x1p36, -0x1p39), Eigen::Vector2d(-0x1p40, 0x1p40)}) {
      const ShaderRecipe recipe = gabor_recipe(field, std::vector<double>{0}, {.seed = seed, .near = near});
      const auto base_x = static_cast<std::int64_t>(recipe.base.x() * unit);
      const auto base_y = static_cast<std::int64_t>(recipe.base.y() * unit);
      for (std::size_t b = 0; b < field.bands.size(); ++b) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(process) << " near " << near.transpose() << ", band " << b);
        GaborImpacts impacts(field, b, seed);
        const double side = impacts.grid().side();
        const auto plane_side = static_cast<std::int64_t>(side * unit);
        const auto first = [&](double base) {
          return static_cast<std::int64_t>(std::floor(base / side)) - cells_aside / 2;
        };
        const std::int64_t left = first(recipe.base.x()), top = first(recipe.base.y());
        const Eigen::Vector2d corner(static_cast<double>(left) * side - recipe.base.x(),
                                     static_cast<double>(top) * side - recipe.base.y());
        std::vector<std::vector<GaborImpact>> cells;
        std::size_t most = 0;
        for (std::int64_t y = top; y < top + cells_aside; ++y) {
          for (std::int64_t x = left; x < left + cells_aside; ++x) {
            impacts.draw({x * plane_side, y * plane_side, (x + 1) * plane_side, (y + 1) * plane_side},
                         cells.emplace_back());
            most = std::max(most, cells.back().size());
          }
        }
        for (std::size_t i = 0; i <= most; ++i) {
          const Image image = draw(recipe, b, corner, side, static_cast<int>(i));
          auto cell = cells.cbegin();
          for (int y = 0; y < cells_aside; ++y) {
            for (int x = 0; x < cells_aside; ++x, ++cell) {
              const auto expected = i < cell->size() ? shown((*cell)[i], base_x, base_y) : std::array<float, 8>{};
              for (int c = 0; c < 8; ++c) {
                ASSERT_EQ(image.at(c, x, y), expected[static_cast<std::size_t>(c)]) << x << " " << y << " " << c;
              }
            }
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Contexts, GaborKernels, testing::Values(ContextKind::egl, ContextKind::osmesa),
                         [](const auto& context) { return std::string(context_name(context.param)); });

}  // namespace textonbench::gabor_kernels_test
