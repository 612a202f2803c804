#include "methods/base/gaussian_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <complex>
#include <numbers>

#include "methods/base/image_io.h"
#include "methods/base/spectrum.h"
#include "tests/texture.h"

namespace textonbench::gaussian_model_test {

CrossSpectrum random_spectrum(Extent extent, int channels, int rank, std::uint64_t seed) {
  CrossSpectrum p;
  for (int k = 0; k < rank; ++k) {
    const Image spot = test_texture(extent, channels, seed + 100 * static_cast<std::uint64_t>(k));
    p.factors.push_back(gaussian_model(spot).spectrum.factors.front());
  }
  return p;
}

/// Covariance of all samples of the torus, without the mean's direction: entry ((c, x), (d, y)) is Γ_cd(x − y),
/// computed by a sum over frequencies in double precision.
Eigen::MatrixXd dense_covariance(const CrossSpectrum& p) {
  const auto [w, h] = p.grid();
  const int n = w * h;
  const int channels = p.channels();
  const auto bin = [&](const Spectrum& s, int c, int kx, int ky) {
    const std::complex<double> value(kx < s.columns() ? s.at(c, kx, ky) : std::conj(s.at(c, w - kx, (h - ky) % h)));
    return value;
  };
  Eigen::MatrixXd gamma = Eigen::MatrixXd::Zero(channels * n, channels * n);
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d < channels; ++d) {
      std::vector<double> lags(static_cast<std::size_t>(n));
      for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
          std::complex<double> sum = 0;
          for (int ky = 0; ky < h; ++ky) {
            for (int kx = 0; kx < w; ++kx) {
              if (kx == 0 && ky == 0) {
                continue;
              }
              std::complex<double> density = 0;
              for (const Spectrum& factor : p.factors) {
                density += bin(factor, c, kx, ky) * std::conj(bin(factor, d, kx, ky));
              }
              const double angle =
                  2 * std::numbers::pi * (static_cast<double>(kx * x) / w + static_cast<double>(ky * y) / h);
              sum += density * std::polar(1.0, angle);
            }
          }
          lags[static_cast<std::size_t>(y * w + x)] = sum.real() / n;
        }
      }
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const int x = ((i % w) - (j % w) + w) % w;
          const int y = ((i / w) - (j / w) + h) % h;
          gamma(c * n + i, d * n + j) = lags[static_cast<std::size_t>(y * w + x)];
        }
      }
    }
  }
  return gamma;
}

Eigen::MatrixXd root(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// Squared Wasserstein-2 distance between centered Gaussian vectors, by matrix square roots.
double dense_distance_squared(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd half = root(a);
  return a.trace() + b.trace() - 2 * root(half * b * half).trace();
}

TEST(FactorProducts, HaveTheProductsOfTheirFactors) {
  const Spectrum a = forward_fft(test_texture({6, 5}, 3, 1)), b = forward_fft(test_texture({6, 5}, 3, 2));
  std::vector<Spectrum> products;
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d <= c; ++d) {
      Spectrum& product = products.emplace_back(Extent{6, 5}, 1);
      for (int ky = 0; ky < 5; ++ky) {
        for (int kx = 0; kx < 4; ++kx) {
          product.at(0, kx, ky) =
              a.at(c, kx, ky) * std::conj(a.at(d, kx, ky)) + b.at(c, kx, ky) * std::conj(b.at(d, kx, ky));
        }
      }
    }
  }
  const CrossSpectrum p = factor_products(products, 3);
  ASSERT_EQ(p.factors.size(), 3U);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d <= c; ++d) {
      for (int ky = 0; ky < 5; ++ky) {
        for (int kx = 0; kx < 4; ++kx) {
          std::complex<float> sum = 0;
          for (const Spectrum& h : p.factors) sum += h.at(c, kx, ky) * std::conj(h.at(d, kx, ky));
          const std::complex<float> expected = products[static_cast<std::size_t>(c * (c + 1) / 2 + d)].at(0, kx, ky);
          EXPECT_NEAR(std::abs(sum - expected), 0, 1e-5F * (std::abs(expected) + 1));
        }
      }
    }
  }
  EXPECT_THROW(factor_products(products, 2), std::invalid_argument);
}

TEST(TransportDistance, OfRankOneIsTheDenseGaussianDistance) {
  const CrossSpectrum p = random_spectrum({8, 8}, 3, 1, 1);
  const CrossSpectrum q = random_spectrum({8, 8}, 3, 1, 2);
  const double dense = dense_distance_squared(dense_covariance(p), dense_covariance(q)) / 64;
  // The dense square roots of singular matrices are good to the root of the rounding error.
  EXPECT_NEAR(transport_distance_squared(p, q), dense, 1e-5 * dense);
}

TEST(TransportDistance, OfFullRankIsTheDenseGaussianDistance) {
  const CrossSpectrum p = random_spectrum({6, 5}, 3, 3, 3);
  const CrossSpectrum q = random_spectrum({6, 5}, 3, 2, 9);
  const double dense = dense_distance_squared(dense_covariance(p), dense_covariance(q)) / 30;
  EXPECT_NEAR(transport_distance_squared(p, q), dense, 1e-5 * dense);
  EXPECT_NEAR(transport_distance_squared(q, p), dense, 1e-5 * dense);
}

TEST(TransportDistance, OfALargerTorusBoundsTheWindows) {
  // EUSIPCO 2014, 2.3: restrictions to a window are no farther from each other, a pixel, than the torus laws.
  const CrossSpectrum p = random_spectrum({12, 12}, 1, 1, 4);
  const CrossSpectrum q = random_spectrum({12, 12}, 1, 1, 5);
  const Eigen::MatrixXd a = dense_covariance(p);
  const Eigen::MatrixXd b = dense_covariance(q);
  std::vector<Eigen::Index> window;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) {
      window.push_back(12 * y + x);
    }
  }
  const double restricted = dense_distance_squared(a(window, window), b(window, window)) / 25;
  EXPECT_LE(restricted, transport_distance_squared(p, q) * (1 + 1e-6));
  EXPECT_GT(restricted, 0);
}

TEST(TransportDistance, OfALawToItselfIsZeroAndOfOthersThrows) {
  const CrossSpectrum p = random_spectrum({16, 12}, 3, 1, 6);
  EXPECT_LT(transport_distance_squared(p, p), 1e-9);
  EXPECT_THROW(transport_distance_squared(p, random_spectrum({16, 10}, 3, 1, 6)), std::invalid_argument);
  EXPECT_THROW(transport_distance_squared(p, random_spectrum({16, 12}, 1, 1, 6)), std::invalid_argument);
}

TEST(RelativeModelError, HasTheFactorTwo) {
  const CrossSpectrum target = random_spectrum({16, 16}, 3, 1, 7);
  EXPECT_LT(relative_model_error(target, target), 1e-4);
  EXPECT_NEAR(relative_model_error_as_printed(target, target), 1, 1e-6);
  CrossSpectrum half = target;
  Spectrum& spot = half.factors.front();
  for (int c = 0; c < 3; ++c) {
    for (int ky = 0; ky < spot.rows(); ++ky) {
      for (auto& bin : spot.row(c, ky)) {
        bin *= 0.5F;
      }
    }
  }
  EXPECT_NEAR(relative_model_error(half, target), 0.5, 1e-6);
}

TEST(RelativeModelError, OfAPublishedTextonIsTheReference) {
  const auto data = folder_from("TEXTONBENCH_DATA");
  const auto reference = folder_from("TEXTONBENCH_REFERENCE");
  if (!data || !reference) {
    GTEST_SKIP() << "set TEXTONBENCH_DATA (with 0000_2.png) and TEXTONBENCH_REFERENCE (with "
                    "tv_published_0000_2_s32_texton.npy) to compare with a published texton";
  }
  const Image u = periodic_component(read_image(*data / "0000_2.png").image);
  const CrossSpectrum target = gaussian_model(u).spectrum;
  const std::vector<double> texton = read_npy(*reference / "tv_published_0000_2_s32_texton.npy");
  ASSERT_EQ(texton.size(), 32U * 32 * 3);
  Image padded(u.extent(), 3);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      for (int c = 0; c < 3; ++c) {
        padded.at(c, x, y) = static_cast<float>(texton[static_cast<std::size_t>((y * 32 + x) * 3 + c)]);
      }
    }
  }
  // Bilinear texton noise has spectrum |α̂|² b̂ with b̂(k) = (2 + cos(2πkx/W)) (2 + cos(2πky/H)) / 9.
  CrossSpectrum p;
  p.factors.push_back(forward_fft(padded));
  Spectrum& spot = p.factors.front();
  for (int ky = 0; ky < spot.rows(); ++ky) {
    for (int kx = 0; kx < spot.columns(); ++kx) {
      const double b = (2 + std::cos(2 * std::numbers::pi * kx / u.width())) *
                       (2 + std::cos(2 * std::numbers::pi * ky / u.height())) / 9;
      for (int c = 0; c < 3; ++c) {
        spot.at(c, kx, ky) *= static_cast<float>(std::sqrt(b));
      }
    }
  }
  EXPECT_NEAR(relative_model_error(p, target), 0.5704589903743258, 1e-6);
  EXPECT_NEAR(relative_model_error_as_printed(p, target), 1.0771717557271834, 1e-6);
}

TEST(Projection, OnTheModulusIsTheNearestKernelOfTheTarget) {
  // EUSIPCO 2014, eq. 2: of all kernels q with the target's law, q = t e^{iφ(ξ)}, the one whose phase is that of t* h
  // is nearest to h in energy; then the energy of the difference is the transport distance.
  const Extent extent{12, 10};
  const Spectrum t = random_spectrum(extent, 3, 1, 11).factors.front();
  const Spectrum h = random_spectrum(extent, 3, 1, 12).factors.front();
  const auto distance = [&](const Stream* phases) {
    double sum = 0;
    for (int ky = 0; ky < t.rows(); ++ky) {
      std::vector<std::complex<float>> turn(static_cast<std::size_t>(t.columns()));
      if (phases != nullptr) {
        fill_phasor(*phases, static_cast<std::uint64_t>(ky), 0, turn);
      }
      for (int kx = ky == 0 ? 1 : 0; kx < t.columns(); ++kx) {
        std::complex<double> inner = 0;
        for (int c = 0; c < 3; ++c) {
          inner += std::conj(std::complex<double>(t.at(c, kx, ky))) * std::complex<double>(h.at(c, kx, ky));
        }
        std::complex<double> phase = inner / std::abs(inner);
        if (phases != nullptr) {
          phase *= std::complex<double>(turn[static_cast<std::size_t>(kx)]);
        }
        for (int c = 0; c < 3; ++c) {
          sum += t.multiplicity(kx) *
                 std::norm(std::complex<double>(t.at(c, kx, ky)) * phase - std::complex<double>(h.at(c, kx, ky)));
        }
      }
    }
    return sum / static_cast<double>(extent.area());
  };
  CrossSpectrum target;
  target.factors.push_back(t);
  CrossSpectrum of_h;
  of_h.factors.push_back(h);
  const double projected = distance(nullptr);
  EXPECT_NEAR(projected, transport_distance_squared(of_h, target), 1e-6 * projected);
  const Stream stream = Stream(Seed{1}).child("perturbations");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Stream phases = stream.child(i);
    ASSERT_GT(distance(&phases), projected);
  }
}

TEST(Autocovariance, IsTheCircularAutocorrelationOfTheSpot) {
  const Image u = test_texture({9, 6}, 3);
  const GaussianModel model = gaussian_model(u);
  const Autocovariance gamma = autocovariance(model.spectrum);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      for (int vy = -3; vy < 6; ++vy) {
        for (int vx = -5; vx < 9; ++vx) {
          double sum = 0;
          for (int y = 0; y < 6; ++y) {
            for (int x = 0; x < 9; ++x) {
              const double a = static_cast<double>(u.at(c, (x + vx + 9) % 9, (y + vy + 6) % 6)) -
                               model.mean[static_cast<std::size_t>(c)];
              const double b = static_cast<double>(u.at(d, x, y)) - model.mean[static_cast<std::size_t>(d)];
              sum += a * b;
            }
          }
          ASSERT_NEAR(gamma.at(c, d, vx, vy), sum / 54, 1e-8);
        }
      }
    }
  }
  const Eigen::MatrixXd at_zero = color_covariance(model.spectrum);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(at_zero(c, d), gamma.at(c, d, 0, 0), 1e-8);
    }
  }
}

TEST(BuresDistance, IsThatOfCommutingMatrices) {
  Eigen::Matrix3d rotation;
  rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() << 0.6, -0.8, 0.8, 0.6;
  const Eigen::Vector3d a(4, 1, 0);
  const Eigen::Vector3d b(1, 9, 0.25);
  const Eigen::MatrixXd first = rotation * a.asDiagonal() * rotation.transpose();
  const Eigen::MatrixXd second = rotation * b.asDiagonal() * rotation.transpose();
  EXPECT_NEAR(bures_distance_squared(first, second), (a.cwiseSqrt() - b.cwiseSqrt()).squaredNorm(), 1e-12);
}

}  // namespace textonbench::gaussian_model_test
