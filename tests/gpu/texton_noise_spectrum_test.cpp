// Frames of texton noise have the law that the model promises.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "methods/base/fft.h"
#include "methods/base/spectrum.h"
#include "methods/method.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::texton_noise_spectrum_test {

constexpr Extent size{20, 16};
constexpr int frames = 1500;

/// Expectation of the periodogram |Z|²/|Ω| of a window: the DFT of Γ(v) times the window's own autocorrelation.
Spectrum expected_periodogram(const Gaussian& law) {
  const auto [w, h] = size;
  const Extent grid{2 * (w + 10), 2 * (h + 10)};
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

/// Frames that no impact has in common, from one seed. Averages of 1500 squares of nearly Gaussian numbers leave 7
/// standard errors with probability below 1e-9 each (their skewness included), so a false alarm at one of the 2 x 176
/// frequencies has probability below 1e-6.
TEST(TextonNoiseSpectrum, AveragedPeriodogramOfFramesIsTheClosedForm) {
  std::string reason;
  const auto context = test_context(ContextKind::egl, reason);
  if (!context) GTEST_SKIP() << reason;
  for (const ImpactProcess process : {ImpactProcess::poisson, ImpactProcess::stratified}) {
    SCOPED_TRACE(static_cast<int>(process));
    const SplineTexton texton = shader_texton(1, 1, 2);
    const auto model = make_spline_noise(texton, {.impacts = process, .mni = 15});
    const double mean = model->gaussian()->mean()[0];
    const Spectrum expected = expected_periodogram(*model->gaussian());
    Renderer renderer(*context, model->shader({.seed = Seed{3}}).value(), ShaderPath::fragment);
    const int bins = size.width / 2 + 1;
    std::vector<double> sums(static_cast<std::size_t>(bins * size.height));
    std::vector<double> squares(sums.size());
    for (int k = 0; k < frames; ++k) {
      Image frame = renderer.draw({.size = size, .origin = Eigen::Vector2d(64 * (k % 40), 64 * (k / 40))});
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
}

}  // namespace textonbench::texton_noise_spectrum_test
