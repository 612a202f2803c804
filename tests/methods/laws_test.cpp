// The laws that every method of the catalogue keeps.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Core>
#include <complex>
#include <limits>
#include <map>
#include <numbers>

#include "methods/base/masks.h"
#include "methods/method.h"
#include "tests/texture.h"

namespace textonbench::laws_test {

/// The defaults, but for a support that fits into the small exemplars of these tests. A second texture, where a method
/// takes one, is the first again.
Params small_params(const MethodEntry& entry) {
  std::map<std::string, ParamValue> given;
  if (std::ranges::find(entry.params, "support", &ParamSpec::name) != entry.params.end()) {
    given["support"] = std::int64_t{5};
  }
  if (entry.name == "surface_noise") {
    given["surface"] = std::string("plane");  // the others are pictures, not fields
  }
  if (entry.name == "filtered_noise") {
    given["view"] = std::string("plane");
  }
  if (entry.name == "lrp") {
    given["cosines"] = std::int64_t{6};
    given["strata"] = std::int64_t{2};
  }
  if (entry.name == "inpainting") {
    given["nugget"] = 0.01;  // eight channels of a small texture depend on each other
  }
  return Params(entry.params, given);
}

/// A square hole in the middle, for methods that are told what is known.
const Observation& observed_of(Extent size) {
  static std::map<std::pair<int, int>, Observation> all;
  const auto [place, is_new] = all.try_emplace({size.width, size.height});
  if (is_new) {
    place->second.missing = std::min(size.width, size.height) < 3 ? Mask({1, 1}) : make_mask("square", 10, size);
  }
  return place->second;
}

/// An exemplar of about that size, as small as the method serves.
Exemplar exemplar_for(const MethodEntry& entry, Extent size, int channels) {
  const int more = entry.name == "lrp" ? 24 : 0;  // it takes a spectrum of 32 x 32 bins
  return test_exemplar({size.width + more, size.height + more}, channels);
}

Problem problem_of(const Exemplar& exemplar) { return {exemplar, &exemplar, &observed_of(exemplar.pixels.extent())}; }

std::unique_ptr<Model> fit(const MethodEntry& entry, const Exemplar& exemplar) {
  return entry.analyze(problem_of(exemplar), small_params(entry), Seed{3});
}

/// Whether the method serves exemplars of so many channels, on a torus or on the plane.
bool serves(const MethodEntry& entry, int channels) {
  const Exemplar color = exemplar_for(entry, {12, 10}, channels);
  return !entry.refuses(problem_of(color), small_params(entry), {.size = {12, 10}, .periodic = true}) ||
         !entry.refuses(problem_of(color), small_params(entry), {.size = {12, 10}});
}

/// The numbers of channels that the method serves.
std::vector<int> served_channels(const MethodEntry& entry) {
  return serves(entry, 8) ? std::vector{1, 3, 8} : serves(entry, 3) ? std::vector{1, 3} : std::vector{1};
}

/// The domains that a method serves among a torus and a window of the exemplar's size, a smaller window and a larger
/// one.
std::vector<Domain> served_domains(const MethodEntry& entry, const Exemplar& exemplar) {
  std::vector<Domain> domains;
  const Extent size = exemplar.pixels.extent();
  for (const Domain& domain : {Domain{.size = size, .periodic = true}, Domain{.size = size}, Domain{.size = {11, 7}},
                               Domain{.size = {size.width + 9, size.height + 4}, .origin = {-5, 3}}}) {
    if (!entry.refuses(problem_of(exemplar), small_params(entry), domain)) {
      domains.push_back(domain);
    }
  }
  return domains;
}

void expect_same_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.extent(), b.extent());
  ASSERT_EQ(a.channels(), b.channels());
  for (int c = 0; c < a.channels(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      ASSERT_EQ(std::memcmp(a.row(c, y).data(), b.row(c, y).data(), a.row(c, y).size_bytes()), 0) << c << " " << y;
    }
  }
}

class Laws : public testing::TestWithParam<std::string> {
 protected:
  const MethodEntry& entry() const { return find_method(GetParam()); }
};

TEST_P(Laws, DescribesItself) {
  EXPECT_FALSE(entry().title.empty());
  EXPECT_FALSE(entry().reference.empty());
  for (const ParamSpec& spec : entry().params) {
    EXPECT_FALSE(spec.help.empty()) << spec.name;
  }
  EXPECT_NO_THROW(Params(entry().params, {})) << "the defaults are in range";
}

TEST_P(Laws, SameSeedSameBitsWhateverTheThreads) {
  for (const int channels : served_channels(entry())) {
    const Exemplar exemplar = exemplar_for(entry(), {48, 35}, channels);
    for (const Domain& domain : served_domains(entry(), exemplar)) {
      Image first;
      {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        first = fit(entry(), exemplar)->synthesize(domain, Seed{7});
      }
      const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
      const auto model = fit(entry(), exemplar);
      for (int repeat = 0; repeat < 3; ++repeat) {
        expect_same_bits(first, model->synthesize(domain, Seed{7}));
      }
      const int x = domain.size.width / 2, y = domain.size.height / 2;  // known pixels are the same in all samples
      EXPECT_NE(first.at(0, x, y), model->synthesize(domain, Seed{8}).at(0, x, y)) << "another seed, another sample";
    }
  }
}

TEST_P(Laws, SampleHasTheDomainsSizeAndTheExemplarsChannels) {
  for (const int channels : served_channels(entry())) {
    const Exemplar exemplar = exemplar_for(entry(), {20, 31}, channels);
    const auto domains = served_domains(entry(), exemplar);
    ASSERT_FALSE(domains.empty());
    for (const Domain& domain : domains) {
      const auto model = fit(entry(), exemplar);
      const Image sample = model->synthesize(domain, Seed{1});
      EXPECT_EQ(sample.extent(), domain.size);
      EXPECT_EQ(sample.channels(), channels);
      EXPECT_FALSE(find_non_finite(sample));
      const Footprint cost = model->footprint(domain);
      EXPECT_GT(cost.model_bytes, 0U);
      EXPECT_GT(cost.operations_per_pixel, 0);
    }
  }
}

/// Mean over seeds of the matrix periodogram Z_c conj Z_d / |Ω| of a sample minus the model's mean, against its
/// expectation from the closed form: the DFT of Γ(v) times the window's own autocorrelation (all ones on a torus).
TEST_P(Laws, AveragedCrossPeriodogramIsThatOfTheClosedForm) {
  const int channels = std::min(3, served_channels(entry()).back());  // stack_test looks at more
  const Exemplar exemplar = exemplar_for(entry(), {14, 9}, channels);
  const auto model = fit(entry(), exemplar);
  const Gaussian* law = model->gaussian();
  if (law == nullptr) {
    GTEST_SKIP() << entry().name << " has no law in closed form";
  }
  for (const Domain& domain : served_domains(entry(), exemplar)) {
    const auto [w, h] = domain.size;
    const Extent grid =
        domain.periodic ? domain.size : Extent{2 * (w + exemplar.pixels.width()), 2 * (h + exemplar.pixels.height())};
    const CrossSpectrum p = law->spectrum(grid);
    const Autocovariance gamma = autocovariance(p);
    Spectrum expected[3][3];
    for (int c = 0; c < channels; ++c) {
      for (int d = 0; d < channels; ++d) {
        // autocovariance() leaves ξ = 0 out, where the noise of a cropped texton has power.
        double constant = 0;
        for (const Spectrum& factor : p.factors) {
          constant += static_cast<double>(factor.at(c, 0, 0).real()) * static_cast<double>(factor.at(d, 0, 0).real()) /
                      static_cast<double>(grid.area());
        }
        Image lags(domain.size, 1);
        for (int vy = domain.periodic ? 0 : 1 - h; vy < h; ++vy) {
          for (int vx = domain.periodic ? 0 : 1 - w; vx < w; ++vx) {
            const double taper = domain.periodic ? 1 : (1 - std::abs(vx) / double(w)) * (1 - std::abs(vy) / double(h));
            lags.at(0, (vx + w) % w, (vy + h) % h) += static_cast<float>(taper * (gamma.at(c, d, vx, vy) + constant));
          }
        }
        expected[c][d] = forward_fft(lags);
      }
    }

    constexpr int samples = 1500;
    const int bins = w / 2 + 1;
    // Per entry, bin and part (real, imaginary): sum and sum of squares.
    const auto count = static_cast<std::size_t>(channels * channels * h * bins * 2);
    std::vector<double> sums(count);
    std::vector<double> squares(count);
    const std::vector<double> mean = law->mean();
    for (int k = 0; k < samples; ++k) {
      Image sample = model->synthesize(domain, derive(Seed{11}, static_cast<std::uint64_t>(k)));
      for (int c = 0; c < channels; ++c) {
        for (int y = 0; y < h; ++y) {
          for (float& v : sample.row(c, y)) {
            v -= static_cast<float>(mean[static_cast<std::size_t>(c)]);
          }
        }
      }
      const Spectrum z = forward_fft(sample);
      std::size_t i = 0;
      for (int c = 0; c < channels; ++c) {
        for (int d = 0; d < channels; ++d) {
          for (int ky = 0; ky < h; ++ky) {
            for (int kx = 0; kx < bins; ++kx) {
              const std::complex<double> product = std::complex<double>(z.at(c, kx, ky)) *
                                                   std::conj(std::complex<double>(z.at(d, kx, ky))) / double(w * h);
              for (const double part : {product.real(), product.imag()}) {
                sums[i] += part;
                squares[i] += part * part;
                ++i;
              }
            }
          }
        }
      }
    }
    double largest = 0;
    for (int c = 0; c < channels; ++c) {
      for (int ky = 0; ky < h; ++ky) {
        for (int kx = 0; kx < bins; ++kx) {
          largest = std::max(largest, static_cast<double>(expected[c][c].at(0, kx, ky).real()));
        }
      }
    }
    // About 8000 comparisons a domain; averages of 1500 products of nearly Gaussian numbers leave 7 standard errors
    // with probability below 1e-9 each (their skewness included), so a false alarm has probability below 1e-4.
    std::size_t i = 0;
    for (int c = 0; c < channels; ++c) {
      for (int d = 0; d < channels; ++d) {
        for (int ky = 0; ky < h; ++ky) {
          for (int kx = 0; kx < bins; ++kx) {
            const std::complex<double> value(expected[c][d].at(0, kx, ky));
            for (const double part : {value.real(), value.imag()}) {
              const double average = sums[i] / samples;
              const double variance = std::max(0.0, squares[i] / samples - average * average);
              const double rounding = 2e-6 * largest;
              ASSERT_NEAR(average, part, 7 * std::sqrt(variance / samples) + rounding)
                  << entry().name << " " << w << "x" << h << " channels " << c << d << " bin " << kx << "," << ky;
              ++i;
            }
          }
        }
      }
    }
  }
}

TEST_P(Laws, WindowsOfOneFieldAgreeWhereTheyOverlap) {
  const int channels = served_channels(entry()).back();
  const Exemplar exemplar = exemplar_for(entry(), {16, 12}, channels);
  const double far = 1e12;
  for (const Point2 origin : {Point2{0, 0}, Point2{-30, -11}, Point2{far, -far}}) {
    const Domain first{.size = {40, 30}, .origin = origin};
    if (entry().refuses(problem_of(exemplar), small_params(entry()), first)) {
      GTEST_SKIP() << entry().name << " is not defined on the plane";
    }
    const auto model = fit(entry(), exemplar);
    const Domain second{.size = {23, 37}, .origin = {origin.x + 17, origin.y + 6}};
    const Image a = model->synthesize(first, Seed{5});
    const Image b = model->synthesize(second, Seed{5});
    const Eigen::MatrixXd colors = color_covariance(gaussian_model(a).spectrum);
    for (int c = 0; c < channels; ++c) {
      const double deviation = std::sqrt(colors(c, c));
      for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 23; ++x) {
          ASSERT_NEAR(a.at(c, x + 17, y + 6), b.at(c, x, y), 1e-5 * deviation) << x << " " << y;
        }
      }
    }
  }
}

TEST_P(Laws, SaysWhyItRefusesADomainAndThrowsTheSame) {
  const Exemplar exemplar = exemplar_for(entry(), {20, 16}, served_channels(entry()).back());
  const auto model = fit(entry(), exemplar);
  int refused = 0;
  for (const Domain& domain : {Domain{.size = {19, 16}, .periodic = true}, Domain{.size = {20, 16}, .step = 0.5},
                               Domain{.size = {20, 16}, .origin = {0.5, 0}}, Domain{.size = {20, 16}}}) {
    const auto reason = entry().refuses(problem_of(exemplar), small_params(entry()), domain);
    if (!reason) {
      EXPECT_NO_THROW(model->synthesize(domain, Seed{1}));
      continue;
    }
    ++refused;
    EXPECT_GT(reason->size(), 20U) << "a reason in words";
    try {
      model->synthesize(domain, Seed{1});
      ADD_FAILURE() << entry().name << " made a sample that it refuses: " << *reason;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(*reason, error.what());
    }
  }
  RecordProperty("refused", refused);
}

TEST_P(Laws, RefusesAnUnusableExemplarByName) {
  Exemplar not_finite = test_exemplar({8, 8}, 3);
  not_finite.pixels.at(1, 5, 2) = std::numeric_limits<float>::quiet_NaN();
  Exemplar constant{"constant", Image({8, 8}, 1), ""};
  std::vector<Exemplar> unusable;
  unusable.push_back({"empty", Image(), ""});
  unusable.push_back({"one_pixel", Image({1, 1}, 3), ""});
  unusable.push_back({"other_maps", test_texture({8, 8}, 2), "", {{"height", 1}}});
  unusable.push_back(std::move(constant));
  not_finite.name = "not_finite";
  unusable.push_back(std::move(not_finite));
  for (const Exemplar& exemplar : unusable) {
    try {
      fit(entry(), exemplar);
      ADD_FAILURE() << entry().name << " accepted the exemplar " << exemplar.name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(exemplar.name), std::string::npos) << error.what();
    }
  }
}

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : method_catalog()) {
    names.emplace_back(entry.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Catalog, Laws, testing::ValuesIn(all_names()),
                         [](const auto& instance) { return instance.param; });

TEST(Catalog, NamesTheNearestMethod) {
  try {
    find_method("adns");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"adsn\""), std::string::npos) << error.what();
  }
}

}  // namespace textonbench::laws_test
