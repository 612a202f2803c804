#include "methods/spectral/adsn.h"

#include <gtest/gtest.h>

#include <complex>

#include "methods/base/spectrum.h"
#include "tests/texture.h"

namespace textonbench::adsn_test {

Domain torus(Extent size) { return {.size = size, .periodic = true}; }

TEST(Adsn, ModulusOverTheSpotsIsRayleigh) {
  // |Ŷ| / |p̂| has distribution 1 − exp(−r²) (mean sqrt(π)/2, variance 1 − π/4), half-normal on self-conjugate bins.
  for (const Extent extent : {Extent{16, 12}, Extent{15, 11}}) {
    const Exemplar exemplar = test_exemplar(extent, 3);
    const Spectrum p = forward_fft(periodic_component(exemplar.pixels));
    const auto model = fit_adsn(exemplar, {});
    std::vector<double> ratios;
    std::vector<double> real_ratios;
    for (std::uint64_t k = 0; k < 100; ++k) {
      const Spectrum y = forward_fft(model->synthesize(torus(extent), Seed{k}));
      for (int ky = 0; ky < y.rows(); ++ky) {
        for (int kx = ky == 0 ? 1 : 0; kx < y.columns(); ++kx) {
          const double ratio =
              std::abs(std::complex<double>(y.at(0, kx, ky))) / std::abs(std::complex<double>(p.at(0, kx, ky)));
          if (y.self_conjugate(kx, ky)) {
            real_ratios.push_back(ratio);
          } else if (y.multiplicity(kx) == 2 || ky <= y.rows() / 2) {
            ratios.push_back(ratio);
          }
        }
      }
    }
    // Thresholds of false-alarm rate 1e-6 each.
    EXPECT_LT(kolmogorov_distance(ratios, [](double r) { return 1 - std::exp(-r * r); }), 2.7);
    if (!real_ratios.empty()) {
      EXPECT_LT(kolmogorov_distance(real_ratios, [](double r) { return std::erf(r / std::sqrt(2.0)); }), 2.7);
    }
    double mean = 0;
    for (const double r : ratios) {
      mean += r / static_cast<double>(ratios.size());
    }
    EXPECT_NEAR(mean, 0.8862, 5 * std::sqrt(0.2146 / static_cast<double>(ratios.size())));
  }
}

TEST(Adsn, ChannelsShareOneNoise) {
  const Exemplar exemplar = test_exemplar({20, 14}, 3);
  const Spectrum p = forward_fft(periodic_component(exemplar.pixels));
  const Spectrum y = forward_fft(fit_adsn(exemplar, {})->synthesize(torus({20, 14}), Seed{1}));
  for (int ky = 0; ky < y.rows(); ++ky) {
    for (int kx = ky == 0 ? 1 : 0; kx < y.columns(); ++kx) {
      const auto first = y.at(0, kx, ky) / p.at(0, kx, ky);
      const auto third = y.at(2, kx, ky) / p.at(2, kx, ky);
      ASSERT_LT(std::abs(first - third), 2e-3F * (1 + std::abs(first))) << kx << " " << ky;
    }
  }
}

TEST(Adsn, OnThePlaneIsTheSumOverTheSpot) {
  // The defining sum, in double precision, from the white noise at whole coordinates.
  const Exemplar exemplar = test_exemplar({9, 7}, 3);
  const Image p = periodic_component(exemplar.pixels);
  const std::vector<double> mean = channel_means(p);
  const auto model = fit_adsn(exemplar, {});
  for (const Point2 origin : {Point2{0, 0}, Point2{-12, 5}, Point2{1e15, -3}}) {
    const Domain domain{.size = {14, 10}, .origin = origin};
    const Image sample = model->synthesize(domain, Seed{6});
    const Stream stream = Stream(Seed{6}).child("adsn").child("plane");
    const auto white = [&](std::int64_t x, std::int64_t y) {
      float value = 0;
      fill_normal(stream, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x) + (std::uint64_t{1} << 63U),
                  {&value, 1});
      return static_cast<double>(value);
    };
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 14; ++x) {
          double sum = 0;
          for (int j = 0; j < 7; ++j) {
            for (int i = 0; i < 9; ++i) {
              const double spot =
                  (static_cast<double>(p.at(c, i, j)) - mean[static_cast<std::size_t>(c)]) / std::sqrt(63);
              sum += spot *
                     white(static_cast<std::int64_t>(origin.x) + x - i, static_cast<std::int64_t>(origin.y) + y - j);
            }
          }
          ASSERT_NEAR(sample.at(c, x, y), mean[static_cast<std::size_t>(c)] + sum, 1e-6) << x << " " << y;
        }
      }
    }
  }
}

TEST(Adsn, SampleVarianceFluctuatesWhereRpnsDoesNot) {
  const Exemplar exemplar = test_exemplar({24, 24}, 1);
  const double target = color_covariance(gaussian_model(periodic_component(exemplar.pixels)).spectrum)(0, 0);
  const auto spread = [&](const MethodEntry& entry) {
    const auto model = entry.analyze({exemplar}, Params(entry.params, {}), Seed{1});
    double sum = 0;
    for (std::uint64_t k = 0; k < 50; ++k) {
      const Image sample = model->synthesize(torus({24, 24}), Seed{k});
      const double variance = color_covariance(gaussian_model(sample).spectrum)(0, 0);
      sum += (variance / target - 1) * (variance / target - 1) / 50;
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(spread(find_method("rpn")), 1e-5);
  EXPECT_GT(spread(find_method("adsn")), 0.03);
}

}  // namespace textonbench::adsn_test
