#include "methods/spot/luminance_texton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "methods/spot/canonical_texton.h"
#include "methods/spot/color_correction.h"
#include "methods/spot/texton_error.h"
#include "methods/spot/zero_phase_texton.h"
#include "tests/texture.h"

namespace textonbench::luminance_texton_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr SpotSource periodic = SpotSource::periodic_component;

TEST(LuminanceTexton, OfTheWholeTorusHasTheExemplarsLaw) {
  for (const Extent extent : {Extent{32, 24}, Extent{31, 25}}) {
    const Exemplar exemplar = test_exemplar(extent, 3);
    const GaussianModel model = fit_spot(exemplar, periodic);
    const Texton texton = luminance_texton(exemplar, periodic, {}, rectangle_support(extent));
    EXPECT_LT(relative_model_error(texton, model.spectrum), 2e-6);
    const Autocovariance expected = autocovariance(model.spectrum);
    const Autocovariance actual = autocovariance(texton_spectrum(texton, extent));
    for (std::size_t i = 0; i < expected.planes.size(); ++i) {
      for (std::size_t k = 0; k < expected.planes[i].size(); ++k) {
        ASSERT_NEAR(actual.planes[i][k], expected.planes[i][k], 2e-6 * expected.planes[0][0]);
      }
    }
  }
}

TEST(LuminanceTexton, ItsLuminanceHasZeroPhase) {
  for (const LuminanceWeights& weights : {LuminanceWeights{}, LuminanceWeights{0.299, 0.587, 0.114}}) {
    const Image texton =
        luminance_texton(test_exemplar({32, 24}, 3), periodic, weights, rectangle_support({32, 24})).kernels.front();
    // Centered at (16, 12), half of even sides: the shift multiplies bin (kx, ky) by (−1)^(kx + ky).
    const Spectrum spectrum = forward_fft(texton);
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        std::complex<float> luminance = 0;
        for (const auto& [c, weight] : {std::pair{0, weights.red}, {1, weights.green}, {2, weights.blue}}) {
          luminance += static_cast<float>((kx + ky) % 2 == 0 ? weight : -weight) * spectrum.at(c, kx, ky);
        }
        EXPECT_NEAR(luminance.imag(), 0, 1e-6);
        EXPECT_GE(luminance.real(), -1e-6F);
      }
    }
  }
}

TEST(LuminanceTexton, OfAGrayExemplarIsTheCanonicalTexton) {
  const Exemplar gray = test_exemplar({32, 24}, 1);
  const Image canonical = canonical_texton(gray, periodic, square_support(15)).kernels.front();
  const Image luminance = luminance_texton(gray, periodic, {0.2, 0.3, 0.1}, square_support(15)).kernels.front();
  Exemplar stored = gray;
  stored.pixels = Image({32, 24}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 24; ++y) {
      std::ranges::copy(gray.pixels.row(0, y), stored.pixels.row(c, y).begin());
    }
  }
  const Image of_stored = luminance_texton(stored, periodic, {}, square_support(15)).kernels.front();
  for (int y = 0; y < 15; ++y) {
    for (int x = 0; x < 15; ++x) {
      EXPECT_EQ(luminance.at(0, x, y), canonical.at(0, x, y));
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(of_stored.at(c, x, y), canonical.at(0, x, y), 1e-7);
      }
    }
  }
}

TEST(LuminanceTexton, KeepsThePhasesWhereTheLuminanceVanishes) {
  // Red and green waves in opposition: L = 0 with weights 1, 1, 0, and any phase gives the law of the exemplar.
  Exemplar waves{"waves", Image({16, 16}, 3), ""};
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const auto wave = static_cast<float>(0.25 * std::sin(2 * 3.14159265358979 * (x + 2 * y) / 16.0));
      waves.pixels.at(0, x, y) = 0.5F + wave;
      waves.pixels.at(1, x, y) = 0.5F - wave;
    }
  }
  const GaussianModel model = fit_spot(waves, SpotSource::raw);
  const Texton texton = luminance_texton(waves, SpotSource::raw, {1, 1, 0}, rectangle_support({16, 16}));
  EXPECT_LT(relative_model_error(texton, model.spectrum), 2e-6);
  for (int x = 0; x < 16; ++x) {
    const double expected = 0.25 / 16 * std::sin(2 * 3.14159265358979 * (x - 8 - 16) / 16.0);
    EXPECT_NEAR(texton.kernels.front().at(0, x, 0), expected, 1e-6);
  }
}

TEST(LuminanceTexton, RefusesUselessWeights) {
  const Exemplar exemplar = test_exemplar({12, 10}, 3);
  for (const LuminanceWeights& weights :
       {LuminanceWeights{0, 0, 0}, LuminanceWeights{std::numeric_limits<double>::infinity(), 1, 1}}) {
    EXPECT_THAT([&] { luminance_texton(exemplar, periodic, weights, square_support(3)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("expected finite numbers, not all zero")));
  }
  EXPECT_THAT([&] { zero_phase_texton(fit_spot(exemplar, periodic), std::array{1.0}, square_support(3)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("3 channels with 1 weights")));
}

TEST(LuminanceTextonReference, ErrorsOfCroppedTextons) {
  const auto reference = folder_from("TEXTONBENCH_REFERENCE");
  const auto data = folder_from("TEXTONBENCH_DATA");
  if (!reference || !data) {
    GTEST_SKIP() << "set TEXTONBENCH_REFERENCE and TEXTONBENCH_DATA to compare with the authors' numbers";
  }
  const auto table = nlohmann::json::parse(std::ifstream(*reference / "sot_order0_rme.json"));
  const auto compare = [&](const auto& row, const Support& support) {
    const std::string name = row.at("name");
    const Exemplar exemplar{name, read_image(*data / (name + ".png")).image, ""};
    const GaussianModel model = fit_spot(exemplar, periodic);
    const auto corrected =
        correct_colors(luminance_texton(exemplar, periodic, {}, support), model.spectrum, ColorCorrection::authors);
    EXPECT_NEAR(corrected.rme_before, row.at("lum_crop").template get<double>(), 2e-5) << name;
    EXPECT_NEAR(corrected.rme_after, row.at("lum_crop_cc").template get<double>(), 2e-5) << name;
  };
  for (const auto& row : table.at("square31")) {
    compare(row, square_support(31));
  }
  for (const auto& row : table.at("radius")) {
    compare(row, disc_support(row.at("r").get<int>()));
  }
}

}  // namespace textonbench::luminance_texton_test
