#include "methods/spot/filtered_sum.h"

#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/texton.h"

namespace textonbench::filtered_sum_test {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int supersampling = 20;

SplineTexton texton_of(Extent extent, int channels, int kernels) {
  return {.coefficients = test_texton(extent, channels, kernels),
          .order = 1,
          .support_area = (extent.width + 1.0) * (extent.height + 1.0)};
}

FilteredSum poisson_sum(const SplineTexton& texton) {
  return FilteredSum(texton, {.impacts = ImpactProcess::poisson, .mni = 10});
}

Matrix2d square(double size) { return size * Matrix2d::Identity(); }

/// Mean and variance of channel 0 at independent points: they lie farther apart than any kernel here is long.
struct Moments {
  double mean = 0, variance = 0;
};
Moments moments_of(int count, const std::function<double(const Vector2d&, std::vector<PlaneImpact>&)>& value) {
  std::vector<PlaneImpact> impacts;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const double found = value(Vector2d(211.3 * (i % 64), 197.7 * (i / 64)), impacts);
    sum += found;
    squares += found * found;
  }
  const double mean = sum / count;
  return {mean, squares / count - mean * mean};
}

Moments filtered_moments(const FilteredSum& noise, int count, double size, TextonFilter filter, ImpactWindow window) {
  const std::uint64_t key = spline_noise_key(Seed{4});
  return moments_of(count, [&](const Vector2d& p, std::vector<PlaneImpact>& impacts) {
    return noise.evaluate(p, square(size), filter, window, key, impacts)[0];
  });
}

/// Mean over a square of the plane of the unfiltered noise, as a supersampled pixel takes it.
double supersample(const FilteredSum& noise, const Vector2d& p, double size, std::uint64_t key,
                   std::vector<PlaneImpact>& impacts) {
  double sum = 0;
  for (int j = 0; j < supersampling; ++j) {
    for (int i = 0; i < supersampling; ++i) {
      const Vector2d offset((i + 0.5) / supersampling - 0.5, (j + 0.5) / supersampling - 0.5);
      sum +=
          noise.evaluate(p + size * offset, square(size), TextonFilter::none, ImpactWindow::footprint, key, impacts)[0];
    }
  }
  return sum / (supersampling * supersampling);
}

/// ∫ |α̂(f)|² |F(f1) F(f2)|² df of channel 0, the closed form of the variance behind a filter whose transform, that of
/// β^1 included, is F on each axis. |α̂|² has the lags of α alone, so sums at a spacing of 1/32 are its integral; F
/// falls as f^−4 at least, which leaves 1e-3 beyond |f| = 3.
double variance_behind(const Image& alpha, const std::function<double(double)>& transform) {
  constexpr int spacing = 32;
  constexpr int reach = 3 * spacing;
  double sum = 0;
  for (int ky = -reach; ky < reach; ++ky) {
    for (int kx = -reach; kx < reach; ++kx) {
      std::complex<double> spectrum = 0;
      for (int y = 0; y < alpha.height(); ++y) {
        for (int x = 0; x < alpha.width(); ++x) {
          spectrum +=
              std::polar(static_cast<double>(alpha.at(0, x, y)), -2 * std::numbers::pi * (kx * x + ky * y) / spacing);
        }
      }
      const double gain = transform(static_cast<double>(kx) / spacing) * transform(static_cast<double>(ky) / spacing);
      sum += std::norm(spectrum) * gain * gain;
    }
  }
  return sum / (spacing * spacing);
}

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

/// ∫ of the square of the filtered kernel over the grid of spacing 1/8: the variance of its noise.
double filtered_energy(const Image& alpha, TextonFilter filter, double size) {
  const MipChain chain(alpha);
  const KernelFilter filtered(filter, square(size), chain.coarsest());
  double sum = 0;
  for (int j = -320; j < 400; ++j) {
    for (int i = -320; i < 400; ++i) {
      const double value = filtered(chain, i / 8.0 + 0.0625, j / 8.0 + 0.0625)[0];
      sum += value * value / 64;
    }
  }
  return sum;
}

TEST(FilteredSum, UnfilteredItIsTheFieldOfTextonNoise) {
  for (const ImpactProcess process :
       {ImpactProcess::poisson, ImpactProcess::stratified, ImpactProcess::signed_poisson}) {
    const SplineTexton texton = texton_of({9, 6}, 3, 2);
    const SplineNoiseOptions options{.impacts = process, .mni = 6};
    const FilteredSum noise(texton, options);
    const std::vector<Point2> points{{0, 0}, {1.25, -7.5}, {-3e5, 4.125}, {1e9, -1e9}};
    std::vector<float> expected(3 * points.size());
    make_spline_noise(texton, options)->procedural()->evaluate(points, Seed{4}, expected);
    std::vector<PlaneImpact> impacts;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector4d found = noise.evaluate({points[i].x, points[i].y}, square(5), TextonFilter::none,
                                                   ImpactWindow::footprint, spline_noise_key(Seed{4}), impacts);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[c], expected[static_cast<std::size_t>(c) * points.size() + i], 2e-5);
      }
    }
  }
}

/// 4000 independent values: their mean is off by 5 standard errors with probability 6e-7.
TEST(FilteredSum, FiltersLeaveTheMean) {
  const SplineTexton texton = texton_of({9, 7}, 1, 1);
  const FilteredSum noise = poisson_sum(texton);
  for (const TextonFilter filter : {TextonFilter::trilinear, TextonFilter::anisotropic, TextonFilter::ewa}) {
    for (const double size : {2.0, 6.5}) {
      const Moments found = filtered_moments(noise, 4000, size, filter, ImpactWindow::footprint);
      EXPECT_NEAR(found.mean, texton.coefficients.mean[0], 5 * std::sqrt(found.variance / 4000)) << size;
    }
  }
}

/// The variance of the mean over 20 x 20 points of a square and that behind EWA, against Σ PSD |filter|². Of 6000
/// independent values of excess kurtosis below 1 the variance has a standard error of sqrt(3/6000) = 2.2 %; 5 of them
/// are left with probability 6e-7. EWA's Gaussian is cut, which takes 5 % of its own variance, V.
TEST(FilteredSum, VarianceUnderMinificationIsThatOfTheFilteredSpectrum) {
  const SplineTexton texton = texton_of({7, 6}, 1, 1);
  const Image& alpha = texton.coefficients.kernels.front();
  const FilteredSum noise = poisson_sum(texton);
  const std::uint64_t key = spline_noise_key(Seed{4});
  for (const double size : {2.0, 5.0}) {
    const double boxed = variance_behind(
        alpha, [&](double f) { return std::pow(sinc(f), 2) * sinc(size * f) / sinc(size * f / supersampling); });
    const Moments supersampled = moments_of(1500, [&](const Vector2d& p, std::vector<PlaneImpact>& impacts) {
      return supersample(noise, p, size, key, impacts);
    });
    EXPECT_NEAR(supersampled.variance / boxed, 1, 5 * std::sqrt(3.0 / 1500)) << size;

    const double gaussian = variance_behind(alpha, [&](double f) {
      return std::exp(-2 * std::pow(std::numbers::pi * f, 2) * (size * size / 12 + 1.0 / 6));
    });
    EXPECT_NEAR(filtered_energy(alpha, TextonFilter::ewa, size) / gaussian, 1, 0.04) << size;
    const Moments ewa = filtered_moments(noise, 6000, size, TextonFilter::ewa, ImpactWindow::footprint);
    EXPECT_NEAR(ewa.variance / gaussian, 1, 5 * std::sqrt(3.0 / 6000) + 0.04) << size;
    EXPECT_NEAR(gaussian / boxed, 1, 0.1) << "EWA stands for the mean over the pixel";
  }
}

/// Mip levels are no convolution of h: the closed form is ∫ of their squares. Standard errors as above.
TEST(FilteredSum, VarianceBehindTheMipChainIsThatOfItsKernel) {
  const SplineTexton texton = texton_of({7, 6}, 1, 1);
  const Image& alpha = texton.coefficients.kernels.front();
  const FilteredSum noise = poisson_sum(texton);
  double last = variance_behind(alpha, [](double f) { return std::pow(sinc(f), 2); });
  for (const double size : {1.0, 2.0, 3.3, 8.0}) {
    const double energy = filtered_energy(alpha, TextonFilter::trilinear, size);
    EXPECT_LE(energy, 1.001 * last) << "variance falls with minification";
    last = energy;
    const Moments found = filtered_moments(noise, 6000, size, TextonFilter::trilinear, ImpactWindow::footprint);
    EXPECT_NEAR(found.variance / energy, 1, 5 * std::sqrt(3.0 / 6000)) << size;
  }
}

/// Where the window is that of the unfiltered kernel the filtered one is cut: what it misses is lost to the variance,
/// and to the mean, as the constant that is taken off is that of the whole kernel. Limits are far beyond 5 standard
/// errors of the 2000 values.
TEST(FilteredSum, AWindowThatTheFootprintDoesNotEnlargeBiasesMeanAndVariance) {
  const SplineTexton texton = texton_of({9, 7}, 1, 1);
  const FilteredSum noise = poisson_sum(texton);
  for (const TextonFilter filter : {TextonFilter::anisotropic, TextonFilter::ewa}) {
    const Moments whole = filtered_moments(noise, 2000, 12, filter, ImpactWindow::footprint);
    const Moments cut = filtered_moments(noise, 2000, 12, filter, ImpactWindow::kernel);
    EXPECT_LT(cut.variance, 0.9 * whole.variance);
    EXPECT_LT(cut.mean, whole.mean - 10 * std::sqrt(whole.variance / 2000));
    const Moments unfiltered = filtered_moments(noise, 2000, 1, TextonFilter::anisotropic, ImpactWindow::kernel);
    EXPECT_NEAR(unfiltered.mean, texton.coefficients.mean[0], 5 * std::sqrt(unfiltered.variance / 2000));
  }
}

/// Filtered and supersampled values of the same impacts, for coefficients of white noise, which no filter spares. The
/// distances, in standard deviations of the noise, are known to some 5 % from 400 values.
TEST(FilteredSum, FiltersApproximateTheMeanOverThePixel) {
  const SplineTexton texton = texton_of({12, 12}, 1, 1);
  const FilteredSum noise = poisson_sum(texton);
  const std::uint64_t key = spline_noise_key(Seed{4});
  const double deviation =
      std::sqrt(filtered_moments(noise, 2000, 1, TextonFilter::none, ImpactWindow::footprint).variance);
  const auto error = [&](TextonFilter filter, double size) {
    const Moments distance = moments_of(400, [&](const Vector2d& p, std::vector<PlaneImpact>& impacts) {
      return noise.evaluate(p, square(size), filter, ImpactWindow::footprint, key, impacts)[0] -
             supersample(noise, p, size, key, impacts);
    });
    return std::sqrt(distance.variance) / deviation;
  };
  for (const double size : {1.0, 2.0, 4.0}) {
    const double unfiltered = error(TextonFilter::none, size);
    EXPECT_LT(error(TextonFilter::ewa, size), 0.12) << size;
    EXPECT_LT(error(TextonFilter::anisotropic, size), 0.3) << size;
    if (size > 1) {
      EXPECT_LT(1.5 * error(TextonFilter::anisotropic, size), unfiltered);
    }
  }
}

TEST(FilteredSum, RefusesWhatItCannotFilter) {
  SplineTexton cubic = texton_of({5, 5}, 1, 1);
  cubic.order = 3;
  EXPECT_THROW(FilteredSum(cubic, {}), std::invalid_argument);
  const FilteredSum noise = poisson_sum(texton_of({5, 5}, 1, 1));
  std::vector<PlaneImpact> impacts;
  const auto at = [&](const Vector2d& p, const Matrix2d& footprint) {
    noise.evaluate(p, footprint, TextonFilter::ewa, ImpactWindow::footprint, 1, impacts);
  };
  EXPECT_NO_THROW(at({0, 0}, square(1)));
  EXPECT_THROW(at({0, 0}, square(0)), std::invalid_argument);
  EXPECT_THROW(at({0, 0}, square(std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
  EXPECT_THROW(at({std::nan(""), 0}, square(1)), std::invalid_argument);
  EXPECT_THROW(at({0, 0x1p41}, square(1)), std::invalid_argument);
}

}  // namespace textonbench::filtered_sum_test
