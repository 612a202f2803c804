// Frames have the law that their model promises.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <map>
#include <memory>
#include <string>

#include "methods/base/fft.h"
#include "methods/base/spectrum.h"
#include "methods/method.h"
#include "methods/spot/spot_noise.h"
#include "tests/gpu/texton_shader.h"
#include "tests/texture.h"

namespace textonbench::frame_spectrum_test {

constexpr Extent size{20, 16};
constexpr int frames = 1500;

/// Expectation of the periodogram |Z|²/|Ω| of a window: the DFT of Γ(v) times the window's own autocorrelation. `grid`
/// is at least twice the support of Γ.
Spectrum expected_periodogram(const Gaussian& law, Extent grid = {2 * (size.width + 10), 2 * (size.height + 10)}) {
  const auto [w, h] = size;
  const CrossSpectrum p = law.spectrum(grid);
  const Autocovariance gamma = autocovariance(p);
  double constant = 0;  // autocovariance() leaves ξ = 0 out
  for (const Spectrum& factor : p.factors) {
    constant += std::norm(std::complex<double>(factor.at(0, 0, 0))) / static_cast<double>(grid.area());
  }
  Image lags(size, 1);
  for (int vy = 1 - h; vy < h; ++vy) {
    for (int vx = 1 - w; vx < w; ++vx) {
      const double taper = (1 - std::abs(vx) / double(w)) * (1 - std::abs(vy) / double(h));
      lags.at(0, (vx + w) % w, (vy + h) % h) += static_cast<float>(taper * (gamma.at(0, 0, vx, vy) + constant));
    }
  }
  return forward_fft(lags);
}

/// Frames of a recipe that no impact has in common, from one seed. Averages of 1500 squares of nearly Gaussian numbers
/// leave 7 standard errors with probability below 1e-9 each (their skewness included), so a false alarm at one of the
/// 176 frequencies has probability below 1e-6 / 2.
void expect_periodogram(Context& context, const ShaderRecipe& recipe, double mean, const Spectrum& expected,
                        double apart = 64) {
  Renderer renderer(context, recipe, context.info().compute() ? ShaderPath::compute : ShaderPath::fragment);
  const int bins = size.width / 2 + 1;
  std::vector<double> sums(static_cast<std::size_t>(bins * size.height));
  std::vector<double> squares(sums.size());
  for (int k = 0; k < frames; ++k) {
    Image frame = renderer.draw({.size = size, .origin = apart * Eigen::Vector2d(k % 40, static_cast<int>(k / 40))});
    for (int y = 0; y < size.height; ++y) {
      for (float& v : frame.row(0, y)) v -= static_cast<float>(mean);
    }
    const Spectrum z = forward_fft(frame);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const int kx = static_cast<int>(i) % bins;
      const double power =
          std::norm(std::complex<double>(z.at(0, kx, static_cast<int>(i) / bins))) / static_cast<double>(size.area());
      sums[i] += power;
      squares[i] += power * power;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double average = sums[i] / frames;
    const double error = std::sqrt((squares[i] / frames - average * average) / frames);
    const auto kx = static_cast<int>(i) % bins;
    EXPECT_NEAR(average, expected.at(0, kx, static_cast<int>(i) / bins).real(), 7 * error)
        << kx << " " << static_cast<int>(i) / bins;
  }
}

class FrameSpectrum : public testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    context_ = test_context(ContextKind::egl, reason);
    if (!context_) GTEST_SKIP() << reason;
  }

  std::unique_ptr<Context> context_;
};

TEST_F(FrameSpectrum, OfTextonNoiseIsTheClosedForm) {
  for (const ImpactProcess process : {ImpactProcess::poisson, ImpactProcess::stratified}) {
    SCOPED_TRACE(static_cast<int>(process));
    const auto model = make_spline_noise(shader_texton(1, 1, 2), {.impacts = process, .mni = 15});
    expect_periodogram(*context_, model->shader({.seed = Seed{3}}).value(), model->gaussian()->mean()[0],
                       expected_periodogram(*model->gaussian()));
  }
}

TEST_F(FrameSpectrum, OfSpotNoiseIsTheClosedForm) {
  for (const Impacts impacts : {Impacts::poisson, Impacts::stratified}) {
    SCOPED_TRACE(static_cast<int>(impacts));
    const auto model = make_spot_noise(test_texton({9, 7}, 1, 2), {.impacts = impacts, .mni = 15});
    expect_periodogram(*context_, model->shader({.seed = Seed{3}}).value(), model->gaussian()->mean()[0],
                       expected_periodogram(*model->gaussian()));
  }
}

/// Where the share is the same everywhere a mixture has the law of the noise of one kernel.
TEST_F(FrameSpectrum, OfAUniformMixtureIsThatOfItsKernel) {
  const SplineTexton texton = shader_texton(1, 1, 5);
  SplineTexton single = texton;
  single.coefficients.kernels = {texton.coefficients.kernels[1]};
  const auto mixture = make_spline_noise(
      texton, {.impacts = ImpactProcess::signed_poisson, .mni = 15, .share = PlaneShare::uniform(0.3)});
  const auto law = make_spline_noise(single, {.impacts = ImpactProcess::signed_poisson, .mni = 15});
  expect_periodogram(*context_, mixture->shader({.seed = Seed{3}}).value(), law->gaussian()->mean()[0],
                     expected_periodogram(*law->gaussian()));
}

/// A model of gray by its method's name.
std::unique_ptr<Model> gray_model(const char* name, const std::map<std::string, ParamValue>& given) {
  const MethodEntry& method = find_method(name);
  const Exemplar exemplar{.name = "test", .pixels = test_texture({32, 32}, 1), .sha256 = ""};
  return method.analyze({.exemplar = exemplar}, Params(method.params, given), Seed{1});
}

/// On the plane it has the law of texton noise (Proposition 3: mean and variance).
TEST_F(FrameSpectrum, OfSurfaceNoiseIsTheClosedForm) {
  for (const char* impacts : {"poisson", "stratified"}) {
    SCOPED_TRACE(impacts);
    const auto model = gray_model(
        "surface_noise",
        {{"surface", std::string("plane")}, {"support", std::int64_t{7}}, {"impacts", std::string(impacts)}});
    expect_periodogram(*context_, model->shader({.seed = Seed{3}}).value(), model->gaussian()->mean()[0],
                       expected_periodogram(*model->gaussian()));
  }
}

TEST_F(FrameSpectrum, OfGaborNoiseIsTheClosedForm) {
  const auto model = gray_model("gabor", {{"frequency", 0.2}, {"bandwidth", 0.2}});
  expect_periodogram(*context_, model->shader({.seed = Seed{3}}).value(), model->gaussian()->mean()[0],
                     expected_periodogram(*model->gaussian(), {128, 128}));
}

TEST_F(FrameSpectrum, OfLocalRandomPhaseIsTheClosedForm) {
  const auto model = gray_model("lrp", {{"cosines", std::int64_t{8}}});
  expect_periodogram(*context_, model->shader({.seed = Seed{3}}).value(), model->gaussian()->mean()[0],
                     expected_periodogram(*model->gaussian(), {512, 512}), 500);
}

}  // namespace textonbench::frame_spectrum_test
