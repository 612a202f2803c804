// Exemplars of more than three channels: textons, their law and their samples against sums over all channels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <cstdlib>

#include "methods/base/bspline.h"
#include "methods/base/spectrum.h"
#include "methods/method.h"
#include "methods/spot/color_correction.h"
#include "methods/spot/spline_noise.h"
#include "methods/spot/spot_noise.h"
#include "methods/spot/texton_error.h"
#include "methods/spot/texton_noise.h"
#include "tests/texture.h"

namespace textonbench::stack_test {

using testing::HasSubstr;

std::unique_ptr<Model> fit(const std::string& method, const Exemplar& exemplar,
                           const std::map<std::string, ParamValue>& given) {
  const MethodEntry& entry = find_method(method);
  return entry.analyze({exemplar}, Params(entry.params, given), Seed{1});
}

struct Case {
  std::string method;
  int channels;
  std::map<std::string, ParamValue> params;
};

/// Every method that sums kernels, projections and direct descents, at orders 0 to 5.
std::vector<Case> kernel_cases() {
  const ParamValue small = std::int64_t{5};
  std::vector<Case> cases;
  for (const int channels : {5, 8}) {
    cases.push_back({"dsn", channels, {}});
    cases.push_back({"sot", channels, {{"support", small}}});
    cases.push_back({"sot", channels, {{"support", small}, {"initialization", "white"}}});
    cases.push_back({"optimal_texton", channels, {{"support", small}, {"kernels", std::int64_t{2}}}});
    for (std::int64_t order = 0; order <= max_bspline_order; ++order) {
      for (const char* route : {"projections", "direct"}) {
        cases.push_back({"texton_noise", channels, {{"support", small}, {"order", order}, {"fit", route}}});
      }
    }
  }
  return cases;
}

std::string name_of(const Case& one) {
  std::string name = one.method + " of " + std::to_string(one.channels);
  for (const auto& [key, value] : one.params) name += ", " + key + " " + to_string(value);
  return name;
}

int order_of(const Model& model) { return model.spline_texton() == nullptr ? 0 : model.spline_texton()->order; }
const Texton& texton_of(const Model& model) {
  return model.spline_texton() == nullptr ? *model.texton() : model.spline_texton()->coefficients;
}

Texton one_channel(const Texton& texton, int channel) {
  Texton alone{{}, texton.support_pixels, {texton.mean[static_cast<std::size_t>(channel)]}};
  for (const Image& kernel : texton.kernels) {
    Image& plane = alone.kernels.emplace_back(kernel.extent(), 1);
    for (int y = 0; y < kernel.height(); ++y) std::ranges::copy(kernel.row(channel, y), plane.row(0, y).begin());
  }
  return alone;
}

/// b(j) of the B-spline of that order, 0 beyond.
double overlap(int order, int lag) {
  const std::span<const double> b = bspline_autocorrelation(order);
  const auto i = static_cast<std::size_t>(std::abs(lag));
  return i < b.size() ? b[i] : 0;
}

/// Γ_cd(v) = Σ_k Σ_{i, j} α_kc(i) α_kd(j) b(v − i + j): the covariance by its definition.
double covariance(const Texton& texton, int order, int c, int d, int vx, int vy) {
  double sum = 0;
  for (const Image& kernel : texton.kernels) {
    for (int iy = 0; iy < kernel.height(); ++iy) {
      for (int jy = 0; jy < kernel.height(); ++jy) {
        const double by = overlap(order, vy - iy + jy);
        if (by == 0) continue;
        for (int ix = 0; ix < kernel.width(); ++ix) {
          for (int jx = 0; jx < kernel.width(); ++jx) {
            sum += static_cast<double>(kernel.at(c, ix, iy)) * kernel.at(d, jx, jy) * overlap(order, vx - ix + jx) * by;
          }
        }
      }
    }
  }
  return sum;
}

/// Σ_k Σ_i α_kc(i) Σ_j α_kd(j), the cross-spectrum at ξ = 0, which autocovariance() leaves out.
double at_zero_frequency(const Texton& texton, int c, int d) {
  double sum = 0;
  for (const Image& kernel : texton.kernels) {
    const std::vector<double> means = channel_means(kernel);
    sum += means[static_cast<std::size_t>(c)] * means[static_cast<std::size_t>(d)] *
           std::pow(static_cast<double>(kernel.extent().area()), 2);
  }
  return sum;
}

/// Bound: float32 transforms of 40 x 40, in units of the largest variance.
TEST(Stack, TheLawOfTheModelIsThatOfAllPairsOfChannels) {
  for (const Case& one : kernel_cases()) {
    if (one.method == "dsn") continue;  // the sum over its whole spot takes too long; dsn_test holds its law to adsn's
    const auto model = fit(one.method, test_exemplar({24, 20}, one.channels), one.params);
    constexpr Extent torus{40, 40};
    const Autocovariance law = autocovariance(model->gaussian()->spectrum(torus));
    ASSERT_EQ(law.channels, one.channels);
    double largest = 0;
    for (int c = 0; c < one.channels; ++c) largest = std::max(largest, law.at(c, c, 0, 0));
    for (int c = 0; c < one.channels; ++c) {
      for (int d = 0; d < one.channels; d += 2) {
        const double constant = at_zero_frequency(texton_of(*model), c, d) / static_cast<double>(torus.area());
        for (const auto& [vx, vy] : {std::pair{0, 0}, {2, -1}, {-3, 1}}) {
          const double wanted = covariance(texton_of(*model), order_of(*model), c, d, vx, vy) - constant;
          EXPECT_NEAR(law.at(c, d, vx, vy), wanted, 3e-6 * largest) << name_of(one) << ": " << c << ' ' << d;
        }
      }
    }
  }
}

/// Impacts are those of the texton and not of its channels, so maps stay in place against each other. The bound is for
/// routes that sum in another order: that of Procedural::evaluate, in units of the channel's deviation.
TEST(Stack, AChannelIsTheNoiseOfItsOwnKernelAlone) {
  const Domain window{.size = {31, 26}, .origin = {-7, 12}};
  for (const Case& one : kernel_cases()) {
    const auto model = fit(one.method, test_exemplar({24, 20}, one.channels), one.params);
    const Image stack = model->synthesize(window, Seed{4});
    ASSERT_EQ(stack.channels(), one.channels);
    const Eigen::MatrixXd colors = color_covariance(model->gaussian()->spectrum({40, 40}));
    const MethodEntry& entry = find_method(one.method);
    const Params params(entry.params, one.params);
    for (const int c : {0, 3, one.channels - 1}) {
      const Texton alone = one_channel(texton_of(*model), c);
      const SplineTexton* spline = model->spline_texton();
      const auto noise = spline == nullptr ? make_spot_noise(alone, spot_noise_options(params, alone.support_pixels))
                                           : make_spline_noise({alone, spline->order, spline->support_area},
                                                               spline_noise_options(params));
      const Image plane = noise->synthesize(window, Seed{4});
      double error = 0;
      for (int y = 0; y < window.size.height; ++y) {
        for (int x = 0; x < window.size.width; ++x) {
          error = std::max(error, std::fabs(double{stack.at(c, x, y)} - plane.at(0, x, y)));
        }
      }
      EXPECT_LT(error, 1e-5 * std::max(1.0, std::sqrt(colors(c, c)))) << name_of(one) << ": " << c;
    }
  }
}

/// Γ(0) of the texton is that of the exemplar, all channels with all.
TEST(Stack, ColorCorrectionRestoresTheWholeCovariance) {
  for (const int channels : {5, 8}) {
    const Exemplar exemplar = test_exemplar({48, 40}, channels);
    const Eigen::MatrixXd wanted = color_covariance(gaussian_model(periodic_component(exemplar.pixels)).spectrum);
    for (const char* correction : {"none", "authors", "transport", "constrained"}) {
      const bool constrained = std::string(correction) == "constrained";
      const auto model = fit("texton_noise", exemplar,
                             {{"support", std::int64_t{7}},
                              {"color_correction", correction},
                              {"fit", constrained ? "direct" : "projections"}});
      const double error = (color_covariance(texton_of(*model), order_of(*model)) - wanted).norm() / wanted.norm();
      if (std::string(correction) == "none") {
        EXPECT_GT(error, 1e-3) << channels;
      } else {
        EXPECT_LT(error, 1e-5) << channels << ' ' << correction;
      }
    }
  }
}

/// RME² = Σ_ξ min_φ |T − e^{iφ} ĥ|² / Σ |T|², and the least is |T|² + |ĥ|² − 2 |T* ĥ|: one phase for all channels.
TEST(Stack, TheRelativeErrorTakesOnePhaseForAllChannels) {
  const Exemplar exemplar = test_exemplar({24, 20}, 8);
  const auto model = fit("sot", exemplar, {{"support", std::int64_t{5}}});
  const GaussianModel target = gaussian_model(periodic_component(exemplar.pixels));
  const Spectrum& t = target.spectrum.factors.front();
  const CrossSpectrum of_texton = texton_spectrum(*model->texton(), {24, 20});
  const Spectrum& h = of_texton.factors.front();
  double squares = 0, energy = 0;
  for (int ky = 0; ky < t.rows(); ++ky) {
    for (int kx = 0; kx < t.columns(); ++kx) {
      if (kx == 0 && ky == 0) continue;
      std::complex<double> product = 0;
      double of_t = 0, of_h = 0;
      for (int c = 0; c < 8; ++c) {
        const std::complex<double> a = t.at(c, kx, ky), b = h.at(c, kx, ky);
        product += std::conj(a) * b;
        of_t += std::norm(a);
        of_h += std::norm(b);
      }
      squares += t.multiplicity(kx) * (of_t + of_h - 2 * std::abs(product));
      energy += t.multiplicity(kx) * of_t;
    }
  }
  EXPECT_NEAR(relative_model_error(*model->texton(), target.spectrum), std::sqrt(squares / energy), 1e-5);
}

/// ŷ_c = t̂_c ŵ with one ŵ for all channels: the phases that channels have to each other are those of the exemplar.
TEST(Stack, SpectralNoisesKeepThePhasesBetweenChannels) {
  for (const char* method : {"rpn", "adsn"}) {
    const Exemplar exemplar = test_exemplar({24, 20}, 8);
    const Spectrum t = forward_fft(periodic_component(exemplar.pixels));
    const auto model = fit(method, exemplar, {});
    const Spectrum y = forward_fft(model->synthesize({.size = {24, 20}, .periodic = true}, Seed{2}));
    double largest = 0;
    for (int ky = 0; ky < t.rows(); ++ky) {
      for (int kx = 0; kx < t.columns(); ++kx) {
        if (kx == 0 && ky == 0) continue;
        for (int c = 0; c < 8; ++c) largest = std::max(largest, double{std::norm(t.at(c, kx, ky))});
      }
    }
    for (int ky = 0; ky < t.rows(); ++ky) {
      for (int kx = ky == 0 ? 1 : 0; kx < t.columns(); ++kx) {
        for (int c = 0; c < 7; ++c) {
          EXPECT_LT(std::abs(y.at(c, kx, ky) * t.at(7, kx, ky) - y.at(7, kx, ky) * t.at(c, kx, ky)), 2e-5 * largest)
              << method << ' ' << c;
        }
      }
    }
  }
}

TEST(Stack, MethodsOfGrayOrLuminanceRefuseItWithTheReason) {
  const Exemplar exemplar = test_exemplar({24, 20}, 4);
  for (const char* method : {"canonical_texton", "luminance_texton"}) {
    const MethodEntry& entry = find_method(method);
    const auto reason =
        entry.refuses({exemplar}, Params(entry.params, {{"support", std::int64_t{5}}}), {.size = {24, 20}});
    ASSERT_TRUE(reason.has_value()) << method;
    EXPECT_THAT(*reason, testing::AllOf(HasSubstr("\"test_texture\" has 4 channels"), HasSubstr("sot serves stacks")));
  }
}

}  // namespace textonbench::stack_test
