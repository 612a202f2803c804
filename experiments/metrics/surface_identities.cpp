#include "experiments/metrics/surface_identities.h"

#include <Eigen/Geometry>
#include <cmath>

#include "experiments/metrics/replicates.h"
#include "experiments/metrics/spline_law.h"
#include "methods/spot/spline_noise.h"
#include "methods/spot/surface_sum.h"

namespace textonbench {
namespace {

constexpr double surface_impacts = 60;
constexpr int surface_values = 8192;
constexpr int distant_rows = 128;  // of as many points

const SplineTexton* square_spline_texton(const Model& model) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return nullptr;
  const Extent extent = texton->coefficients.extent();
  const double side = extent.width + texton->order;
  return extent.width == extent.height && texton->support_area == side * side ? texton : nullptr;
}

/// Side r of the support.
double support_side(const SplineTexton& texton) { return std::sqrt(texton.support_area); }

/// λ, impacts a cubic pixel.
double volume_intensity(const SplineTexton& texton) { return surface_impacts / std::pow(support_side(texton), 3); }

Stream surface_stream(const Target& target, std::string_view metric) {
  return Stream(Seed{1}).child(metric).child(target.exemplar.name);
}

/// Its columns are u1, u2 and n: uniform over rotations.
Eigen::Matrix3d random_frame(RandomSequence& random) {
  const double a = random.normal(), b = random.normal(), c = random.normal(), d = random.normal();
  return Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix();
}

/// F of each channel at the origin with a random frame, then the number of impacts that reach it. Impacts are drawn in
/// a cube that holds the cube of side r in any frame.
std::vector<double> surface_value(const SplineTexton& texton, const Stream& stream) {
  RandomSequence random(stream);
  const Eigen::Matrix3d frame = random_frame(random);
  const double r = support_side(texton), bound = std::sqrt(3.0) * r;
  const double center = (texton.coefficients.extent().width - 1) / 2.0;
  const int channels = texton.coefficients.channels();
  std::vector<double> values(static_cast<std::size_t>(channels) + 1);
  for (auto left = random.poisson(volume_intensity(texton) * std::pow(bound, 3)); left > 0; --left) {
    const double x = random.uniform() - 0.5, y = random.uniform() - 0.5, z = random.uniform() - 0.5;
    const Eigen::Vector3d d = frame.transpose() * (bound * Eigen::Vector3d(x, y, z));
    if (d.cwiseAbs().maxCoeff() >= r / 2) continue;
    const double weight = 1 - 2 / r * std::fabs(d.z());
    for (int c = 0; c < channels; ++c) {
      values[static_cast<std::size_t>(c)] += weight * spline_kernel(texton, c, d.x() + center, d.y() + center);
    }
    values.back() += 1;
  }
  return values;
}

/// λ (r/2) ∫h, which is that times Σ α: a B-spline has the integral 1.
std::vector<double> surface_mean(const SplineTexton& texton) {
  const Image& kernel = texton.coefficients.kernels.front();
  std::vector<double> mean;
  mean.reserve(static_cast<std::size_t>(kernel.channels()));
  for (int c = 0; c < kernel.channels(); ++c) {
    double sum = 0;
    for (int y = 0; y < kernel.height(); ++y) {
      for (const float value : kernel.row(c, y)) sum += value;
    }
    mean.push_back(volume_intensity(texton) * support_side(texton) / 2 * sum);
  }
  return mean;
}

/// Mean square over points of values less the mean of each channel, channels added.
double variance_about(std::span<const float> values, std::span<const double> mean) {
  const std::size_t points = values.size() / mean.size();
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += std::pow(values[i] - mean[i / points], 2);
  return sum / static_cast<double>(points);
}

}  // namespace

std::optional<double> surface_mean_deviation(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = square_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const Stream stream = surface_stream(target, "surface_mean_deviation");
  const Replicates replicates = draw_replicates(surface_values, [&](int i) {
    const std::vector<double> values = surface_value(*texton, stream.child(static_cast<std::uint64_t>(i)));
    return std::vector<float>(values.begin(), values.end() - 1);
  });
  return largest_deviation(replicates, surface_mean(*texton));
}

std::optional<double> surface_variance_deviation(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = square_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const Stream stream = surface_stream(target, "surface_variance_deviation");
  const std::vector<double> mean = surface_mean(*texton);
  const Replicates replicates = draw_replicates(surface_values, [&](int i) {
    const std::vector<double> values = surface_value(*texton, stream.child(static_cast<std::uint64_t>(i)));
    std::vector<float> squares;
    squares.reserve(mean.size());
    for (std::size_t c = 0; c < mean.size(); ++c) {
      squares.push_back(static_cast<float>(std::pow(values[c] - mean[c], 2)));
    }
    return squares;
  });
  const SplineCovariance covariance(*texton);
  std::vector<double> expected;
  expected.reserve(mean.size());
  for (int c = 0; c < covariance.channels(); ++c) {
    expected.push_back(volume_intensity(*texton) * support_side(*texton) / 3 * covariance.at(c, 0, 0));
  }
  return largest_deviation(replicates, expected);
}

std::optional<double> surface_impacts_ratio(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = square_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const Stream stream = surface_stream(target, "surface_impacts_ratio");
  const Replicates counts = draw_replicates(surface_values, [&](int i) {
    return std::vector{static_cast<float>(surface_value(*texton, stream.child(static_cast<std::uint64_t>(i))).back())};
  });
  double sum = 0;
  for (const std::vector<float>& count : counts) sum += count.front();
  return sum / surface_values / surface_impacts;
}

std::optional<double> surface_variance_ratio(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = square_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const double distance = 2 * support_side(*texton);  // above √3 sides
  RandomSequence random(surface_stream(target, "surface_variance_ratio"));
  std::vector<Point2> of_plane;
  std::vector<SurfacePoint> of_surface;
  of_plane.reserve(std::size_t{distant_rows} * distant_rows);
  of_surface.reserve(of_plane.capacity());
  for (int i = 0; i < distant_rows; ++i) {
    for (int j = 0; j < distant_rows; ++j) {
      const Point2 place{distance * i + random.uniform(), distance * j + random.uniform()};
      const Eigen::Matrix3d frame = random_frame(random);
      of_plane.push_back(place);
      of_surface.push_back({{place.x, place.y, 0}, frame.col(0), frame.col(1), frame.col(2)});
    }
  }
  const std::vector<double>& mean = texton->coefficients.mean;
  const Seed seed = derive(Seed{1}, target.exemplar.name);
  std::vector<float> plane(of_plane.size() * mean.size()), surface(plane.size());
  make_spline_noise(*texton, {.mni = surface_impacts})->procedural()->evaluate(of_plane, seed, plane);
  SurfaceSum(*texton, {.mni = surface_impacts}).evaluate(of_surface, seed, surface);
  return variance_about(surface, mean) / variance_about(plane, mean);
}

}  // namespace textonbench
