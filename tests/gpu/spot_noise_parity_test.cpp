// Shaders of spot noise draw the processor's impacts, and their pixels are its values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <tuple>
#include <vector>

#include "methods/spot/dsn.h"
#include "methods/spot/spot_noise.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::spot_noise_parity_test {

using testing::HasSubstr;

const std::vector<Eigen::Vector2d> places{{-20, 11}, {0x1p35 + 5, -0x1p35 + 1}, {-0x1p40 + 1, 0x1p40 - 2000}};

/// Standard deviation of each channel: (Σ_k Σ_x h_k(x)²)^(1/2).
std::vector<double> deviations_of(const Texton& texton) {
  std::vector<double> result;
  for (int c = 0; c < texton.channels(); ++c) {
    double variance = 0;
    for (const Image& kernel : texton.kernels) {
      for (int y = 0; y < kernel.height(); ++y) {
        for (const float v : kernel.row(c, y)) variance += static_cast<double>(v) * static_cast<double>(v);
      }
    }
    result.push_back(std::sqrt(variance));
  }
  return result;
}

class SpotNoiseParity : public testing::TestWithParam<std::tuple<ContextKind, ShaderPath>> {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(std::get<0>(GetParam()), reason);
    if (!context_) GTEST_SKIP() << reason;
    if (std::get<1>(GetParam()) == ShaderPath::compute && !context_->info().compute()) {
      GTEST_SKIP() << "compute shaders need OpenGL 4.3, and this is " << context_->info().version;
    }
  }

  Image draw(const Model& model, const Frame& frame, ShaderRequest request) {
    request.near = frame.origin;
    return Renderer(*context_, model.shader(request).value(), std::get<1>(GetParam())).draw(frame);
  }

  /// Largest difference of shader and processor, in the given units of each channel.
  double difference(const Texton& texton, const SpotNoiseOptions& options, Extent size, const Eigen::Vector2d& origin,
                    const ShaderRequest& request, const std::vector<double>& units) {
    const auto model = make_spot_noise(texton, options);
    const Image expected = model->synthesize({.size = size, .origin = {origin.x(), origin.y()}}, request.seed);
    return largest_difference(draw(*model, {.size = size, .origin = origin}, request), expected, units);
  }

  std::unique_ptr<Context> context_;
};

/// Kernels of one pixel and the values 1, 32, 1024: a pixel is a whole number, whose digits are the numbers of its
/// impacts. Cells of 8 to 10 impacts count arrivals, those of 10 to 32 reject candidates; some thousand cells of each.
TEST_P(SpotNoiseParity, ImpactsAreThoseOfTheProcessorBitForBit) {
  for (const int kernels : {1, 3}) {
    Texton texton = test_texton({1, 1}, 1, kernels);
    for (int k = 0; k < kernels; ++k)
      texton.kernels[static_cast<std::size_t>(k)].at(0, 0, 0) = std::exp2f(5.0F * static_cast<float>(k));
    texton.mean = {0};
    for (const Impacts impacts : {Impacts::poisson, Impacts::stratified}) {
      for (const double intensity : kernels == 1 ? std::vector{0.035, 0.1, 0.55, 3.9} : std::vector{0.1, 0.55}) {
        for (const Eigen::Vector2d& place : places) {
          for (const std::uint64_t seed : {1U, 2U}) {
            const double unit = std::sqrt(kernels / intensity);
            EXPECT_LE(difference(texton, {.impacts = impacts, .mni = intensity, .route = SpotRoute::direct}, {110, 90},
                                 place, {.seed = Seed{seed}}, {unit}),
                      0.02)
                << kernels << " kernels, " << static_cast<int>(impacts) << " of " << intensity << " near "
                << place.transpose() << " seed " << seed;
          }
        }
      }
    }
  }
}

/// 2^−24 of each of some ten impacts, of random signs or nearly so.
TEST_P(SpotNoiseParity, ValuesAreThoseOfTheProcessor) {
  constexpr double bound = 1e-5;
  for (const Texton& texton : {test_texton({9, 7}, 3, 1), test_texton({9, 7}, 6, 2), disc_texton(11, 3),
                               test_texton({40, 25}, 1, 1), test_texton({5, 30}, 8, 1)}) {
    for (const Impacts impacts : {Impacts::poisson, Impacts::stratified}) {
      for (const Eigen::Vector2d& place : places) {
        EXPECT_LE(difference(texton, {.impacts = impacts, .mni = 12, .route = SpotRoute::direct}, {53, 37}, place,
                             {.seed = Seed{9}}, deviations_of(texton)),
                  bound)
            << texton.extent().width << " " << static_cast<int>(impacts) << " near " << place.transpose();
      }
    }
  }
}

/// The spot of an exemplar: cells of many pixels, several times as many impacts drawn as reach a pixel.
TEST_P(SpotNoiseParity, TheSpotOfAnExemplar) {
  Exemplar exemplar{"noise", Image({128, 96}, 3), std::string(64, '0')};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 96; ++y)
      fill_normal(Stream(Seed{4}), static_cast<std::uint64_t>(c) * 96 + static_cast<std::uint64_t>(y), 0,
                  exemplar.pixels.row(c, y));
  }
  const MethodEntry& entry = find_method("dsn");
  for (const char* impacts : {"poisson", "stratified"}) {
    const auto model = entry.analyze({exemplar}, Params(entry.params, {{"impacts", std::string(impacts)}}), Seed{1});
    const Frame frame{.size = {70, 50}, .origin = {-300, 1000}};
    const Image expected = model->synthesize({.size = frame.size, .origin = {-300, 1000}}, Seed{2});
    EXPECT_LE(largest_difference(draw(*model, frame, {.seed = Seed{2}}), expected, {1, 1, 1}), 1e-5) << impacts;
    EXPECT_LE(largest_difference(draw(*model, frame, {.seed = Seed{2}, .half_float = true}), expected, {1, 1, 1}),
              1.0 / 200)
        << impacts;
    const Image one = draw(*model, frame, {.seed = Seed{2}, .channels = 1});
    EXPECT_LE(largest_difference(one, expected, {1}), 1e-5) << impacts;
  }
}

TEST_P(SpotNoiseParity, FramesBetweenPixelsAreRefused) {
  const auto model = make_spot_noise(test_texton({9, 7}, 1, 1), {.mni = 5});
  const auto expect_refusal = [&](const Frame& frame) {
    try {
      draw(*model, frame, {});
      ADD_FAILURE() << "drawn";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("whole points of the plane alone"));
    }
  };
  expect_refusal({.size = {8, 8}, .origin = {0.5, 0}});
  expect_refusal({.size = {8, 8}, .step = 2});
  expect_refusal({.size = {8, 8}, .supersampling = 2});
  Frame ground{.size = {8, 8}};
  ground.ground.emplace();
  expect_refusal(ground);
}

INSTANTIATE_TEST_SUITE_P(Contexts, SpotNoiseParity,
                         testing::Combine(testing::Values(ContextKind::egl, ContextKind::osmesa),
                                          testing::Values(ShaderPath::fragment, ShaderPath::compute)),
                         [](const auto& context) {
                           return std::string(context_name(std::get<0>(context.param))) +
                                  (std::get<1>(context.param) == ShaderPath::compute ? "_compute" : "_fragment");
                         });

}  // namespace textonbench::spot_noise_parity_test
