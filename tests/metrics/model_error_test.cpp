#include "experiments/metrics/model_error.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::model_error_test {

constexpr Domain anywhere{.size = {8, 8}, .periodic = true};

/// A model of a given law that cannot be sampled.
class LawOnly : public Model, public Gaussian {
 public:
  explicit LawOnly(CrossSpectrum law) : law_(std::move(law)) {}
  Image synthesize(const Domain& domain, Seed) const override { return {domain.size, law_.channels()}; }
  const Gaussian* gaussian() const override { return this; }
  Footprint footprint(const Domain&) const override { return {}; }
  std::vector<double> mean() const override { return std::vector<double>(static_cast<std::size_t>(law_.channels())); }
  CrossSpectrum spectrum(Extent grid) const override {
    EXPECT_EQ(grid, law_.grid());
    return law_;
  }

 private:
  CrossSpectrum law_;
};

class Lawless : public Model {
 public:
  Image synthesize(const Domain& domain, Seed) const override { return {domain.size, 3}; }
  Footprint footprint(const Domain&) const override { return {}; }
};

CrossSpectrum scaled(CrossSpectrum p, float factor) {
  for (Spectrum& spot : p.factors) {
    for (int c = 0; c < spot.channels(); ++c) {
      for (int ky = 0; ky < spot.rows(); ++ky) {
        for (auto& bin : spot.row(c, ky)) bin *= factor;
      }
    }
  }
  return p;
}

/// Spot of a white noise image, of about the same energy as smooth_exemplar.
CrossSpectrum white_law(Extent grid, int factors, std::uint64_t seed) {
  CrossSpectrum law;
  for (int k = 0; k < factors; ++k) {
    law.factors.push_back(
        scaled(gaussian_model(white_noise(grid, 3, seed + static_cast<std::uint64_t>(k))).spectrum, 0.08F)
            .factors.front());
  }
  return law;
}

/// Covariance of all pixels and channels of the circular field W * t summed over the factors' spots t, by its
/// definition: the field is a linear map of W.
Eigen::MatrixXd dense_covariance(const CrossSpectrum& law) {
  const Extent grid = law.grid();
  const Eigen::Index n = grid.area();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (const Spectrum& factor : law.factors) {
    const Image spot = inverse_fft(factor);
    Eigen::MatrixXd map(3 * n, n);
    for (int c = 0; c < 3; ++c) {
      for (int to = 0; to < grid.area(); ++to) {
        for (int from = 0; from < grid.area(); ++from) {
          const int x = (to % grid.width - from % grid.width + grid.width) % grid.width;
          const int y = (to / grid.width - from / grid.width + grid.height) % grid.height;
          map(c * n + to, from) = spot.at(c, x, y);
        }
      }
    }
    covariance += map * map.transpose();
  }
  return covariance;
}

Eigen::MatrixXd square_root(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

double dense_squared_distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd root = square_root(a);
  return a.trace() + b.trace() - 2 * square_root(root * b * root).trace();
}

TEST(ModelError, IsTheWassersteinDistanceOfTheDenseGaussianLaws) {
  const Exemplar exemplar = smooth_exemplar({8, 8}, 3);
  const Target target = make_target(exemplar);
  const Eigen::MatrixXd wanted = dense_covariance(target.gaussian.spectrum);
  for (const int factors : {1, 2, 3}) {
    SCOPED_TRACE(factors);
    const LawOnly model(white_law({8, 8}, factors, 5));
    const double squared = dense_squared_distance(dense_covariance(model.spectrum({8, 8})), wanted);
    // float32 spectra on one side; square roots of 192 x 192 matrices of low rank on the other.
    EXPECT_NEAR(*ot_distance(model, target, anywhere), std::sqrt(squared / 64), 2e-6);
    EXPECT_NEAR(*rme(model, target, anywhere), std::sqrt(squared / wanted.trace()), 2e-5);
  }
}

// EUSIPCO 2014, eq. 2: p(h) = t̂ (t̂* ĥ) / |t̂* ĥ| is the nearest to h of all spots t̂ e^{iφ} of the target's law, and the
// distance from p(h) to h is the transport distance of the laws.
TEST(ModelError, IsReachedByImposingTheModulusAndByNoOtherPhase) {
  const Exemplar exemplar = smooth_exemplar({16, 12}, 3);
  const Target target = make_target(exemplar);
  const LawOnly model(white_law({16, 12}, 1, 9));
  const Spectrum& t = target.gaussian.spectrum.factors.front();
  const Spectrum h = model.spectrum({16, 12}).factors.front();
  const double optimal = *ot_distance(model, target, anywhere);

  // Root of the mean square difference a pixel between h and t̂ exp(i (phase of t̂* ĥ + perturbation)).
  const auto distance = [&](double size, const Image& perturbation) {
    double sum = 0;
    for (int ky = 0; ky < t.rows(); ++ky) {
      for (int kx = 0; kx < t.columns(); ++kx) {
        std::complex<double> overlap = 0;
        for (int c = 0; c < 3; ++c)
          overlap += std::conj(std::complex<double>(t.at(c, kx, ky))) * std::complex<double>(h.at(c, kx, ky));
        if (std::abs(overlap) == 0) continue;
        const auto phasor = overlap / std::abs(overlap) * std::polar(1.0, size * perturbation.at(0, kx, ky));
        for (int c = 0; c < 3; ++c) {
          sum += t.multiplicity(kx) *
                 std::norm(phasor * std::complex<double>(t.at(c, kx, ky)) - std::complex<double>(h.at(c, kx, ky)));
        }
      }
    }
    return std::sqrt(sum / static_cast<double>(t.raster().area()));
  };

  const Extent bins{t.columns(), t.rows()};
  EXPECT_NEAR(distance(0, Image(bins, 1)), optimal, 1e-6);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double size = std::pow(10.0, -2 + 3 * static_cast<double>(i) / 1000);
    EXPECT_GT(distance(size, white_noise(bins, 1, 100 + i)), optimal);
  }
}

TEST(ModelError, OfAScaledTargetIsTheChangeOfContrast) {
  const Exemplar exemplar = smooth_exemplar({32, 24}, 3);
  const Target target = make_target(exemplar);
  const double deviation = std::sqrt(color_covariance(target.gaussian.spectrum).trace());
  const LawOnly perfect(target.gaussian.spectrum), faint(scaled(target.gaussian.spectrum, 0.75F)),
      flat(scaled(target.gaussian.spectrum, 0));
  EXPECT_NEAR(*rme(perfect, target, anywhere), 0, 1e-6);
  EXPECT_NEAR(*rme_printed(perfect, target, anywhere), 1, 1e-6);
  EXPECT_NEAR(*rme(faint, target, anywhere), 0.25, 1e-6);
  EXPECT_NEAR(*rme_printed(faint, target, anywhere), std::sqrt(1 + 0.75 * 0.75 - 0.75), 1e-6);
  EXPECT_NEAR(*ot_distance(faint, target, anywhere), 0.25 * deviation, 1e-6);
  EXPECT_NEAR(*rme(flat, target, anywhere), 1, 1e-12);
}

TEST(ModelError, IsAbsentForAModelWithoutClosedFormLaw) {
  const Exemplar exemplar = smooth_exemplar({8, 8}, 3);
  const Target target = make_target(exemplar);
  EXPECT_FALSE(rme(Lawless(), target, anywhere));
  EXPECT_FALSE(rme_printed(Lawless(), target, anywhere));
  EXPECT_FALSE(ot_distance(Lawless(), target, anywhere));
}

}  // namespace textonbench::model_error_test
