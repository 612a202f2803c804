// Shaders of texton noise that filter the kernels by the footprint of the pixel.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "methods/base/ground_view.h"
#include "methods/method.h"
#include "methods/spot/filtered_sum.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::filtered_texton_noise_test {

constexpr Seed seed{8};
constexpr Extent size{37, 29};
const Eigen::Vector2d origin(-700.5, 0x1p30 + 13.25);

/// Of hardware fetches, whose positions between texels and between levels have 8 bits, in standard deviations.
constexpr double hardware_bound = 1.0 / 200;

class FilteredTextonNoise : public testing::TestWithParam<ShaderPath> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(ContextKind::egl, reason);
    if (!context_) GTEST_SKIP() << reason;
    if (GetParam() == ShaderPath::compute && !context_->info().compute()) {
      GTEST_SKIP() << "compute shaders need OpenGL 4.3, and this is " << context_->info().version;
    }
  }

  Image draw(ShaderFetch fetch, ShaderFilter filter, ShaderWindow window, const Frame& frame) {
    const ShaderRequest request{.seed = seed, .near = origin, .fetch = fetch, .filter = filter, .window = window};
    const auto noise = make_spline_noise(texton_, options_);
    return Renderer(*context_, noise->shader(request).value(), GetParam()).draw(frame);
  }

  /// What FilteredSum makes of the same frame.
  Image on_processor(TextonFilter filter, ShaderWindow window, const Frame& frame) const {
    const FilteredSum sum(texton_, options_);
    const auto sum_window = window == ShaderWindow::kernel ? ImpactWindow::kernel : ImpactWindow::footprint;
    const GroundView ground(frame.size, frame.ground.value_or(GroundViewOptions{}));
    std::vector<PlaneImpact> impacts;
    Image image(frame.size, 3);
    for (int y = 0; y < frame.size.height; ++y) {
      for (int x = 0; x < frame.size.width; ++x) {
        if (frame.ground && !ground.covers(x, y)) continue;
        const Eigen::Vector2d point = frame.ground ? ground.point(x, y) : frame.step * Eigen::Vector2d(x, y);
        const Eigen::Matrix2d footprint =
            frame.ground ? ground.footprint(x, y) : Eigen::Matrix2d(frame.step * Eigen::Matrix2d::Identity());
        const Eigen::Vector4d value =
            sum.evaluate(frame.origin + point, footprint, filter, sum_window, spline_noise_key(seed), impacts);
        for (int c = 0; c < 3; ++c) image.at(c, x, y) = static_cast<float>(value[c]);
      }
    }
    return image;
  }

  SplineTexton texton_ = shader_texton(1, 3, 2);
  SplineNoiseOptions options_{.impacts = ImpactProcess::stratified, .mni = 5};
  std::unique_ptr<Context> context_;
};

/// Where the footprint is a square of 2^l pixels, a texture unit reads level l alone, as the processor does. (Not by
/// its anisotropic filter, which drivers make as they like.)
TEST_P(FilteredTextonNoise, OfSquareFootprintsIsThatOfTheProcessor) {
  for (const ShaderWindow window : {ShaderWindow::footprint, ShaderWindow::kernel}) {
    for (const double step : {1.0, 2.0, 8.0}) {
      const Frame frame{.size = size, .origin = origin, .step = step};
      const Image expected = on_processor(TextonFilter::trilinear, window, frame);
      for (const ShaderFilter filter : {ShaderFilter::mipmap, ShaderFilter::trilinear}) {
        const Image drawn = draw(ShaderFetch::hardware, filter, window, frame);
        EXPECT_LE(largest_difference(drawn, expected, deviations(texton_)), hardware_bound)
            << "step " << step << ", filter " << static_cast<int>(filter) << ", window " << static_cast<int>(window);
      }
    }
  }
}

/// Footprints of all shapes, the longer sides up to 64 pixels.
TEST_P(FilteredTextonNoise, OfTheGroundByLevelsAndProbesOfTheShaderIsThatOfTheProcessor) {
  const Frame frame{.size = {61, 47}, .origin = origin, .ground = GroundViewOptions{.height = 30, .pitch = 0.4}};
  for (const ShaderWindow window : {ShaderWindow::footprint, ShaderWindow::kernel}) {
    EXPECT_LE(largest_difference(draw(ShaderFetch::manual, ShaderFilter::trilinear, window, frame),
                                 on_processor(TextonFilter::trilinear, window, frame), deviations(texton_)),
              hardware_bound);
    EXPECT_LE(largest_difference(draw(ShaderFetch::manual, ShaderFilter::anisotropic, window, frame),
                                 on_processor(TextonFilter::anisotropic, window, frame), deviations(texton_)),
              hardware_bound);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, FilteredTextonNoise, testing::Values(ShaderPath::fragment, ShaderPath::compute),
                         [](const auto& path) { return path.param == ShaderPath::compute ? "compute" : "fragment"; });

}  // namespace textonbench::filtered_texton_noise_test
