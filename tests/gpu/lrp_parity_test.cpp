// Pixels of the shader of local random-phase noise are the values of the processor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <tuple>

#include "methods/sparse/lrp.h"
#include "tests/gpu/texton_shader.h"
#include "tests/texture.h"

namespace textonbench::lrp_parity_test {

constexpr Seed seed{21};
constexpr Extent size{53, 37};  // no multiple of a work group

struct Place {
  Eigen::Vector2d origin{-20.3, 11.7};
  double step = 1;
};

class LrpParity : public testing::TestWithParam<std::tuple<ContextKind, ShaderPath>> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(std::get<0>(GetParam()), reason);
    if (!context_) GTEST_SKIP() << reason;
    if (std::get<1>(GetParam()) == ShaderPath::compute && !context_->info().compute()) {
      GTEST_SKIP() << "compute shaders need OpenGL 4.3, and this is " << context_->info().version;
    }
  }

  /// Largest difference of shader and processor, in standard deviations, of the first channels of a noise.
  double difference(const LrpOptions& options, int channels, const Place& place, int drawn = 0) {
    const auto model = make_lrp(analyze_lrp(test_exemplar({72, 70}, channels), options, Seed{2}));
    const ShaderRequest request{.seed = seed, .near = place.origin, .channels = drawn};
    const Image frame = Renderer(*context_, model->shader(request).value(), std::get<1>(GetParam()))
                            .draw({.size = size, .origin = place.origin, .step = place.step});
    std::vector<Point2> points;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        points.push_back({place.origin.x() + place.step * x, place.origin.y() + place.step * y});
      }
    }
    std::vector<float> values(points.size() * static_cast<std::size_t>(channels));
    model->procedural()->evaluate(points, seed, values);
    Image expected(size, frame.channels());
    for (int c = 0; c < frame.channels(); ++c) {
      for (int y = 0; y < size.height; ++y) {
        std::copy_n(values.begin() + (std::ptrdiff_t{c} * size.height + y) * size.width, size.width,
                    expected.row(c, y).begin());
      }
    }
    LrpOptions noise = options;
    noise.fixed = {};
    const auto gaussian = make_lrp(analyze_lrp(test_exemplar({72, 70}, channels), noise, Seed{2}));
    const Eigen::MatrixXd covariance = color_covariance(gaussian->gaussian()->spectrum({128, 128}));
    std::vector<double> deviations(static_cast<std::size_t>(frame.channels()));
    for (int c = 0; c < frame.channels(); ++c) deviations[static_cast<std::size_t>(c)] = std::sqrt(covariance(c, c));
    return largest_difference(frame, expected, deviations);
  }

  std::unique_ptr<Context> context_;
};

/// Sums of 450 waves in float32, with cosines of the driver's own; one wrong bin, color or phase is thousands of that.
constexpr double bound = 1e-4;

TEST_P(LrpParity, PixelsAreThePoints) {
  EXPECT_LE(difference({}, 3, {}), bound);
  EXPECT_LE(difference({}, 1, {{0x1p35 + 0.625, -0x1p35}, 0.37}), bound);
  EXPECT_LE(difference({}, 3, {{-77, -1000.25}, 3}), bound);
}

TEST_P(LrpParity, OfAllOptions) {
  LrpOptions options;
  options.even_variance = false;
  options.color = LrpColor::independent;
  options.strata = {.strata = 2, .cosines = 7};
  EXPECT_LE(difference(options, 3, {}), bound);
  options.color = LrpColor::coherent;
  EXPECT_LE(difference(options, 5, {}), bound) << "more than four channels";
  EXPECT_LE(difference(options, 5, {}, 2), bound) << "the first two of them";
  options.footprint = 3;
  options.strata.window = LrpWindow::printed;
  EXPECT_LE(difference(options, 1, {}), bound);
}

TEST_P(LrpParity, OfStructures) {
  for (const bool reduced : {true, false}) {
    LrpOptions options;
    options.fixed = {.ratio = 0.4, .reduced = reduced};
    EXPECT_LE(difference(options, 3, {}), bound);
    options.fixed.placement = true;
    EXPECT_LE(difference(options, 1, {{0x1p35 + 0.625, -0x1p35}, 0.37}), bound);
    options.fixed.turbulence = 3;
    // Turbulence is rounded to 2^−14 pixel or so, and the structure changes by about a deviation over a pixel.
    EXPECT_LE(difference(options, 3, {{-77, -1000.25}, 3}), 1e-3);
  }
  LrpOptions pixels;
  pixels.strata = {.strata = 1, .cosines = 2};
  pixels.fixed = {.ratio = 0.6};
  EXPECT_LE(difference(pixels, 3, {}), bound) << "blocks of a pixel or two";
  pixels.fixed = {.ratio = 1};
  EXPECT_LE(difference(pixels, 3, {}), bound) << "no noise at all";
}

INSTANTIATE_TEST_SUITE_P(All, LrpParity,
                         testing::Combine(testing::Values(ContextKind::egl, ContextKind::osmesa),
                                          testing::Values(ShaderPath::fragment, ShaderPath::compute)));

TEST(LrpShader, TellsWhatItCannotServe) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  const auto recipe = [](const LrpOptions& options, const ShaderRequest& request) {
    return [=] {
      static_cast<void>(make_lrp(analyze_lrp(test_exemplar({72, 70}, 1), options, Seed{2}))->shader(request));
    };
  };
  EXPECT_THAT(recipe({}, {.filter = ShaderFilter::mipmap}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("expected filter none")));
  EXPECT_THAT(recipe({}, {.half_float = true}), ThrowsMessage<std::invalid_argument>(HasSubstr("it has no texels")));
  EXPECT_THAT(recipe({}, {.near = {0x1p41, 0}}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("within 2^40 pixels of the origin")));
  LrpOptions wide;
  wide.strata.spacing = 1e6;
  EXPECT_THAT(recipe(wide, {}), ThrowsMessage<std::invalid_argument>(HasSubstr("expected at most 2^18")));
}

}  // namespace textonbench::lrp_parity_test
