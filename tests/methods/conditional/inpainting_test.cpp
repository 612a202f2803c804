// Held to dense conditional laws and published solutions.
#include "methods/conditional/inpainting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "tests/base/statistics.h"
#include "tests/methods/conditional/dense_kriging.h"
#include "tests/sanitizer.h"
#include "tests/texture.h"

namespace textonbench::inpainting_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// 16 x 16, 5 x 4 missing.
constexpr Extent small{16, 16};
Mask small_hole() { return rectangle_mask(small, {6, 5, {5, 4}}); }

/// Values at the missing pixels, channel by channel.
Eigen::VectorXd missing_values(const Image& image, const Mask& missing) {
  const std::vector<Pixel> pixels = pixels_of(missing);
  Eigen::VectorXd values(std::ssize(pixels) * image.channels());
  Eigen::Index i = 0;
  for (int c = 0; c < image.channels(); ++c) {
    for (const Pixel& p : pixels) values[i++] = static_cast<double>(image.at(c, p.x, p.y));
  }
  return values;
}

/// The conditional law by dense algebra.
struct DenseLaw {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

DenseLaw dense_law(const Inpainting& model, Extent torus) {
  const KrigingOperator& op = model.kriging_operator();
  const auto c = op.conditioning_pixels();
  const auto m = op.missing_pixels();
  const Eigen::MatrixXd cc = plain_matrix(op.field(), torus, c, c);
  const Eigen::MatrixXd mc = plain_matrix(op.field(), torus, m, c);
  const Eigen::MatrixXd mm = plain_matrix(op.field(), torus, m, m);
  const Eigen::LLT<Eigen::MatrixXd> factor(cc);
  EXPECT_EQ(factor.info(), Eigen::Success);
  DenseLaw law;
  law.mean = mc * factor.solve(to_vector(model.right_side()));
  for (Eigen::Index i = 0; i < law.mean.size(); ++i) {
    law.mean[i] += op.field().mean[static_cast<std::size_t>(i / std::ssize(m))];
  }
  law.covariance = mm - mc * factor.solve(mc.transpose());
  return law;
}

struct Law {
  int channels;
  bool periodic;
  double nugget;
  KrigingSolver solver;
};

class InpaintingLaw : public testing::TestWithParam<Law> {
 protected:
  Inpainting make(std::uint64_t texture = 1) const {
    return {test_texture(small, GetParam().channels, texture),
            small_hole(),
            nullptr,
            {.border = 2,
             .periodic = GetParam().periodic,
             .nugget = GetParam().nugget,
             .solve = {.solver = GetParam().solver, .tolerance = 1e-9}}};
  }
};

TEST_P(InpaintingLaw, KrigingIsTheConditionalMean) {
  const Inpainting model = make();
  const DenseLaw law = dense_law(model, small);
  EXPECT_LT((missing_values(model.kriging(), small_hole()) - law.mean).norm(), 1e-6 * law.mean.norm());
}

/// 2000 samples: the whitened mean times √2000 is standard normal, of dimension n; the whitened squares sum to a χ² of
/// 2000 n degrees; and their matrix is within 4.9 deviations of the identity entry by entry (1e-6 each). False-alarm
/// rate 1e-3 for the first two.
TEST_P(InpaintingLaw, SamplesHaveTheConditionalMeanAndCovariance) {
  const Inpainting model = make();
  const DenseLaw law = dense_law(model, small);
  const Eigen::LLT<Eigen::MatrixXd> factor(law.covariance);
  ASSERT_EQ(factor.info(), Eigen::Success);
  const Eigen::Index n = law.mean.size();
  constexpr int samples = 2000;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n, n);
  for (int s = 0; s < samples; ++s) {
    const Image sample = model.synthesize({.size = small}, Seed{static_cast<std::uint64_t>(s)});
    const Eigen::VectorXd white = factor.matrixL().solve(missing_values(sample, small_hole()) - law.mean);
    mean += white / samples;
    second += white * white.transpose();
  }
  EXPECT_GT(chi_square_p_value(samples * mean.squaredNorm(), static_cast<double>(n)), 5e-4);
  const double p = chi_square_p_value(second.trace(), static_cast<double>(samples * n));
  EXPECT_GT(p, 2.5e-4);
  EXPECT_LT(p, 1 - 2.5e-4);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      ASSERT_NEAR(second(i, j) / samples, i == j ? 1 : 0, 4.9 * std::sqrt((i == j ? 2.0 : 1.0) / samples));
    }
  }
}

/// Kriging of simulated data F* and innovation F − F*: correlations over 2000 samples, each below 4.9 / √2000 (1e-6).
TEST_P(InpaintingLaw, KrigingAndInnovationAreUncorrelated) {
  const Inpainting model = make();
  const KrigingOperator& op = model.kriging_operator();
  constexpr int samples = 2000;
  const Mask hole = small_hole();
  const auto n = std::ssize(op.missing_pixels()) * op.channels();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd estimate_squares = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd innovation_squares = Eigen::VectorXd::Zero(n);
  for (int s = 0; s < samples; ++s) {
    const Seed seed{static_cast<std::uint64_t>(s)};
    const Eigen::VectorXd innovation = missing_values(model.innovation(seed), hole);
    const Eigen::VectorXd estimate = to_vector(op.simulate(seed).missing) - innovation;
    products += estimate * innovation.transpose();
    estimate_squares += estimate.cwiseAbs2();
    innovation_squares += innovation.cwiseAbs2();
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      ASSERT_LT(std::fabs(products(i, j)),
                4.9 / std::sqrt(samples) * std::sqrt(estimate_squares[i] * innovation_squares[j]));
    }
  }
}

TEST_P(InpaintingLaw, ComponentsAddUpToTheSample) {
  const Inpainting model = make();
  const Image sample = model.synthesize({.size = small}, Seed{4});
  const Image kriging = model.kriging();
  const Image innovation = model.innovation(Seed{4});
  for (int c = 0; c < sample.channels(); ++c) {
    for (int y = 0; y < small.height; ++y) {
      for (int x = 0; x < small.width; ++x) {
        ASSERT_NEAR(sample.at(c, x, y), kriging.at(c, x, y) + innovation.at(c, x, y), 2e-6);
      }
    }
  }
}

/// Values that a field has at its conditioning pixels are what kriging gives there: Γ_CC k.
TEST_P(InpaintingLaw, ConditioningPixelsAreReproduced) {
  const Inpainting model = make();
  const KrigingOperator& op = model.kriging_operator();
  const std::vector<double> values = op.simulate(Seed{9}).conditioning;
  const KrigingSystem::Solution solution = model.system().solve(values);
  std::vector<double> back(values.size());
  KrigingOperator::Workspace workspace;
  op.apply(solution.k, back, workspace);
  EXPECT_LT((to_vector(back) - to_vector(values)).norm(), 1e-8 * to_vector(values).norm());
}

TEST_P(InpaintingLaw, KnownPixelsAreUntouchedBitForBit) {
  const Image u = test_texture(small, GetParam().channels);
  const Image sample = make().synthesize({.size = small}, Seed{2});
  const Mask missing = small_hole();
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < small.height; ++y) {
      for (int x = 0; x < small.width; ++x) {
        if (missing.at(x, y)) continue;
        ASSERT_EQ(std::memcmp(sample.row(c, y).data() + x, u.row(c, y).data() + x, sizeof(float)), 0);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, InpaintingLaw,
                         testing::Values(Law{1, false, 0, KrigingSolver::dense}, Law{3, false, 0, KrigingSolver::dense},
                                         Law{2, true, 0, KrigingSolver::dense},
                                         Law{3, false, 1e-2, KrigingSolver::schwarz}));

TEST(Inpainting, NeverReadsWhatIsMissing) {
  Image u = test_texture({40, 30}, 3);
  const Mask missing = rectangle_mask(u.extent(), {10, 8, {12, 9}});
  const Image first = Inpainting(u, missing, nullptr, {}).synthesize({.size = u.extent()}, Seed{1});
  for (const Pixel& p : pixels_of(missing)) u.at(1, p.x, p.y) = NAN;
  const Image second = Inpainting(u, missing, nullptr, {}).synthesize({.size = u.extent()}, Seed{1});
  for (int y = 0; y < 30; ++y) ASSERT_TRUE(std::ranges::equal(first.row(1, y), second.row(1, y)));
}

TEST(Inpainting, TakesItsModelFromAPartOrFromAnotherExemplar) {
  const Image u = test_texture({40, 30}, 3);
  const Mask missing = rectangle_mask(u.extent(), {20, 8, {12, 9}});
  const Rectangle part{2, 1, {15, 20}};
  const Exemplar other{"part", crop(u, part.x, part.y, part.size), std::string(64, '0')};
  const Inpainting from_part(u, missing, nullptr, {.clean = part});
  const Inpainting from_other(u, missing, &other, {});
  EXPECT_EQ(from_part.kriging_operator().field().spot.data, from_other.kriging_operator().field().spot.data);
  EXPECT_EQ(from_part.kriging_operator().field().mean, from_other.kriging_operator().field().mean);
}

/// Masks in pieces, at the edges and in the corners.
TEST(Inpainting, FillsHolesAnywhere) {
  const Image u = test_texture({40, 30}, 3);
  Mask missing = rectangle_mask(u.extent(), {0, 0, {8, 6}});
  for (const Rectangle& more : {Rectangle{36, 20, {4, 10}}, Rectangle{15, 29, {9, 1}}, Rectangle{20, 12, {1, 1}}}) {
    for (const Pixel& p : pixels_of(rectangle_mask(u.extent(), more))) missing.set(p.x, p.y, true);
  }
  const Inpainting model(u, missing, nullptr, {});
  EXPECT_FALSE(find_non_finite(model.synthesize({.size = u.extent()}, Seed{1})));
  const Mask& conditioning = model.conditioning();
  EXPECT_TRUE(conditioning.at(8, 2) && conditioning.at(10, 8) && !conditioning.at(11, 2) && !conditioning.at(3, 3));
}

TEST(InpaintingErrors, SayWhatWasExpected) {
  const Image u = test_texture({40, 30}, 3);
  const Mask hole = rectangle_mask(u.extent(), {10, 8, {12, 9}});
  const auto expect = [&](const Image& picture, const Mask& missing, const Exemplar* other,
                          const InpaintingOptions& options, const char* text) {
    EXPECT_THAT([&] { Inpainting(picture, missing, other, options); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  expect(u, Mask({30, 40}), nullptr, {}, "a mask of 30x40 for a picture of 40x30");
  expect(u, Mask(u.extent()), nullptr, {}, "no pixel is missing");
  expect(u, Mask(u.extent(), true), nullptr, {}, "every pixel is missing");
  expect(u, rectangle_mask(u.extent(), {1, 0, {39, 30}}), nullptr, {}, "30 known pixels to estimate a model from");
  expect(u, hole, nullptr, {.border = 0}, "a border of 0 pixels");
  expect(u, hole, nullptr, {.nugget = -1}, "nugget = -1");
  expect(u, hole, nullptr, {.clean = Rectangle{30, 0, {11, 5}}}, "a clean part 30,0,11,5 of a picture of 40x30");
  const Exemplar gray{"gray", test_texture({40, 30}, 1), std::string(64, '0')};
  expect(u, hole, &gray, {}, "a picture of 3 channels and the exemplar gray of 1");
  Image broken = u;
  broken.at(2, 1, 2) = NAN;
  expect(broken, hole, nullptr, {}, "channel 3 of the known pixel (1, 2) is nan");
  Image flat({40, 30}, 3);
  expect(flat, hole, nullptr, {}, "all of one color");
  // A circular color model with more than a third of the torus as conditioning.
  expect(u, hole, nullptr, {.border = 30, .periodic = true}, "rank 1199 at most");
}

/// Solutions of the authors' problems by dense algebra in double precision.
TEST(PublishedInpainting, SmallProblem) {
  const auto data = folder_from("TEXTONBENCH_DATA");
  const auto reference = folder_from("TEXTONBENCH_REFERENCE");
  if (!data || !reference) GTEST_SKIP() << "TEXTONBENCH_DATA and TEXTONBENCH_REFERENCE are not set";
  const Image u = crop(read_image(*data / "0000_2.png").image, 0, 0, {32, 32});
  const Mask missing = rectangle_mask({32, 32}, {12, 11, {10, 10}});
  const Inpainting model(u, missing, nullptr, {.border = 3});
  std::ifstream in(*reference / "tv_kriging_small.json");
  const nlohmann::json published = nlohmann::json::parse(in);
  EXPECT_EQ(model.kriging_operator().points(), published.at("n_cond").get<int>());
  const CovarianceTable table = model.kriging_operator().covariance().table({8, 8});
  for (const auto& [key, vx, vy] :
       {std::tuple{"cov_h0_0", 0, 0}, {"cov_h0_1", 1, 0}, {"cov_h1_0", 0, 1}, {"cov_h5_m3", -3, 5}}) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        // The reference has lag h on the second factor: Γ_ba(h).
        EXPECT_NEAR(table.at(b, a, vx, vy), published.at(key).at(a).at(b).get<double>(), 1e-8) << key;
      }
    }
  }
  const std::vector<double> exact = read_npy(*reference / "tv_kriging_small_exact_10x10x3.npy");
  ASSERT_EQ(exact.size(), 300U);
  const Image kriging = model.kriging();
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(static_cast<double>(kriging.at(c, 12 + x, 11 + y)),
                    exact[static_cast<std::size_t>((y * 10 + x) * 3 + c)], 1e-5);
      }
    }
  }
}

TEST(PublishedInpainting, LargerProblemsByEverySolver) {
  const auto data = folder_from("TEXTONBENCH_DATA");
  const auto reference = folder_from("TEXTONBENCH_REFERENCE");
  if (!data || !reference) GTEST_SKIP() << "TEXTONBENCH_DATA and TEXTONBENCH_REFERENCE are not set";
  for (const std::string name : {"blue_fabric2_crop", "wood_256"}) {
    const Image u = read_image(*data / (name + ".png")).image;
    const std::vector<double> exact = read_npy(*reference / ("tv_inpaint_kriging_exact_" + name + ".npy"));
    ASSERT_EQ(exact.size(), 30000U);
    // Dense algebra of 3708 unknowns takes long under the sanitizers.
    std::vector<KrigingSolver> solvers{KrigingSolver::schwarz};
    if (!sanitized) solvers.insert(solvers.end(), {KrigingSolver::dense, KrigingSolver::cg});
    for (const KrigingSolver solver : solvers) {
      const Inpainting model(u, rectangle_mask(u.extent(), {78, 78, {100, 100}}), nullptr,
                             {.border = 3, .solve = {.solver = solver, .iterations = 3000}});
      const double sigma = std::sqrt(mean_variance(model.kriging_operator().field()));
      const Image kriging = model.kriging();
      double worst = 0;
      for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x) {
          for (int c = 0; c < 3; ++c) {
            const double expected = exact[static_cast<std::size_t>((y * 100 + x) * 3 + c)];
            worst = std::max(worst, std::fabs(static_cast<double>(kriging.at(c, 78 + x, 78 + y)) - expected));
          }
        }
      }
      EXPECT_LT(worst, 1e-4 * sigma) << name << " " << name_of(solver);
    }
  }
}

}  // namespace textonbench::inpainting_test
