// The impacts that shaders draw are those of ImpactGrid, bit for bit.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <utility>

#include "methods/spot/spline_shader.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::texton_impacts_test {

constexpr Seed seed{5};
constexpr int cells_aside = 50;

class TextonImpacts : public testing::TestWithParam<ContextKind> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(GetParam(), reason);
    if (!context_) GTEST_SKIP() << reason;
  }

  ShaderRecipe probe(const SplineTexton& texton, const SplineNoiseOptions& options, const Eigen::Vector2d& near) {
    ShaderRecipe recipe = spline_noise_recipe(texton, options, {.seed = seed, .near = near});
    recipe.shader = "impact_probe";
    recipe.channels = 4;
    recipe.uniforms.emplace_back("probe_impact", std::int32_t{0});
    return recipe;
  }

  /// What impact number `impact` is in the cells around a place.
  Image draw(ShaderRecipe recipe, double side, int impact) {
    recipe.uniforms.back().second = std::int32_t{impact};
    const double half = cells_aside / 2 * side;
    const Frame frame{
        .size = {cells_aside, cells_aside}, .origin = recipe.base - Eigen::Vector2d(half, half), .step = side};
    return Renderer(*context_, recipe, ShaderPath::fragment).draw(frame);
  }

  std::unique_ptr<Context> context_;
};

/// All impacts of 2500 cells at each of four places: 10,000 cells of each process.
TEST_P(TextonImpacts, AreThoseOfTheProcessorBitForBit) {
  const SplineTexton texton = shader_texton(1, 1, 3);
  for (const ImpactProcess process :
       {ImpactProcess::poisson, ImpactProcess::signed_poisson, ImpactProcess::stratified}) {
    const SplineNoiseOptions options{.impacts = process, .mni = 7.3, .cell = 0.7};
    const ImpactGrid grid = spline_noise_impacts(texton, options);
    for (const auto& near : {Eigen::Vector2d(0, 0), Eigen::Vector2d(-0x1p20 + 0.3, 77),
                             Eigen::Vector2d(0x1p36, -0x1p39), Eigen::Vector2d(-0x1p40, 0x1p40)}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(process) << " near " << near.transpose());
      const ShaderRecipe recipe = probe(texton, options, near);
      const auto first_x = static_cast<std::int64_t>(recipe.base.x() / grid.side()) - cells_aside / 2;
      const auto first_y = static_cast<std::int64_t>(recipe.base.y() / grid.side()) - cells_aside / 2;
      std::vector<std::vector<CellImpact>> cells;
      std::size_t most = 0;
      for (int y = 0; y < cells_aside; ++y) {
        for (int x = 0; x < cells_aside; ++x) {
          grid.draw_cell(spline_noise_key(seed), first_x + x, first_y + y, cells.emplace_back());
          most = std::max(most, cells.back().size());
        }
      }
      for (std::size_t i = 0; i < most; ++i) {
        const Image image = draw(recipe, grid.side(), static_cast<int>(i));
        for (int y = 0; y < cells_aside; ++y) {
          for (int x = 0; x < cells_aside; ++x) {
            const std::vector<CellImpact>& cell = cells[static_cast<std::size_t>(y * cells_aside + x)];
            ASSERT_EQ(image.at(0, x, y), static_cast<float>(cell.size())) << x << " " << y;
            if (i >= cell.size()) continue;
            ASSERT_EQ(image.at(1, x, y), static_cast<float>(cell[i].x)) << x << " " << y;
            ASSERT_EQ(image.at(2, x, y), static_cast<float>(cell[i].y)) << x << " " << y;
            ASSERT_EQ(image.at(3, x, y), static_cast<float>(2 * cell[i].kernel + (cell[i].weight < 0 ? 1 : 0)));
          }
        }
      }
    }
  }
}

/// The paper's numbers of impacts are made in float32, and differ from the processor's where the rounding crosses a
/// whole number: in fewer than one of 10^5 cells. All else is the same.
TEST_P(TextonImpacts, OfThePaperDifferInRareCounts) {
  const SplineTexton texton = shader_texton(1, 1, 1);
  const SplineNoiseOptions options{.impacts = ImpactProcess::paper, .mni = 30};
  const ImpactGrid grid = spline_noise_impacts(texton, options);
  const ShaderRecipe recipe = probe(texton, options, {-300.5, 41});
  const auto first_x = static_cast<std::int64_t>(recipe.base.x() / grid.side());
  const auto first_y = static_cast<std::int64_t>(recipe.base.y() / grid.side());
  constexpr int aside = 1000;
  const Frame frame{.size = {aside, aside}, .origin = recipe.base, .step = grid.side()};
  const Image image = Renderer(*context_, recipe, ShaderPath::fragment).draw(frame);
  int different = 0;
  std::vector<CellImpact> cell;
  for (int y = 0; y < aside; ++y) {
    for (int x = 0; x < aside; ++x) {
      cell.clear();
      grid.draw_cell(spline_noise_key(seed), first_x + x, first_y + y, cell);
      different += image.at(0, x, y) != static_cast<float>(cell.size()) ? 1 : 0;
      if (cell.empty() || image.at(0, x, y) == 0) continue;
      ASSERT_EQ(image.at(1, x, y), static_cast<float>(cell.front().x)) << x << " " << y;
      ASSERT_EQ(image.at(2, x, y), static_cast<float>(cell.front().y)) << x << " " << y;
    }
  }
  EXPECT_LE(different, 10);
  RecordProperty("different_counts_of_1e6", different);
}

INSTANTIATE_TEST_SUITE_P(Contexts, TextonImpacts, testing::Values(ContextKind::egl, ContextKind::osmesa),
                         [](const auto& context) { return std::string(context_name(context.param)); });

}  // namespace textonbench::texton_impacts_test
