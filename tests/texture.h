// Small textures for tests, and the files that some tests read when a variable names their folder.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "methods/base/exemplar.h"
#include "methods/base/random.h"

namespace textonbench {

/// Correlated colors, oriented, not periodic (a gradient crosses the border), about 0.5 ± 0.1.
inline Image test_texture(Extent extent, int channels, std::uint64_t seed = 1) {
  Image image(extent, channels);
  const Stream stream = Stream(Seed{seed}).child("test texture");
  std::vector<float> white(static_cast<std::size_t>(extent.width + 1 + Image::max_channels));
  for (int y = 0; y < extent.height; ++y) {
    fill_normal(stream, static_cast<std::uint64_t>(y), 0, white);
    for (int x = 0; x < extent.width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const float smooth = white[i] + white[i + 1] + white[i + 2];
      for (int c = 0; c < channels; ++c) {
        const float other = white[i + 1 + static_cast<std::size_t>(c)];
        image.at(c, x, y) = 0.5F + 0.04F * smooth + 0.02F * static_cast<float>(c) * other +
                            0.1F * static_cast<float>(x) / static_cast<float>(extent.width);
      }
    }
  }
  return image;
}

inline Exemplar test_exemplar(Extent extent, int channels, std::uint64_t seed = 1) {
  return {"test_texture", test_texture(extent, channels, seed), std::string(64, '0')};
}

inline std::optional<std::filesystem::path> folder_from(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::nullopt : std::optional<std::filesystem::path>(value);
}

/// Values of a float32 or float64 .npy file, row by row.
inline std::vector<double> read_npy(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  const std::string all = bytes.str();
  const bool single_precision = all.find("'<f4'") != std::string::npos;
  if (all.size() < 10 || (!single_precision && all.find("'<f8'") == std::string::npos) ||
      all.find("'fortran_order': False") == std::string::npos) {
    ADD_FAILURE() << file << " is not a row-by-row float32 or float64 .npy file";
    return {};
  }
  const std::size_t header = 10 + static_cast<unsigned char>(all[8]) + 256U * static_cast<unsigned char>(all[9]);
  const auto copied = [&](auto values) {
    std::memcpy(values.data(), all.data() + header, values.size() * sizeof(values[0]));
    return values;
  };
  const std::size_t size = all.size() - header;
  if (!single_precision) return copied(std::vector<double>(size / sizeof(double)));
  const std::vector<float> values = copied(std::vector<float>(size / sizeof(float)));
  return {values.begin(), values.end()};
}

/// Largest distance between the empirical distribution of `values` and a continuous distribution function, times
/// sqrt(n): above 2.7 with probability 1e-6 (Kolmogorov's distribution, 2 exp(−2 d²)).
template <class Cdf>
double kolmogorov_distance(std::vector<double> values, const Cdf& cdf) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double largest = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double p = cdf(values[i]);
    largest =
        std::max({largest, std::fabs(p - static_cast<double>(i) / n), std::fabs(static_cast<double>(i + 1) / n - p)});
  }
  return largest * std::sqrt(n);
}

}  // namespace textonbench
