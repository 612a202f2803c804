// Shaders of mixtures choose the kernels that the processor chooses, and their pixels are its values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <tuple>

#include "methods/spot/mixing.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::mixing_parity_test {

constexpr Extent size{53, 37};  // no multiple of a work group

struct Place {
  Eigen::Vector2d origin{-20.3, 11.7};
  double step = 1;
};

/// In standard deviations. A kernel that is not the processor's is off by more than a tenth.
constexpr double manual_bound = 1e-4;
constexpr double hardware_bound = 1.0 / 200;

Image random_map(Extent extent) {
  Image map(extent, 1);
  RandomSequence random(Stream(Seed{8}));
  for (int y = 0; y < extent.height; ++y) {
    for (float& v : map.row(0, y)) v = static_cast<float>(random.uniform());
  }
  return map;
}

/// Around a place, 30 pixels wide.
std::vector<PlaneShare> shares_near(const Place& place) {
  return {PlaneShare::uniform(0.3), PlaneShare::ramp(place.origin.x() + 4.3, 30),
          PlaneShare::map(random_map({45, 23}))};
}

class MixingParity : public testing::TestWithParam<std::tuple<ContextKind, ShaderPath>> {
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

  Image draw(const Model& model, const Frame& frame, ShaderRequest request) {
    request.near = frame.origin;
    return Renderer(*context_, model.shader(request).value(), path()).draw(frame);
  }

  double difference(const SplineTexton& texton, const SplineNoiseOptions& options, const Place& place,
                    const ShaderRequest& request) {
    const auto model = make_spline_noise(texton, options);
    const Image frame = draw(*model, {.size = size, .origin = place.origin, .step = place.step}, request);
    const Image expected = model->synthesize(
        {.size = size, .origin = {place.origin.x(), place.origin.y()}, .step = place.step}, request.seed);
    return largest_difference(frame, expected, deviations(texton));
  }

  std::unique_ptr<Context> context_;
};

TEST_P(MixingParity, KernelsOfEveryShare) {
  for (const ImpactProcess process : {ImpactProcess::stratified, ImpactProcess::signed_poisson}) {
    for (const Place& place : {Place{}, Place{{0x1p35 + 0.625, -0x1p35}, 0.37}, Place{{-7, -3.25}, 3}}) {
      for (const PlaneShare& share : shares_near(place)) {
        for (const std::uint64_t seed : {1U, 2U}) {
          SCOPED_TRACE(testing::Message() << static_cast<int>(process) << " at step " << place.step << " share "
                                          << static_cast<int>(share.kind()) << " seed " << seed);
          const SplineNoiseOptions options{.impacts = process, .mni = 5, .share = share};
          EXPECT_LE(
              difference(shader_texton(1, 3, 7), options, place, {.seed = Seed{seed}, .fetch = ShaderFetch::manual}),
              manual_bound);
        }
      }
    }
  }
}

TEST_P(MixingParity, OrdersChannelsAndFetches) {
  const SplineNoiseOptions options{.impacts = ImpactProcess::stratified, .mni = 5, .share = PlaneShare::ramp(-30, 70)};
  const ShaderRequest manual{.seed = Seed{3}, .fetch = ShaderFetch::manual};
  EXPECT_LE(difference(shader_texton(0, 1, 2), options, {}, manual), manual_bound);
  EXPECT_LE(difference(shader_texton(3, 6, 4), options, {}, manual), manual_bound);
  EXPECT_LE(difference(shader_texton(1, 3, 21), options, {}, {.seed = Seed{3}}), hardware_bound);
  EXPECT_LE(difference(shader_texton(3, 3, 5), options, {}, {.seed = Seed{3}}), hardware_bound);
}

/// Kernels of one pixel that are their own numbers, 256 of them in five pixels: the sums of a pixel are whole numbers,
/// and one of another kernel would be off by 1.
TEST_P(MixingParity, BordersOfKernelsAreThoseOfTheProcessor) {
  constexpr int kernels = 256;
  SplineTexton texton{.coefficients = test_texton({1, 1}, 1, kernels), .order = 0, .support_area = 1};
  for (int k = 0; k < kernels; ++k) {
    texton.coefficients.kernels[static_cast<std::size_t>(k)].at(0, 0, 0) = static_cast<float>(k);
  }
  texton.coefficients.mean = {0};
  for (const double far : {0.0, 0x1p20 + 0.3, -0x1p39}) {
    for (const PlaneShare& share : {PlaneShare::ramp(far + 1.7, 5), PlaneShare::map(random_map({9, 64}))}) {
      const SplineNoiseOptions options{.impacts = ImpactProcess::stratified, .mni = 16, .share = share};
      const auto model = make_spline_noise(texton, options);
      const Frame frame{.size = {10, 64}, .origin = {std::floor(far), 0}};
      const Image drawn = draw(*model, frame, {.seed = Seed{5}, .fetch = ShaderFetch::manual});
      const Image expected = model->synthesize({.size = frame.size, .origin = {frame.origin.x(), 0}}, Seed{5});
      EXPECT_LE(largest_difference(drawn, expected, {0.25}), 0.1) << far;  // a unit is the scale 1/4
    }
  }
}

/// Of a uniform share all impacts take one kernel: frames are those of the noise of that kernel, filters included.
TEST_P(MixingParity, FiltersAreThoseOfTextonNoise) {
  const SplineTexton texton = shader_texton(1, 3, 5);
  SplineTexton single = texton;
  single.coefficients.kernels = {texton.coefficients.kernels[3]};
  const SplineNoiseOptions alone{.impacts = ImpactProcess::stratified, .mni = 5};
  SplineNoiseOptions mixed = alone;
  mixed.share = PlaneShare::uniform(0.7);  // 2.8 of 4
  const auto mixture = make_spline_noise(texton, mixed);
  const auto noise = make_spline_noise(single, alone);
  for (const ShaderFilter filter : {ShaderFilter::mipmap, ShaderFilter::trilinear, ShaderFilter::anisotropic}) {
    const ShaderRequest request{.seed = Seed{4}, .fetch = ShaderFetch::manual, .filter = filter};
    for (const bool on_ground : {false, true}) {
      Frame frame{.size = {40, 30}, .origin = {3, 4}, .step = 2.5};
      if (on_ground) frame.ground.emplace();
      EXPECT_LE(largest_difference(draw(*mixture, frame, request), draw(*noise, frame, request), deviations(single)),
                1e-5);
    }
  }
}

Exemplar exemplar_of(std::uint64_t seed, float level) {
  Exemplar exemplar{"noise", Image({24, 20}, 3), std::string(64, '0')};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 20; ++y) {
      const auto row = exemplar.pixels.row(c, y);
      fill_normal(Stream(Seed{seed}).child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0, row);
      for (float& v : row) v = level + 0.1F * v;
    }
  }
  return exemplar;
}

/// Of the whole method, whose mean moves too; deviations are a tenth.
TEST_P(MixingParity, MeansMoveWithTheShare) {
  const Exemplar first = exemplar_of(1, 0.2F), second = exemplar_of(2, 0.8F);
  const MethodEntry& entry = find_method("mixing");
  for (const auto& [name, value] : {std::pair{"share", 0.3}, std::pair{"start", 11.4}}) {
    const Params params(entry.params, {{"support", std::int64_t{9}},
                                       {"kernels", std::int64_t{4}},
                                       {"iterations", std::int64_t{2}},
                                       {"length", 25.0},
                                       {name, value}});
    const auto model = entry.analyze({first, &second}, params, Seed{1});
    const Image expected = model->synthesize({.size = size, .origin = {-3.5, 2}, .step = 0.9}, Seed{6});
    const Frame frame{.size = size, .origin = {-3.5, 2}, .step = 0.9};
    EXPECT_LE(largest_difference(draw(*model, frame, {.seed = Seed{6}, .fetch = ShaderFetch::manual}), expected,
                                 {0.1, 0.1, 0.1}),
              manual_bound)
        << name;
    const Image two = draw(*model, frame, {.seed = Seed{6}, .fetch = ShaderFetch::manual, .channels = 2});
    EXPECT_LE(largest_difference(two, expected, {0.1, 0.1}), manual_bound) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Contexts, MixingParity,
                         testing::Combine(testing::Values(ContextKind::egl, ContextKind::osmesa),
                                          testing::Values(ShaderPath::fragment, ShaderPath::compute)),
                         [](const auto& context) {
                           return std::string(context_name(std::get<0>(context.param))) +
                                  (std::get<1>(context.param) == ShaderPath::compute ? "_compute" : "_fragment");
                         });

}  // namespace textonbench::mixing_parity_test
