// Held to dense matrices of covariances by their sum, and to published solutions.
#include "methods/conditional/kriging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/methods/conditional/dense_kriging.h"
#include "tests/texture.h"

namespace textonbench::kriging_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Case {
  int channels;
  bool periodic;
  Rectangle hole;
  double nugget;
};

class Kriging : public testing::TestWithParam<Case> {
 protected:
  static constexpr Extent size{14, 11};

  GaussianField field() const {
    GaussianField result = estimate_field(test_texture(size, GetParam().channels), missing());
    result.periodic = GetParam().periodic;
    result.nugget_variance = GetParam().nugget;
    return result;
  }
  Mask missing() const { return rectangle_mask(size, GetParam().hole); }
  Mask border() const { return difference(dilate(missing(), 2, GetParam().periodic), missing()); }
  KrigingOperator make() const { return {field(), border(), missing()}; }
};

TEST_P(Kriging, AppliesTheDenseMatrix) {
  const KrigingOperator op = make();
  const Eigen::MatrixXd dense = plain_matrix(op.field(), size, op.conditioning_pixels(), op.conditioning_pixels());
  const Eigen::VectorXd x = Eigen::VectorXd::Random(dense.rows());
  ASSERT_EQ(op.unknowns(), static_cast<std::size_t>(x.size()));
  std::vector<double> out(op.unknowns());
  KrigingOperator::Workspace workspace;
  for (int repeat = 0; repeat < 2; ++repeat) {
    op.apply({x.data(), op.unknowns()}, out, workspace);
    EXPECT_LT((to_vector(out) - dense * x).norm(), 1e-13 * x.norm());
  }
}

TEST_P(Kriging, ExtendsToTheMissingPixels) {
  const KrigingOperator op = make();
  const Eigen::MatrixXd dense = plain_matrix(op.field(), size, op.missing_pixels(), op.conditioning_pixels());
  const Eigen::VectorXd x = Eigen::VectorXd::Random(dense.cols());
  const std::vector<double> out = op.extend({x.data(), op.unknowns()});
  EXPECT_LT((to_vector(out) - dense * x).norm(), 1e-13 * x.norm());
}

TEST_P(Kriging, FillsMatricesOfSomePixels) {
  const KrigingOperator op = make();
  const std::vector<int> some{0, 3, 4, op.points() - 1};
  std::vector<Pixel> pixels;
  for (const int i : some) pixels.push_back(op.conditioning_pixels()[static_cast<std::size_t>(i)]);
  Eigen::MatrixXd matrix(4 * op.channels(), 4 * op.channels());
  op.fill_matrix(some, op.covariance().table(op.box().size), matrix.data());
  EXPECT_LT((matrix - plain_matrix(op.field(), size, pixels, pixels)).norm(), 1e-14);
}

/// Sums of squares of 4000 samples of a few values, whitened by the dense covariance, at a false-alarm rate of 1e-3 a
/// case.
TEST_P(Kriging, SimulatesTheField) {
  const KrigingOperator op = make();
  const Eigen::MatrixXd joint = [&] {
    std::vector<Pixel> pixels(op.conditioning_pixels().begin(), op.conditioning_pixels().begin() + 3);
    pixels.push_back(op.missing_pixels().front());
    pixels.push_back(op.missing_pixels().back());
    return plain_matrix(op.field(), size, pixels, pixels);
  }();
  const Eigen::LLT<Eigen::MatrixXd> factor(joint);
  ASSERT_EQ(factor.info(), Eigen::Success);
  const Eigen::Index n = joint.rows();
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n, n);
  constexpr int samples = 4000;
  const auto missing_count = op.missing_pixels().size();
  for (int s = 0; s < samples; ++s) {
    const KrigingOperator::Values f = op.simulate(Seed{static_cast<std::uint64_t>(s)});
    Eigen::VectorXd values(n);
    Eigen::Index i = 0;
    for (int c = 0; c < op.channels(); ++c) {
      const auto first = static_cast<std::size_t>(c * op.points());
      for (std::size_t j = 0; j < 3; ++j) values[i++] = f.conditioning[first + j];
      values[i++] = f.missing[static_cast<std::size_t>(c) * missing_count];
      values[i++] = f.missing[static_cast<std::size_t>(c + 1) * missing_count - 1];
    }
    const Eigen::VectorXd white = factor.matrixL().solve(values);
    second += white * white.transpose() / samples;
  }
  // Off the diagonal the variance of an entry is 1 / samples, on it 2 / samples. Bonferroni over n (n + 1) / 2 entries:
  // 4.9 standard deviations are exceeded with probability 1e-6 each.
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double deviation = std::sqrt((i == j ? 2.0 : 1.0) / samples);
      EXPECT_NEAR(second(i, j), i == j ? 1 : 0, 4.9 * deviation) << i << " " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Kriging,
                         testing::Values(Case{1, false, {4, 3, {5, 4}}, 0}, Case{3, false, {4, 3, {5, 4}}, 0},
                                         Case{3, false, {0, 0, {3, 3}}, 1e-4}, Case{1, true, {4, 3, {5, 4}}, 0},
                                         Case{3, true, {11, 2, {3, 3}}, 1e-4}, Case{2, true, {5, 5, {2, 2}}, 0}));

/// A spot smaller than the box: lags as large as the spot are zero.
TEST(KrigingSpot, SmallerThanTheBox) {
  GaussianField field = estimate_field(test_texture({9, 8}, 3), Mask({9, 8}));
  const Mask missing = rectangle_mask({40, 30}, {4, 5, {30, 15}});
  const KrigingOperator op(field, difference(dilate(missing, 1), missing), missing);
  const Eigen::MatrixXd dense = plain_matrix(field, {}, op.conditioning_pixels(), op.conditioning_pixels());
  const Eigen::VectorXd x = Eigen::VectorXd::Random(dense.rows());
  std::vector<double> out(op.unknowns());
  KrigingOperator::Workspace workspace;
  op.apply({x.data(), op.unknowns()}, out, workspace);
  EXPECT_LT((to_vector(out) - dense * x).norm(), 1e-13 * x.norm());
}

TEST(KrigingErrors, SayWhatWasExpected) {
  const GaussianField field = estimate_field(test_texture({12, 10}, 1), Mask({12, 10}));
  const Mask some = rectangle_mask({12, 10}, {2, 2, {3, 3}});
  const Mask none({12, 10});
  EXPECT_THAT([&] { KrigingOperator(field, none, some); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no conditioning pixel")));
  EXPECT_THAT([&] { KrigingOperator(field, some, none); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no pixel is missing")));
  EXPECT_THAT([&] { KrigingOperator(field, some, some); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a conditioning pixel is missing")));
}

TEST(EstimateField, IsTheMeanAndSpotOfTheKnownPixels) {
  Image u = test_texture({12, 10}, 3);
  const Mask missing = rectangle_mask(u.extent(), {3, 2, {4, 5}});
  for (const Pixel& p : pixels_of(missing)) u.at(1, p.x, p.y) = NAN;
  const GaussianField field = estimate_field(u, missing);
  double mean = 0;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 12; ++x) mean += missing.at(x, y) ? 0 : static_cast<double>(u.at(1, x, y)) / 100;
  }
  EXPECT_NEAR(field.mean[1], mean, 1e-14);
  EXPECT_NEAR(field.spot.row(1, 9)[11], (static_cast<double>(u.at(1, 11, 9)) - mean) / 10, 1e-15);
  EXPECT_EQ(field.spot.row(1, 2)[3], 0);
}

TEST(EstimateField, SaysWhatIsWrong) {
  Image u = test_texture({12, 10}, 3);
  EXPECT_THAT(
      [&] {
        estimate_field(u, Mask({10, 12}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("a mask of 10x12 for a picture of 12x10")));
  EXPECT_THAT(
      [&] {
        estimate_field(u, rectangle_mask({12, 10}, {0, 0, {12, 5}}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("60 known pixels")));
  u.at(2, 5, 4) = INFINITY;
  EXPECT_THAT(
      [&] {
        estimate_field(u, Mask({12, 10}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("channel 3 of the known pixel (5, 4) is inf")));
  Image flat({12, 10}, 1);
  EXPECT_THAT(
      [&] {
        estimate_field(flat, Mask({12, 10}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("all of one color")));
}

}  // namespace textonbench::kriging_test
