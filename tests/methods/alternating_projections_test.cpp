// Held to a plain version with full transforms, to the authors' iterates, and to laws in closed form.
#include "methods/spot/alternating_projections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "methods/base/spectrum.h"
#include "methods/spot/color_correction.h"
#include "methods/spot/spline_spectrum.h"
#include "methods/spot/texton_error.h"
#include "tests/texture.h"

namespace textonbench::alternating_projections_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

GaussianModel model_of(const Image& exemplar) { return gaussian_model(periodic_component(exemplar)); }

const Spectrum& spot_of(const GaussianModel& model) { return model.spectrum.factors.front(); }

ProjectedTexton project(const GaussianModel& model, const Support& support, int iterations, std::uint64_t seed = 1) {
  return alternate_projections(model, support, random_phase_start(spot_of(model), Seed{seed}),
                               {.iterations = iterations});
}

/// The algorithm as printed, with whole transforms; the texton on the torus.
Image plain_projections(const Spectrum& spot, const Support& support, Spectrum spectrum, int iterations) {
  Image texton;
  for (int n = 0; n < iterations; ++n) {
    for (int ky = 0; ky < spot.rows(); ++ky) {
      for (int kx = 0; kx < spot.columns(); ++kx) {
        std::complex<double> product = 0;
        for (int c = 0; c < spot.channels(); ++c) {
          product += std::conj(std::complex<double>(spot.at(c, kx, ky))) * std::complex<double>(spectrum.at(c, kx, ky));
        }
        const std::complex<double> phase = product == 0.0 ? 1.0 : product / std::abs(product);
        for (int c = 0; c < spot.channels(); ++c) {
          spectrum.at(c, kx, ky) = std::complex<float>(phase * std::complex<double>(spot.at(c, kx, ky)));
        }
      }
    }
    const Image whole = inverse_fft(spectrum);
    texton = Image(whole.extent(), whole.channels());
    for (const SupportRun& run : support_runs(support)) {
      for (int c = 0; c < whole.channels(); ++c) {
        for (int x = run.first; x < run.last; ++x) {
          texton.at(c, x, run.y) = whole.at(c, x, run.y);
        }
      }
    }
    spectrum = forward_fft(texton);
  }
  return texton;
}

/// Largest difference of the samples, in units of the largest of `expected`, which may be larger than `kernel`.
double difference(const Image& kernel, const Image& expected) {
  double largest = 0;
  double error = 0;
  for (int c = 0; c < kernel.channels(); ++c) {
    for (int y = 0; y < kernel.height(); ++y) {
      for (int x = 0; x < kernel.width(); ++x) {
        largest = std::max(largest, std::fabs(static_cast<double>(expected.at(c, x, y))));
        error = std::max(
            error, std::fabs(static_cast<double>(kernel.at(c, x, y)) - static_cast<double>(expected.at(c, x, y))));
      }
    }
  }
  return error / largest;
}

TEST(AlternatingProjections, AreThoseWithWholeTransforms) {
  for (const Extent extent : {Extent{48, 36}, Extent{35, 41}}) {
    for (const int channels : {1, 2, 3, 5, 8}) {
      const GaussianModel model = model_of(test_texture(extent, channels));
      const Support disc = disc_support(6);
      for (const Spectrum& start :
           {random_phase_start(spot_of(model), Seed{4}), white_start(spot_of(model), Seed{4})}) {
        for (const auto& [iterations, bound] : {std::pair{1, 2e-6}, {2, 1e-5}, {10, 1e-4}}) {
          const auto result = alternate_projections(model, disc, start, {.iterations = iterations});
          EXPECT_LT(
              difference(result.texton.kernels.front(), plain_projections(spot_of(model), disc, start, iterations)),
              bound)
              << iterations << " iterations, " << channels << " channels";
        }
      }
    }
  }
}

TEST(AlternatingProjections, VanishOutsideTheSupport) {
  const GaussianModel model = model_of(test_texture({40, 44}, 3));
  const Support disc = disc_support(7);
  const Texton texton = project(model, disc, 5).texton;
  EXPECT_EQ(texton.extent(), disc.box);
  EXPECT_EQ(texton.support_pixels, disc.pixels);
  EXPECT_EQ(texton.mean, model.mean);
  for (int y = 0; y < 15; ++y) {
    for (int x = 0; x < 15; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool inside = (x - 7) * (x - 7) + (y - 7) * (y - 7) <= 49;
        EXPECT_EQ(texton.kernels.front().at(c, x, y) != 0, inside) << x << " " << y;
      }
    }
  }
}

TEST(AlternatingProjections, OnTheWholeTorusTheModelIsExact) {
  for (const int channels : {1, 3}) {
    const GaussianModel model = model_of(test_texture({40, 27}, channels));
    const auto result = project(model, rectangle_support({40, 27}), 3);
    for (const double rme : result.summary.rme) {
      EXPECT_LT(rme, 2e-6);
    }
    const Autocovariance expected = autocovariance(model.spectrum);
    const Autocovariance actual = autocovariance(texton_spectrum(result.texton, {40, 27}));
    for (std::size_t i = 0; i < expected.planes.size(); ++i) {
      for (std::size_t k = 0; k < expected.planes[i].size(); ++k) {
        ASSERT_NEAR(actual.planes[i][k], expected.planes[i][k], 2e-6 * expected.planes[0][0]);
      }
    }
  }
}

TEST(AlternatingProjections, HistoryIsTheErrorOfEveryIterateAndNeverRises) {
  for (const int channels : {1, 3}) {
    const GaussianModel model = model_of(test_texture({48, 48}, channels));
    const auto result = project(model, square_support(13), 40);
    ASSERT_EQ(result.summary.iterations, 40);
    ASSERT_EQ(result.summary.rme.size(), 40U);
    EXPECT_EQ(result.summary.stop, ProjectionSummary::Stop::iterations);
    for (std::size_t n = 1; n < 40; ++n) {
      EXPECT_LE(result.summary.rme[n], result.summary.rme[n - 1] + 1e-6) << n;
    }
    for (const int n : {1, 2, 17}) {
      const double expected = relative_model_error(project(model, square_support(13), n).texton, model.spectrum);
      EXPECT_NEAR(result.summary.rme[static_cast<std::size_t>(n - 1)], expected, 1e-6) << n;
    }
  }
}

TEST(AlternatingProjections, AtAFixedPointLostVarianceIsTheSquaredError) {
  // A fixed point t is the orthogonal projection of p = IDFT(T s) onto images on S, so |p|² = |t|² + |p − t|², and the
  // error is |p − t|. The part of t at ξ = 0, which no p has, counts for both sides.
  const GaussianModel model = model_of(test_texture({64, 64}, 3));
  const auto result = project(model, square_support(15), 1000);
  const double variance = color_covariance(model.spectrum).trace();
  const double kept = color_covariance(result.texton).trace();
  const double rme = result.summary.rme.back();
  const double with_mean =
      color_covariance(result.texton).trace() - color_covariance(texton_spectrum(result.texton, {64, 64})).trace();
  EXPECT_NEAR(kept / variance, 1 - rme * rme - with_mean / variance, 5e-4);
}

/// The history of B-spline coefficients is the error of their noise, |α̂| b̂^{1/2} against |T|; what the projections do
/// not raise is the distance of |α̂| to |T| / b̂^{1/2}, the model that order 0 would be given.
TEST(AlternatingProjections, OfSplinesAreThoseOfTheWeightedModel) {
  for (const int order : {1, 2, 3}) {
    const GaussianModel model = model_of(test_texture({44, 48}, 3));
    GaussianModel weighted = model;
    Spectrum& spot = weighted.spectrum.factors.front();
    const SplineGain gain(order, spot.raster());
    for (int c = 0; c < 3; ++c) {
      for (int ky = 0; ky < spot.rows(); ++ky) {
        for (int kx = 0; kx < spot.columns(); ++kx) {
          spot.at(c, kx, ky) /= static_cast<float>(gain.column(kx) * gain.row(ky));
        }
      }
    }
    const Spectrum start = random_phase_start(spot_of(model), Seed{3});
    const auto splines = alternate_projections(model, square_support(13), start, {.iterations = 20, .order = order});
    const auto plain = alternate_projections(weighted, square_support(13), start, {.iterations = 20});
    EXPECT_EQ(difference(splines.texton.kernels.front(), plain.texton.kernels.front()), 0) << order;
    EXPECT_NEAR(splines.summary.rme.back(), relative_model_error(splines.texton, model.spectrum, order), 1e-6) << order;
    EXPECT_GT(std::fabs(splines.summary.rme.back() - plain.summary.rme.back()), 1e-4) << order;
  }
  const GaussianModel model = model_of(test_texture({20, 16}, 3));
  EXPECT_THROW(alternate_projections(model, square_support(5), white_start(spot_of(model), Seed{1}), {.order = 6}),
               std::invalid_argument);
}

TEST(AlternatingProjections, StopWhenTheErrorSettles) {
  const GaussianModel model = model_of(test_texture({48, 48}, 1));
  const Spectrum start = random_phase_start(spot_of(model), Seed{2});
  const auto result = alternate_projections(model, square_support(11), start, {.iterations = 5000, .tolerance = 1e-3});
  EXPECT_EQ(result.summary.stop, ProjectionSummary::Stop::tolerance);
  const std::vector<double>& rme = result.summary.rme;
  const auto made = static_cast<std::size_t>(result.summary.iterations);
  ASSERT_EQ(rme.size(), made);
  ASSERT_LT(made, 200U);
  EXPECT_LE(rme[made - 3] - rme[made - 2], 1e-3 * rme[made - 3]);
  EXPECT_GT(rme[made - 4] - rme[made - 3], 1e-3 * rme[made - 4]);
}

TEST(AlternatingProjections, SameSeedSameBitsWhateverTheThreads) {
  const GaussianModel model = model_of(test_texture({61, 48}, 3));
  const auto fit = [&](std::size_t threads, std::uint64_t seed) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return project(model, disc_support(9), 20, seed);
  };
  const auto one = fit(1, 1);
  const auto two = fit(2, 1);
  EXPECT_EQ(one.summary.rme, two.summary.rme);
  EXPECT_EQ(difference(one.texton.kernels.front(), two.texton.kernels.front()), 0);
  EXPECT_GT(difference(fit(2, 2).texton.kernels.front(), one.texton.kernels.front()), 0.1);
}

TEST(AlternatingProjections, RefuseWhatTheyCannotProject) {
  const GaussianModel model = model_of(test_texture({20, 16}, 3));
  const Spectrum start = white_start(spot_of(model), Seed{1});
  const auto with = [&](const Support& support, const Spectrum& from, const ProjectionOptions& options) {
    return [&model, support, from, options] { alternate_projections(model, support, from, options); };
  };
  const Support support = square_support(5);
  EXPECT_THAT(with(square_support(17), start, {}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("no more than the raster's 20x16")));
  EXPECT_THAT(with(support, Spectrum({20, 15}, 3), {}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("a start of 20x15x3, expected the exemplar's 20x16x3")));
  EXPECT_THAT(with(support, start, {.iterations = 0}), ThrowsMessage<std::invalid_argument>(HasSubstr("0 iterations")));
  EXPECT_THAT(with(support, start, {.tolerance = std::nan("")}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("tolerance nan")));
  GaussianModel two = model;
  two.spectrum.factors.push_back(spot_of(model));
  EXPECT_THAT([&] { alternate_projections(two, support, start, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("2 factors")));
}

// Numbers of the authors' code.

class Reference : public testing::Test {
 protected:
  void SetUp() override {
    reference_ = folder_from("TEXTONBENCH_REFERENCE");
    data_ = folder_from("TEXTONBENCH_DATA");
    if (!reference_ || !data_) {
      GTEST_SKIP() << "set TEXTONBENCH_REFERENCE and TEXTONBENCH_DATA to compare with the authors' numbers";
    }
  }
  nlohmann::json json(const char* name) const { return nlohmann::json::parse(std::ifstream(*reference_ / name)); }
  /// Values interleaved by channel, as an image.
  Image array(const std::string& name, Extent extent) const {
    const std::vector<double> values = read_npy(*reference_ / name);
    Image image(extent, 3);
    if (values.size() != static_cast<std::size_t>(extent.area() * 3)) {
      ADD_FAILURE() << name << " holds " << values.size() << " numbers";
      return image;
    }
    auto value = values.begin();
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          image.at(c, x, y) = static_cast<float>(*value++);
        }
      }
    }
    return image;
  }
  std::filesystem::path exemplar_file(const std::string& name) const { return *data_ / (name + ".png"); }
  GaussianModel exemplar_model(const std::string& name) const {
    return model_of(read_image(exemplar_file(name)).image);
  }
  /// Mean over three starts.
  static double mean_error(const GaussianModel& model, const Support& support, ColorCorrection correction,
                           int order = 0) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ProjectedTexton fitted = alternate_projections(
          model, support, random_phase_start(spot_of(model), Seed{seed}), {.iterations = 50, .order = order});
      sum += correct_colors(fitted.texton, model.spectrum, correction, order).rme_after / 3;
    }
    return sum;
  }

 private:
  std::optional<std::filesystem::path> reference_;
  std::optional<std::filesystem::path> data_;
};

using AlternatingProjectionsReference = Reference;

TEST_F(AlternatingProjectionsReference, IteratesFromAFixedStart) {
  const GaussianModel model = exemplar_model("0000_2");
  const Spectrum start = forward_fft(array("tv_init_randn_128x128x3_f64.npy", {128, 128}));
  const nlohmann::json vectors = json("test_vectors.json");
  for (const auto& [order, side] : {std::pair{0, 31}, {1, 30}, {3, 30}}) {
    for (const auto& [iterations, bound] : {std::pair{1, 2e-6}, {2, 1e-5}, {10, 2e-4}, {50, 2e-4}}) {
      const std::string name =
          "alpha_o" + std::to_string(order) + "_s" + std::to_string(side) + "_it" + std::to_string(iterations);
      const auto result =
          alternate_projections(model, square_support(side), start, {.iterations = iterations, .order = order});
      const double error = difference(result.texton.kernels.front(), array("tv_" + name + ".npy", {side, side}));
      EXPECT_LT(error, bound) << name;
      RecordProperty(name, std::to_string(error));
      EXPECT_NEAR(result.summary.rme.back(), vectors.at(name).at("rme").get<double>(), 1e-5) << name;
      EXPECT_NEAR(correct_colors(result.texton, model.spectrum, ColorCorrection::authors, order).rme_after,
                  vectors.at(name).at("rme_colorcorrected").get<double>(), 2e-5)
          << name;
    }
  }
}

TEST_F(AlternatingProjectionsReference, ErrorsOfSquaresAndDiscs) {
  const auto table = json("sot_order0_rme.json");
  for (const auto& row : table.at("square31")) {
    const GaussianModel model = exemplar_model(row.at("name"));
    EXPECT_NEAR(mean_error(model, square_support(31), ColorCorrection::none), row.at("sot50_raw_mean").get<double>(),
                0.006)
        << row.at("name");
    EXPECT_NEAR(mean_error(model, square_support(31), ColorCorrection::authors), row.at("sot50_cc_mean").get<double>(),
                0.006)
        << row.at("name");
  }
  for (const auto& row : table.at("radius")) {
    const GaussianModel model = exemplar_model(row.at("name"));
    const Support disc = disc_support(row.at("r").get<int>());
    EXPECT_EQ(disc.pixels, row.at("npix").get<std::int64_t>());
    EXPECT_NEAR(mean_error(model, disc, ColorCorrection::none), row.at("sot50_mean").get<double>(), 0.01)
        << row.at("name") << " " << row.at("r");
  }
}

TEST_F(AlternatingProjectionsReference, ErrorsOfTheAuthorsCode) {
  int compared = 0;
  const auto all = json("octave_textons_rme.json");
  for (const auto& row : all.at("table")) {
    const std::string name = row.at("name");
    const bool corrected = row.at("variant") == "corrected";
    if ((!corrected && row.at("variant") != "raw") || !std::filesystem::exists(exemplar_file(name))) {
      continue;
    }
    EXPECT_NEAR(mean_error(exemplar_model(name), square_support(row.at("s").get<int>()),
                           corrected ? ColorCorrection::authors : ColorCorrection::none, row.at("order").get<int>()),
                row.at("rme_mean").get<double>(), 0.012)
        << row.dump();
    ++compared;
  }
  EXPECT_GE(compared, 36);
}

}  // namespace textonbench::alternating_projections_test
