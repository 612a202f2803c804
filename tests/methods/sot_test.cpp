#include "methods/spot/sot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "methods/spot/texton_error.h"
#include "tests/texture.h"

namespace textonbench::sot_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::unique_ptr<Model> fit(const Exemplar& exemplar, const std::map<std::string, ParamValue>& given,
                           std::uint64_t seed = 1) {
  const MethodEntry& entry = find_method("sot");
  return entry.analyze({exemplar}, Params(entry.params, given), Seed{seed});
}

bool same_pixels(const Image& a, const Image& b) {
  for (int c = 0; c < a.channels(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      if (!std::ranges::equal(a.row(c, y), b.row(c, y))) {
        return false;
      }
    }
  }
  return a.extent() == b.extent() && a.channels() == b.channels();
}

TEST(Sot, OptionsReachTheAlgorithm) {
  const Exemplar exemplar = test_exemplar({48, 40}, 3);
  const auto kernel = [&](const std::map<std::string, ParamValue>& given, std::uint64_t seed = 1) {
    return fit(exemplar, given, seed)->texton()->kernels.front();
  };
  const Image defaults = kernel({});
  const ProjectedTexton direct = fit_sot(exemplar, square_support(31), {}, Seed{1});
  EXPECT_EQ(direct.summary.iterations, 50);
  EXPECT_TRUE(same_pixels(defaults, direct.texton.kernels.front()));
  EXPECT_FALSE(same_pixels(defaults, kernel({}, 2)));
  EXPECT_FALSE(same_pixels(defaults, kernel({{"iterations", std::int64_t{49}}})));
  EXPECT_FALSE(same_pixels(defaults, kernel({{"tolerance", 0.1}})));
  EXPECT_FALSE(same_pixels(defaults, kernel({{"initialization", std::string("white")}})));
  EXPECT_FALSE(same_pixels(defaults, kernel({{"component", std::string("raw")}})));
  const Image authors = kernel({{"color_correction", std::string("authors")}});
  EXPECT_FALSE(same_pixels(defaults, authors));
  EXPECT_FALSE(same_pixels(authors, kernel({{"color_correction", std::string("transport")}})));
  EXPECT_EQ(kernel({{"support", std::int64_t{6}}, {"shape", std::string("disc")}}).extent(), (Extent{13, 13}));
}

TEST(Sot, CorrectedTextonHasTheExemplarsColors) {
  const Exemplar exemplar = test_exemplar({48, 40}, 3);
  const Eigen::MatrixXd expected = color_covariance(fit_spot(exemplar, SpotSource::periodic_component).spectrum);
  for (const char* correction : {"authors", "transport"}) {
    const auto model = fit(exemplar, {{"support", std::int64_t{9}}, {"color_correction", std::string(correction)}});
    EXPECT_LT((color_covariance(*model->texton()) - expected).norm(), 1e-6 * expected.norm()) << correction;
  }
}

TEST(Sot, BothStartsEndAtAboutTheSameError) {
  const Exemplar exemplar = test_exemplar({64, 64}, 3);
  const auto error = [&](SotStart start) {
    SotOptions options;
    options.start = start;
    return fit_sot(exemplar, square_support(15), options, Seed{3}).summary.rme.back();
  };
  EXPECT_NEAR(error(SotStart::random_phase), error(SotStart::white), 0.02);
}

TEST(Sot, SmallSupportsLoseVarianceAndLargeOnesNone) {
  const Exemplar exemplar = test_exemplar({32, 32}, 1);
  const GaussianModel model = fit_spot(exemplar, SpotSource::periodic_component);
  double before = 1;
  for (const int side : {3, 7, 15, 32}) {
    const double rme = fit_sot(exemplar, square_support(side), {}, Seed{1}).summary.rme.back();
    EXPECT_LT(rme, before) << side;
    before = rme;
  }
  EXPECT_LT(before, 2e-6);
}

TEST(Sot, RefusesWhatItCannotFit) {
  EXPECT_THAT(
      [] {
        fit(test_exemplar({20, 16}, 3), {});
      },
      ThrowsMessage<std::invalid_argument>(
          HasSubstr("support of 31x31 pixels: expected no more than the exemplar's 20x16")));
  EXPECT_THAT(
      [] {
        fit({"constant", Image({40, 40}, 3), ""}, {});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("constant")));
  EXPECT_THROW(fit(test_exemplar({40, 40}, 3), {{"iterations", std::int64_t{0}}}), ParamError);
}

}  // namespace textonbench::sot_test
