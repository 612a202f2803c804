#include "experiments/metrics/mixing_identities.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/metrics/transport_identities.h"
#include "methods/base/parallel.h"
#include "methods/base/spectrum.h"
#include "methods/spot/barycenter.h"
#include "methods/spot/sot.h"

namespace textonbench {
namespace {

constexpr Extent dense_torus{8, 8}, mixed_torus{64, 64};
constexpr int strips = 21;

std::optional<std::pair<Exemplar, Exemplar>> crops_to_mix(const Target& target, Extent extent) {
  const Image& u = target.exemplar.pixels;
  const int left = u.width() / 2, top = u.height() / 2;
  if (left < extent.width || top < extent.height) return std::nullopt;
  std::pair crops{Exemplar{"corner", crop(u, 0, 0, extent), {}}, Exemplar{"middle", crop(u, left, top, extent), {}}};
  for (const Exemplar* part : {&crops.first, &crops.second}) {
    if (color_covariance(gaussian_model(part->pixels).spectrum).trace() < 1e-12) return std::nullopt;
  }
  return crops;
}

/// Of the law whose only factor is `spot`, the normalized one: window_covariance divides by the root of the area again.
Eigen::MatrixXd dense_covariance(const GaussianModel& model) {
  const Extent extent = model.spectrum.grid();
  return static_cast<double>(extent.area()) * window_covariance(inverse_fft(model.spectrum.factors.front()), extent);
}

double mean_neighbor_correlation(const std::vector<Image>& textons) {
  const auto product = [](const Image& a, const Image& b) {
    double sum = 0;
    for (int c = 0; c < a.channels(); ++c) {
      for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) sum += static_cast<double>(a.at(c, x, y)) * b.at(c, x, y);
      }
    }
    return sum;
  };
  double sum = 0;
  for (std::size_t r = 1; r < textons.size(); ++r) {
    const Image &a = textons[r - 1], &b = textons[r];
    sum += product(a, b) / std::sqrt(product(a, a) * product(b, b));
  }
  return sum / static_cast<double>(textons.size() - 1);
}

std::optional<double> strip_texton_correlation(const Target& target, bool one_start) {
  const auto crops = crops_to_mix(target, mixed_torus);
  if (!crops) return std::nullopt;
  const GaussianModel first = gaussian_model(periodic_component(crops->first.pixels));
  const GaussianModel second = gaussian_model(periodic_component(crops->second.pixels));
  const Support support = square_support(15);
  std::vector<Image> textons(strips);
  parallel_for(strips, [&](int r) {
    const Seed seed = one_start ? Seed{1} : derive(Seed{1}, static_cast<std::uint64_t>(r));
    const GaussianModel between = barycenter(first, second, r / (strips - 1.0));
    textons[static_cast<std::size_t>(r)] =
        fit_sot(between, support, {.projections = {.order = 1}}, seed).texton.kernels.front();
  });
  return mean_neighbor_correlation(textons);
}

}  // namespace

std::optional<double> barycenter_distance_error(const Model&, const Target& target, const Domain&) {
  const auto crops = crops_to_mix(target, dense_torus);
  if (!crops) return std::nullopt;
  const GaussianModel first = gaussian_model(crops->first.pixels), second = gaussian_model(crops->second.pixels);
  const Eigen::MatrixXd start = window_covariance(crops->first.pixels, dense_torus);
  const Eigen::MatrixXd end = window_covariance(crops->second.pixels, dense_torus);
  const double whole = std::sqrt(bures_distance_squared(start, end));
  double error = 0;
  for (const double rho : {0.25, 0.5, 0.75}) {
    const Eigen::MatrixXd between = dense_covariance(barycenter(first, second, rho));
    const double before = std::sqrt(bures_distance_squared(start, between));
    const double after = std::sqrt(bures_distance_squared(between, end));
    error = std::max({error, std::fabs(before / whole - rho), std::fabs(after / whole - (1 - rho))});
  }
  return error;
}

std::optional<double> barycenter_end_error(const Model&, const Target& target, const Domain&) {
  const auto crops = crops_to_mix(target, dense_torus);
  if (!crops) return std::nullopt;
  const GaussianModel first = gaussian_model(crops->first.pixels), second = gaussian_model(crops->second.pixels);
  double error = 0, largest = 0;
  for (const auto& [crop, rho] : {std::pair{&crops->first, 0.0}, std::pair{&crops->second, 1.0}}) {
    const Eigen::MatrixXd own = window_covariance(crop->pixels, dense_torus);
    error = std::max(error, (dense_covariance(barycenter(first, second, rho)) - own).cwiseAbs().maxCoeff());
    largest = std::max(largest, own.cwiseAbs().maxCoeff());
  }
  return error / largest;
}

std::optional<double> neighbor_texton_correlation(const Model&, const Target& target, const Domain&) {
  return strip_texton_correlation(target, true);
}

std::optional<double> unlike_start_correlation(const Model&, const Target& target, const Domain&) {
  return strip_texton_correlation(target, false);
}

std::optional<double> strip_border_ratio(const Model&, const Target& target, const Domain&) {
  const auto crops = crops_to_mix(target, mixed_torus);
  if (!crops) return std::nullopt;
  constexpr int samples = 32;
  constexpr Extent size{256, 64};
  const MethodEntry& mixing = find_method("mixing");
  const Params params(mixing.params, {{"second", std::string("middle")},
                                      {"kernels", std::int64_t{strips}},
                                      {"length", static_cast<double>(size.width)},
                                      {"impacts", std::string("signed_poisson")},
                                      {"mni", 30.0}});
  const auto model = mixing.analyze({.exemplar = crops->first, .second = &crops->second}, params, Seed{1});
  std::vector<double> border(samples), interior(samples);
  const auto strip = [](int x) { return std::lround(x * (strips - 1.0) / size.width); };
  parallel_for(samples, [&](int i) {
    const auto sample = static_cast<std::size_t>(i);
    const Image u = model->synthesize({.size = size}, derive(Seed{1}, sample));
    for (int x = 0; x + 1 < size.width; ++x) {
      double energy = 0;
      for (int c = 0; c < u.channels(); ++c) {
        for (int y = 0; y < size.height; ++y) energy += std::pow(u.at(c, x + 1, y) - u.at(c, x, y), 2);
      }
      (strip(x) != strip(x + 1) ? border : interior)[sample] += energy;
    }
  });
  double across = 0, inside = 0;
  for (const double energy : border) across += energy;
  for (const double energy : interior) inside += energy;
  constexpr double borders = strips - 1;
  return across / borders / (inside / (size.width - 1 - borders));
}

}  // namespace textonbench
