#include "experiments/metrics/transport_identities.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "methods/base/spectrum.h"

namespace textonbench {
namespace {

constexpr Extent window{8, 8}, torus{24, 24};

std::optional<std::pair<Image, Image>> two_crops(const Target& target, Extent extent) {
  const Image& u = target.exemplar.pixels;
  const int left = u.width() / 2, top = u.height() / 2;
  if (left < extent.width || top < extent.height) return std::nullopt;
  std::pair crops{crop(u, 0, 0, extent), crop(u, left, top, extent)};
  for (const Image* part : {&crops.first, &crops.second}) {
    if (color_covariance(gaussian_model(*part).spectrum).trace() < 1e-12) return std::nullopt;
  }
  return crops;
}

double dense_distance_squared(const Image& a, const Image& b, Extent part) {
  return bures_distance_squared(window_covariance(a, part), window_covariance(b, part)) /
         static_cast<double>(part.area());
}

CrossSpectrum law_of_spot(const Spectrum& spot) {
  CrossSpectrum law;
  law.factors.push_back(spot);
  return law;
}

}  // namespace

Eigen::MatrixXd window_covariance(const Image& spot, Extent part) {
  const int width = spot.width(), height = spot.height();
  const std::vector<double> mean = channel_means(spot);
  const Eigen::Index pixels = part.area(), noise = spot.extent().area();
  const double scale = 1 / std::sqrt(static_cast<double>(noise));
  Eigen::MatrixXd map(spot.channels() * pixels, noise);
  for (int c = 0; c < spot.channels(); ++c) {
    for (int to = 0; to < pixels; ++to) {
      for (int from = 0; from < noise; ++from) {
        const int x = (to % part.width - from % width + width) % width;
        const int y = (to / part.width - from / width + height) % height;
        map(c * pixels + to, from) =
            scale * (static_cast<double>(spot.at(c, x, y)) - mean[static_cast<std::size_t>(c)]);
      }
    }
  }
  return map * map.transpose();
}

Spectrum phase_projection(const Spectrum& h, const Spectrum& t) {
  Spectrum projection = t;
  for (int ky = 0; ky < t.rows(); ++ky) {
    for (int kx = 0; kx < t.columns(); ++kx) {
      std::complex<double> overlap = 0;
      for (int c = 0; c < t.channels(); ++c) {
        overlap += std::conj(std::complex<double>(t.at(c, kx, ky))) * std::complex<double>(h.at(c, kx, ky));
      }
      const std::complex<double> phasor = std::abs(overlap) > 0 ? overlap / std::abs(overlap) : 1.0;
      for (int c = 0; c < t.channels(); ++c) {
        projection.at(c, kx, ky) = std::complex<float>(phasor * std::complex<double>(t.at(c, kx, ky)));
      }
    }
  }
  return projection;
}

double least_distance_ratio(const Spectrum& candidate, const Spectrum& h, const Spectrum& t, Seed seed) {
  RandomSequence random(Stream(seed).child("phase perturbation"));
  constexpr int perturbations = 1000;
  double least = 0;
  for (int i = 0; i <= perturbations; ++i) {
    const double size = i == 0 ? 0 : std::pow(10.0, -2 + 3.0 * i / perturbations);
    double sum = 0;
    for (int ky = 0; ky < h.rows(); ++ky) {
      for (int kx = 0; kx < h.columns(); ++kx) {
        const std::complex<double> turn = std::polar(1.0, i == 0 ? 0 : size * random.normal());
        for (int c = 0; c < h.channels(); ++c) {
          sum += h.multiplicity(kx) * std::norm(turn * std::complex<double>(candidate.at(c, kx, ky)) -
                                                std::complex<double>(h.at(c, kx, ky)));
        }
      }
    }
    least = i == 0 ? sum : std::min(least, sum);
  }
  const double optimal = transport_distance_squared(law_of_spot(h), law_of_spot(t));
  return std::sqrt(least / static_cast<double>(h.raster().area()) / optimal);
}

std::optional<double> transport_identity_error(const Model&, const Target& target, const Domain&) {
  const auto crops = two_crops(target, window);
  if (!crops) return std::nullopt;
  const double dense = dense_distance_squared(crops->first, crops->second, window);
  const double closed =
      transport_distance_squared(gaussian_model(crops->first).spectrum, gaussian_model(crops->second).spectrum);
  return std::fabs(dense - closed) / dense;
}

std::optional<double> window_transport_ratio(const Model&, const Target& target, const Domain&) {
  const auto crops = two_crops(target, torus);
  if (!crops) return std::nullopt;
  return dense_distance_squared(crops->first, crops->second, window) /
         transport_distance_squared(gaussian_model(crops->first).spectrum, gaussian_model(crops->second).spectrum);
}

std::optional<double> projection_distance_ratio(const Model&, const Target& target, const Domain&) {
  const auto crops = two_crops(target, torus);
  if (!crops) return std::nullopt;
  const Spectrum h = gaussian_model(crops->first).spectrum.factors.front();
  const Spectrum t = gaussian_model(crops->second).spectrum.factors.front();
  return least_distance_ratio(phase_projection(h, t), h, t, Seed{1});
}

std::optional<double> spot_symmetry_error(const Model&, const Target& target, const Domain&) {
  const auto crops = two_crops(target, torus);
  if (!crops) return std::nullopt;
  const Image& h = crops->first;
  const auto changed = [&](bool negated, bool turned) {
    Image image(h.extent(), h.channels());
    for (int c = 0; c < h.channels(); ++c) {
      for (int y = 0; y < h.height(); ++y) {
        for (int x = 0; x < h.width(); ++x) {
          const float value = turned ? h.at(c, h.width() - 1 - x, h.height() - 1 - y) : h.at(c, x, y);
          image.at(c, x, y) = negated ? -value : value;
        }
      }
    }
    return autocovariance(gaussian_model(image).spectrum);
  };
  const Autocovariance own = changed(false, false);
  double error = 0;
  for (const auto& [negated, turned] : {std::pair{true, false}, std::pair{false, true}, std::pair{true, true}}) {
    const Autocovariance other = changed(negated, turned);
    for (int c = 0; c < h.channels(); ++c) {
      for (int y = 0; y < h.height(); ++y) {
        for (int x = 0; x < h.width(); ++x) {
          error = std::max(error, std::fabs(other.at(c, c, x, y) - own.at(c, c, x, y)) / own.at(c, c, 0, 0));
        }
      }
    }
  }
  return error;
}

}  // namespace textonbench
