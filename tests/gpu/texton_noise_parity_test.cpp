// Pixels of the shaders of texton noise are the values of the processor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <tuple>

#include "methods/method.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::texton_noise_parity_test {

constexpr Seed seed{21};
constexpr Extent size{53, 37};  // no multiple of a work group

struct Noise {
  int order = 1;
  int channels = 3;
  int kernels = 1;
  ImpactProcess process = ImpactProcess::stratified;
  double mni = 5;
};

struct Place {
  Eigen::Vector2d origin{-20.3, 11.7};
  double step = 1;
};

const Place near_place{};
const Place far_place{{0x1p35 + 0.625, -0x1p35}, 0.37};
const Place coarse_place{{-77, -1000.25}, 3};

/// In standard deviations: to rounding, and of hardware fetches, whose positions between texels have 8 bits.
constexpr double manual_bound = 1e-4;
constexpr double hardware_bound = 1.0 / 200;

class TextonNoiseParity : public testing::TestWithParam<std::tuple<ContextKind, ShaderPath>> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(std::get<0>(GetParam()), reason);
    if (!context_) GTEST_SKIP() << reason;
    if (path() == ShaderPath::compute && !context_->info().compute()) {
      GTEST_SKIP() << "compute shaders need OpenGL 4.3, and this is " << context_->info().version;
    }
  }
  static ShaderPath path() { return std::get<1>(GetParam()); }

  Image draw(const Model& model, const Place& place, ShaderRequest request, ShaderPath of_path) {
    request.seed = seed;
    request.near = place.origin;
    return Renderer(*context_, model.shader(request).value(), of_path)
        .draw({.size = size, .origin = place.origin, .step = place.step});
  }
  Image draw(const Model& model, const Place& place, const ShaderRequest& request) {
    return draw(model, place, request, path());
  }

  /// Largest difference of shader and processor, in standard deviations.
  double difference(const Noise& noise, const Place& place, const ShaderRequest& request) {
    const SplineTexton texton = shader_texton(noise.order, noise.channels, noise.kernels);
    const auto model = make_spline_noise(texton, {.impacts = noise.process, .mni = noise.mni});
    std::vector<Point2> points;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        points.push_back({place.origin.x() + place.step * x, place.origin.y() + place.step * y});
      }
    }
    std::vector<float> values(points.size() * static_cast<std::size_t>(noise.channels));
    model->procedural()->evaluate(points, seed, values);
    Image expected(size, noise.channels);
    auto from = values.cbegin();
    for (int c = 0; c < noise.channels; ++c) {
      for (int y = 0; y < size.height; ++y) {
        std::copy_n(from, size.width, expected.row(c, y).begin());
        from += size.width;
      }
    }
    return largest_difference(draw(*model, place, request), expected, deviations(texton));
  }

  std::unique_ptr<Context> context_;
};

TEST_P(TextonNoiseParity, ManualFetchesOfAllOrders) {
  const ShaderRequest manual{.fetch = ShaderFetch::manual};
  EXPECT_LE(difference({.order = 0}, near_place, manual), manual_bound);
  EXPECT_LE(difference({.order = 1}, far_place, manual), manual_bound);
  EXPECT_LE(difference({.order = 2}, coarse_place, manual), manual_bound);
  EXPECT_LE(difference({.order = 3}, near_place, manual), manual_bound);
  EXPECT_LE(difference({.order = 4}, far_place, manual), manual_bound);
  EXPECT_LE(difference({.order = 5}, coarse_place, manual), manual_bound);
}

TEST_P(TextonNoiseParity, HardwareFetches) {
  for (const int order : {0, 1, 3}) {
    for (const Place& place : {near_place, far_place, coarse_place}) {
      EXPECT_LE(difference({.order = order}, place, {}), hardware_bound) << order << " at step " << place.step;
    }
  }
}

TEST_P(TextonNoiseParity, EveryProcess) {
  for (const ImpactProcess process :
       {ImpactProcess::poisson, ImpactProcess::signed_poisson, ImpactProcess::stratified}) {
    for (const double mni : {0.5, 30.0}) {
      EXPECT_LE(difference({.process = process, .mni = mni}, near_place, {}), hardware_bound)
          << static_cast<int>(process) << " of " << mni;
    }
  }
}

/// Rounded Gaussian counts are made in float32, but those of these few hundred cells agree.
TEST_P(TextonNoiseParity, ProcessOfThePaper) {
  EXPECT_LE(difference({.process = ImpactProcess::paper, .mni = 30}, near_place, {}), hardware_bound);
}

TEST_P(TextonNoiseParity, KernelsAndChannels) {
  const ShaderRequest manual{.fetch = ShaderFetch::manual};
  EXPECT_LE(difference({.channels = 1, .kernels = 2}, near_place, manual), manual_bound);
  EXPECT_LE(difference({.channels = 3, .kernels = 3}, near_place, manual), manual_bound);
  EXPECT_LE(difference({.channels = 6, .kernels = 2}, near_place, manual), manual_bound);
  EXPECT_LE(difference({.channels = 8, .kernels = 1}, near_place, manual), manual_bound);
  EXPECT_LE(difference({.channels = 6, .kernels = 2}, far_place, {}), hardware_bound);
}

/// Texels of 11 bits are off by 2^−10 of themselves where a driver cuts, half of that where it rounds. The errors of
/// the impacts that meet have random signs, so those of a pixel have 2^−10 standard deviations at most, and of the 6000
/// numbers here none leaves 5 times as many, which is 1/200 again.
TEST_P(TextonNoiseParity, HalfFloatTexels) {
  EXPECT_LE(difference({}, near_place, {.fetch = ShaderFetch::manual, .half_float = true}), hardware_bound);
  EXPECT_LE(difference({.order = 3}, near_place, {.half_float = true}), hardware_bound);
}

/// The sums of both paths go over the same impacts in the same order.
TEST_P(TextonNoiseParity, EveryRunIsTheSameAndComputeIsFragment) {
  const SplineTexton texton = shader_texton(1, 3, 2);
  for (const ImpactProcess process : {ImpactProcess::poisson, ImpactProcess::stratified, ImpactProcess::paper}) {
    // Thousands of impacts reach a tile of the coarse place: they fill the list of a work group several times.
    const auto model = make_spline_noise(texton, {.impacts = process, .mni = 100});
    for (const Place& place : {far_place, coarse_place}) {
      const Image drawn = draw(*model, place, {});
      const Image again = draw(*model, place, {});
      EXPECT_LE(largest_difference(drawn, draw(*model, place, {}, ShaderPath::fragment), deviations(texton)), 1e-5);
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < size.height; ++y) {
          ASSERT_EQ(std::memcmp(drawn.row(c, y).data(), again.row(c, y).data(), drawn.row(c, y).size_bytes()), 0);
        }
      }
    }
  }
}

TEST_P(TextonNoiseParity, OtherSeedsAreOtherNoises) {
  const SplineTexton texton = shader_texton(1, 1, 1);
  const auto model = make_spline_noise(texton, {.impacts = ImpactProcess::stratified, .mni = 5});
  const Frame frame{.size = size};
  const Image one = Renderer(*context_, model->shader({.seed = Seed{1}}).value(), path()).draw(frame);
  const Image two = Renderer(*context_, model->shader({.seed = Seed{2}}).value(), path()).draw(frame);
  EXPECT_GT(largest_difference(one, two, deviations(texton)), 1);
}

INSTANTIATE_TEST_SUITE_P(Contexts, TextonNoiseParity,
                         testing::Combine(testing::Values(ContextKind::egl, ContextKind::osmesa),
                                          testing::Values(ShaderPath::fragment, ShaderPath::compute)),
                         [](const auto& context) {
                           return std::string(context_name(std::get<0>(context.param))) +
                                  (std::get<1>(context.param) == ShaderPath::compute ? "_compute" : "_fragment");
                         });

}  // namespace textonbench::texton_noise_parity_test
