#include "methods/spot/mixing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "methods/base/image_io.h"
#include "tests/base/scratch_folder.h"
#include "tests/texture.h"

namespace textonbench::mixing_test {

/// Waves of one frequency and random phase and direction within a narrow fan, in colors that differ: mean `level`.
Exemplar wavy_exemplar(double frequency, float level, std::uint64_t seed) {
  Exemplar exemplar{"waves", Image({48, 48}, 3), std::string(64, '0')};
  RandomSequence random(Stream(Seed{seed}));
  for (int wave = 0; wave < 12; ++wave) {
    const double phase = 2 * std::numbers::pi * random.uniform();
    const double kx = std::round(frequency * 48 + 2 * random.normal()) / 48;
    const double ky = std::round(3 * random.normal()) / 48;
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 48; ++x) {
          exemplar.pixels.at(c, x, y) += static_cast<float>(
              (wave == 0 ? level : 0) + 0.02 * (c + 1) * std::cos(2 * std::numbers::pi * (kx * x + ky * y) + phase));
        }
      }
    }
  }
  return exemplar;
}

std::unique_ptr<Model> mix(const Exemplar& first, const Exemplar& second,
                           const std::map<std::string, ParamValue>& given) {
  std::map<std::string, ParamValue> options{{"support", std::int64_t{15}}, {"kernels", std::int64_t{5}}};
  options.insert(given.begin(), given.end());
  const MethodEntry& entry = find_method("mixing");
  return entry.analyze({first, &second}, Params(entry.params, options), Seed{1});
}

struct Statistics {
  double mean = 0, variance = 0, change = 0;  ///< of one channel; mean square of the difference of neighbors in a row
};

Statistics statistics_of(const Image& image, int channel) {
  Statistics s;
  const double count = static_cast<double>(image.height()) * (image.width() - 1);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      s.mean += image.at(channel, x, y) / count;
      s.change += std::pow(image.at(channel, x + 1, y) - image.at(channel, x, y), 2) / count;
    }
  }
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      s.variance += std::pow(image.at(channel, x, y) - s.mean, 2) / count;
    }
  }
  return s;
}

// Before the start and behind the end the noise has the law of either texture's own texton noise, to within what two
// independent samples of some 1000 effective values differ (5 standard errors or more).
TEST(MixingTest, EndsHaveTheLawsOfTheTextures) {
  const Exemplar first = wavy_exemplar(0.08, 0.3F, 1);
  const Exemplar second = wavy_exemplar(0.3, 0.7F, 2);
  for (const char* impacts : {"stratified", "signed_poisson"}) {
    const auto model = mix(first, second, {{"start", 1000.0}, {"length", 100.0}, {"impacts", std::string(impacts)}});
    const MethodEntry& noise = find_method("texton_noise");
    const Params params(noise.params, {{"support", std::int64_t{15}}});
    for (const auto& [exemplar, left] : {std::pair{&first, 500}, {&second, 1200}}) {
      const Image mixed = model->synthesize({.size = {400, 400}, .origin = {static_cast<double>(left), 0}}, Seed{3});
      const auto alone = noise.analyze({*exemplar}, params, Seed{1});
      const Image expected = alone->synthesize({.size = {400, 400}}, Seed{4});
      for (int c = 0; c < 3; ++c) {
        const Statistics found = statistics_of(mixed, c);
        const Statistics wanted = statistics_of(expected, c);
        EXPECT_NEAR(found.mean, wanted.mean, 0.01);
        EXPECT_NEAR(found.variance / wanted.variance, 1, 0.15) << impacts << ' ' << c;
        EXPECT_NEAR(found.change / wanted.change, 1, 0.15) << impacts << ' ' << c;
      }
    }
  }
}

TEST(MixingTest, TheMeanMovesAlongTheWay) {
  const Exemplar first = wavy_exemplar(0.08, 0.3F, 1);
  const Exemplar second = wavy_exemplar(0.3, 0.7F, 2);
  const auto model = mix(first, second, {{"length", 400.0}});
  const Image column = model->synthesize({.size = {1, 20000}, .origin = {100, 0}}, Seed{3});
  double mean = 0;
  for (int y = 0; y < column.height(); ++y) {
    mean += column.at(1, 0, y) / 20000.0;
  }
  EXPECT_NEAR(mean, 0.75 * 0.3 + 0.25 * 0.7, 0.01);
  EXPECT_EQ(model->gaussian(), nullptr);
}

TEST(MixingTest, AMapTellsTheShare) {
  const ScratchFolder folder;
  const Exemplar first = wavy_exemplar(0.08, 0.3F, 1);
  const Exemplar second = wavy_exemplar(0.3, 0.7F, 2);
  Image map({40, 30}, 1);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      map.at(0, x, y) = x < 20 ? 0.0F : 1.0F;
    }
  }
  write_image(map, folder.path() / "map.png");
  const auto by_map = mix(first, second, {{"map", (folder.path() / "map.png").string()}});
  const auto by_place = mix(first, second, {{"start", 19.5}, {"length", 1.0}});
  const Domain domain{.size = {120, 60}, .origin = {-40, -10}};
  const Image a = by_map->synthesize(domain, Seed{5});
  const Image b = by_place->synthesize(domain, Seed{5});
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 120; ++x) {
      // An impact within the pixel where one texture ends may see the other one.
      const double slack = std::abs(x - 60) < 20 ? 0.5 : 1e-5;
      ASSERT_NEAR(a.at(0, x, y), b.at(0, x, y), slack) << x << ' ' << y;
    }
  }
  map.at(0, 3, 4) = 2.0F;
  write_image(map, folder.path() / "map.exr");
  EXPECT_THROW(mix(first, second, {{"map", (folder.path() / "map.exr").string()}}), std::invalid_argument);
}

TEST(MixingTest, WhatCannotBeMixedIsRefusedWithTheReason) {
  const MethodEntry& entry = find_method("mixing");
  const Params params(entry.params, {{"support", std::int64_t{5}}});
  const Domain domain{.size = {20, 20}};
  const Exemplar first = test_exemplar({20, 20}, 3);
  const Exemplar wide = test_exemplar({24, 20}, 3);
  EXPECT_THAT(entry.refuses({first}, params, domain).value_or(""), testing::HasSubstr("-p second=EXEMPLAR"));
  EXPECT_THAT(entry.refuses({first, &wide}, params, domain).value_or(""), testing::HasSubstr("to one size"));
  EXPECT_THAT(entry.refuses({first, &first}, params, {.size = {20, 20}, .periodic = true}).value_or(""),
              testing::HasSubstr("torus"));
  EXPECT_EQ(entry.refuses({first, &first}, params, domain), std::nullopt);
}

}  // namespace textonbench::mixing_test
