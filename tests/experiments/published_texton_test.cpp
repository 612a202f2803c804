// Noise of the textons that the authors of Texton Noise published, where TEXTONBENCH_DATA has their folder "textons".
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "experiments/model_file.h"
#include "methods/spot/spline_moments.h"
#include "methods/spot/spline_noise.h"

namespace textonbench::published_texton_test {

std::vector<std::filesystem::path> published_textons() {
  std::vector<std::filesystem::path> files;
  const char* data = std::getenv("TEXTONBENCH_DATA");
  if (data == nullptr) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    if (entry.path().extension() == ".texton") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// ∫ h², from the coefficients and the covariance b of linear splines, by plain sums.
double variance_of(const Image& alpha, int channel) {
  const double b[3] = {1.0 / 6, 2.0 / 3, 1.0 / 6};
  double sum = 0;
  for (int y = 0; y < alpha.height(); ++y) {
    for (int x = 0; x < alpha.width(); ++x) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= alpha.width() || y + dy >= alpha.height()) continue;
          sum += b[dx + 1] * b[dy + 1] * double(alpha.at(channel, x, y)) * double(alpha.at(channel, x + dx, y + dy));
        }
      }
    }
  }
  return sum;
}

// Points further apart than the kernels reach are independent but for the cells that they share. Six numbers a file,
// each off by 5 of its standard errors with probability 6e-7.
TEST(PublishedTextons, HaveTheMeanAndTheVarianceOfTheirCoefficients) {
  const std::vector<std::filesystem::path> files = published_textons();
  if (files.empty()) GTEST_SKIP() << "set TEXTONBENCH_DATA to a folder with the authors' .texton files";
  constexpr int side = 72;
  constexpr double mni = 30;
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.filename());
    const ModelFile read = read_texton_as_model(file);
    ASSERT_EQ(read.order, 1);
    const SplineTexton texton = read.spline_texton();
    const std::vector<double> kurtosis = spline_kurtosis(texton);
    const auto noise = make_spline_noise(texton, {.impacts = ImpactProcess::poisson, .mni = mni});
    const double apart = 3.7 * texton.coefficients.extent().width + 5;
    std::vector<Point2> points;
    points.reserve(side * side);
    for (int i = 0; i < side * side; ++i) points.push_back({i % side * apart, i / side * apart});
    std::vector<float> values(3 * points.size());
    noise->procedural()->evaluate(points, Seed{1}, values);
    const auto count = static_cast<double>(points.size());
    for (std::size_t c = 0; c < 3; ++c) {
      const double expected = variance_of(texton.coefficients.kernels.front(), static_cast<int>(c));
      double mean = 0, variance = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double off = double(values[c * points.size() + i]) - texton.coefficients.mean[c];
        mean += off / count;
        variance += off * off / count;
      }
      EXPECT_LT(std::abs(mean), 5 * std::sqrt(expected / count)) << c;
      EXPECT_LT(std::abs(variance / expected - 1), 5 * std::sqrt((2 + kurtosis[c] / mni) / count)) << c;
    }
  }
}

}  // namespace textonbench::published_texton_test
