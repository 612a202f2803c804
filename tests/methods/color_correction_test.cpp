#include "methods/spot/color_correction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "methods/exemplar_spot.h"
#include "methods/spot/alternating_projections.h"
#include "methods/spot/texton_error.h"
#include "tests/texture.h"

namespace textonbench::color_correction_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr ColorCorrection maps[] = {ColorCorrection::authors, ColorCorrection::transport};

Eigen::MatrixXd random_covariance(std::uint64_t seed, int rank) {
  RandomSequence numbers(Stream(Seed{seed}));
  Eigen::MatrixXd factor(3, rank);
  for (double& value : factor.reshaped()) {
    value = numbers.normal();
  }
  return factor * factor.transpose();
}

TEST(ColorMap, GivesTheCovariance) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::MatrixXd a = random_covariance(seed, 3);
    for (const int rank : {1, 2, 3}) {
      const Eigen::MatrixXd b = random_covariance(100 + seed, rank);
      for (const ColorCorrection correction : maps) {
        const Eigen::MatrixXd k = color_map(a, b, correction);
        EXPECT_LT((k * a * k.transpose() - b).norm(), 1e-7 * b.norm());
      }
    }
  }
}

TEST(ColorMap, TransportIsSymmetricAndMovesColorsLeast) {
  // Mean squared movement E|Kx − x|² of x ~ N(0, A): the least there is, the Bures distance.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::MatrixXd a = random_covariance(seed, 3);
    const Eigen::MatrixXd b = random_covariance(100 + seed, 3);
    const auto movement = [&](ColorCorrection correction) {
      const Eigen::MatrixXd off = color_map(a, b, correction) - Eigen::MatrixXd::Identity(3, 3);
      return (off * a * off.transpose()).trace();
    };
    const Eigen::MatrixXd k = color_map(a, b, ColorCorrection::transport);
    EXPECT_LT((k - k.transpose()).norm(), 1e-7 * k.norm());
    EXPECT_NEAR(movement(ColorCorrection::transport), bures_distance_squared(a, b), 1e-7 * b.trace());
    EXPECT_GE(movement(ColorCorrection::authors), movement(ColorCorrection::transport) - 1e-9);
  }
}

TEST(ColorMap, OfTheSameCovarianceIsTheIdentity) {
  const Eigen::MatrixXd a = random_covariance(3, 3);
  for (const ColorCorrection correction : maps) {
    EXPECT_LT((color_map(a, a, correction) - Eigen::MatrixXd::Identity(3, 3)).norm(), 1e-8);
  }
  EXPECT_EQ(color_map(a, 2 * a, ColorCorrection::none), Eigen::MatrixXd::Identity(3, 3));
}

TEST(ColorMap, WorksInTheColorsThatThereAre) {
  // Both of rank one in the same direction, as gray stored as RGB: the map scales it and drops the rest.
  const Eigen::MatrixXd gray = Eigen::MatrixXd::Ones(3, 3);
  for (const ColorCorrection correction : maps) {
    const Eigen::MatrixXd k = color_map(gray, 4 * gray, correction);
    EXPECT_LT((k * gray * k.transpose() - 4 * gray).norm(), 1e-9);
    const Eigen::Vector3d dropped = k * Eigen::Vector3d(1, -1, 0);
    EXPECT_LT(dropped.norm(), 1e-9);
  }
}

TEST(ColorMap, RefusesWhatIsNoCovariance) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(3, 3);
  EXPECT_THAT([&] { color_map(Eigen::MatrixXd::Zero(3, 3), one, ColorCorrection::authors); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of trace 0 and 3")));
  EXPECT_THAT([&] { color_map(one, Eigen::MatrixXd::Identity(2, 2), ColorCorrection::authors); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of 3x3 and 2x2")));
  EXPECT_THROW(color_map(one, std::numeric_limits<double>::quiet_NaN() * one, ColorCorrection::transport),
               std::invalid_argument);
}

CorrectedTexton corrected_sot(const Image& exemplar, ColorCorrection correction) {
  const GaussianModel model = gaussian_model(exemplar);
  const Spectrum start = random_phase_start(model.spectrum.factors.front(), Seed{1});
  return correct_colors(alternate_projections(model, square_support(9), start, {}).texton, model.spectrum, correction);
}

TEST(CorrectColors, TextonGetsTheCovarianceAndBothErrorsAreReported) {
  for (const int channels : {1, 3}) {
    const Image exemplar = test_texture({40, 32}, channels);
    const CrossSpectrum target = gaussian_model(exemplar).spectrum;
    const double before = corrected_sot(exemplar, ColorCorrection::none).rme_after;
    for (const ColorCorrection correction : maps) {
      const CorrectedTexton result = corrected_sot(exemplar, correction);
      const Eigen::MatrixXd expected = color_covariance(target);
      EXPECT_LT((color_covariance(result.texton) - expected).norm(), 1e-6 * expected.norm());
      EXPECT_EQ(result.rme_before, before);
      EXPECT_EQ(result.rme_after, relative_model_error(result.texton, target));
      EXPECT_GT(result.rme_after, result.rme_before);
    }
  }
}

TEST(CorrectColors, GrayStoredAsRgbStaysGray) {
  const Image gray = test_texture({40, 32}, 1);
  Image stored({40, 32}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 32; ++y) {
      std::ranges::copy(gray.row(0, y), stored.row(c, y).begin());
    }
  }
  for (const ColorCorrection correction : maps) {
    const CorrectedTexton of_gray = corrected_sot(gray, correction);
    const CorrectedTexton result = corrected_sot(stored, correction);
    const Eigen::MatrixXd expected = color_covariance(gaussian_model(stored).spectrum);
    EXPECT_LT((color_covariance(result.texton) - expected).norm(), 1e-6 * expected.norm());
    EXPECT_NEAR(result.rme_after, of_gray.rme_after, 1e-4);
    const Image& kernel = result.texton.kernels.front();
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 9; ++x) {
        EXPECT_NEAR(kernel.at(0, x, y), kernel.at(1, x, y), 1e-7);
        EXPECT_NEAR(kernel.at(0, x, y), kernel.at(2, x, y), 1e-7);
      }
    }
  }
}

TEST(CorrectColors, SeveralKernelsShareOneMap) {
  const Image exemplar = test_texture({40, 32}, 3);
  const CrossSpectrum target = gaussian_model(exemplar).spectrum;
  Texton texton = corrected_sot(exemplar, ColorCorrection::none).texton;
  const Texton other = corrected_sot(test_texture({40, 32}, 3, 2), ColorCorrection::none).texton;
  texton.kernels.push_back(other.kernels.front());
  const CorrectedTexton result = correct_colors(texton, target, ColorCorrection::transport);
  const Eigen::MatrixXd expected = color_covariance(target);
  EXPECT_LT((color_covariance(result.texton) - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace textonbench::color_correction_test
