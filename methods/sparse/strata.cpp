#include "methods/sparse/strata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace textonbench {
namespace {

int wrap(int k, int side) { return ((k % side) + side) % side; }

struct Point {
  double x = 0, y = 0;
};

double squared_distance(const Pixel& bin, const Point& p) {
  return std::pow(bin.x - p.x, 2) + std::pow(bin.y - p.y, 2);
}

/// k-means++: each seed with probability proportional to its squared distance from those before it.
std::vector<Point> seed_clusters(const std::vector<Pixel>& bins, int parts, RandomSequence& numbers) {
  std::vector<double> distance(bins.size(), std::numeric_limits<double>::infinity());
  std::size_t chosen = numbers.below(bins.size());
  std::vector<Point> centers;
  for (int k = 0; k < parts; ++k) {
    centers.push_back({static_cast<double>(bins[chosen].x), static_cast<double>(bins[chosen].y)});
    double sum = 0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      distance[i] = std::min(distance[i], squared_distance(bins[i], centers.back()));
      sum += distance[i];
    }
    double left = numbers.uniform() * sum;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      if (distance[i] <= 0) continue;
      chosen = i;
      left -= distance[i];
      if (left <= 0) break;
    }
  }
  return centers;
}

int nearest_center(const Pixel& bin, const std::vector<Point>& centers) {
  int best = 0;
  for (int k = 1; k < static_cast<int>(centers.size()); ++k) {
    if (squared_distance(bin, centers[static_cast<std::size_t>(k)]) <
        squared_distance(bin, centers[static_cast<std::size_t>(best)])) {
      best = k;
    }
  }
  return best;
}

/// Gives every empty part the bin that is farthest from the center of a part of several.
void fill_empty_parts(const std::vector<Pixel>& bins, const std::vector<Point>& centers, std::vector<int>& part) {
  std::vector<int> size(centers.size());
  for (const int k : part) ++size[static_cast<std::size_t>(k)];
  for (std::size_t empty = 0; empty < size.size(); ++empty) {
    if (size[empty] > 0) continue;
    std::size_t farthest = bins.size();
    double most = -1;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const auto k = static_cast<std::size_t>(part[i]);
      const double d = squared_distance(bins[i], centers[k]);
      if (size[k] > 1 && d > most) {
        most = d;
        farthest = i;
      }
    }
    --size[static_cast<std::size_t>(part[farthest])];
    part[farthest] = static_cast<int>(empty);
    ++size[empty];
  }
}

std::vector<Point> centers_of(const std::vector<std::vector<Pixel>>& parts) {
  std::vector<Point> centers;
  centers.reserve(parts.size());
  for (const std::vector<Pixel>& part : parts) {
    Point& center = centers.emplace_back();
    for (const Pixel& bin : part) {
      center.x += bin.x / static_cast<double>(part.size());
      center.y += bin.y / static_cast<double>(part.size());
    }
  }
  return centers;
}

}  // namespace

PowerPlane::PowerPlane(int side)
    : side_(side), values_(static_cast<std::size_t>(side / 2 + 1) * static_cast<std::size_t>(side)) {}

std::size_t PowerPlane::index(int kx, int ky) const {
  int x = wrap(kx, side_), y = wrap(ky, side_);
  if (2 * x > side_ || (x == 0 && 2 * y > side_) || (2 * x == side_ && 2 * y > side_)) {
    x = wrap(-kx, side_);
    y = wrap(-ky, side_);
  }
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_ / 2 + 1) + static_cast<std::size_t>(x);
}

std::vector<Pixel> PowerPlane::half() const {
  std::vector<Pixel> bins;
  bins.reserve(values_.size());
  for (int y = 1 - side_ / 2; y <= side_ / 2; ++y) {
    for (int x = 0; x <= side_ / 2; ++x) {
      if (y >= 0 || (x > 0 && 2 * x < side_)) bins.push_back({x, y});
    }
  }
  return bins;
}

int PowerPlane::multiplicity(const Pixel& bin) const {
  return (bin.x == 0 || 2 * bin.x == side_) && (bin.y == 0 || 2 * bin.y == side_) ? 1 : 2;
}

double PowerPlane::total() const {
  double sum = 0;
  for (const Pixel& bin : half()) sum += multiplicity(bin) * at(bin.x, bin.y);
  return sum;
}

std::vector<std::vector<Pixel>> cluster_bins(const std::vector<Pixel>& bins, int parts, const Stream& stream) {
  constexpr int most_iterations = 100;
  RandomSequence numbers(stream);
  std::vector<Point> centers = seed_clusters(bins, parts, numbers);
  std::vector<int> part(bins.size(), -1);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    std::vector<int> next(bins.size());
    std::ranges::transform(bins, next.begin(), [&](const Pixel& bin) { return nearest_center(bin, centers); });
    fill_empty_parts(bins, centers, next);
    if (next == part) break;
    part = std::move(next);
    std::vector<int> size(centers.size());
    std::ranges::fill(centers, Point{});
    for (std::size_t i = 0; i < bins.size(); ++i) {
      Point& center = centers[static_cast<std::size_t>(part[i])];
      center.x += bins[i].x;
      center.y += bins[i].y;
      ++size[static_cast<std::size_t>(part[i])];
    }
    for (std::size_t k = 0; k < centers.size(); ++k) {
      centers[k].x /= size[k];
      centers[k].y /= size[k];
    }
  }
  std::vector<std::vector<Pixel>> result(centers.size());
  for (std::size_t i = 0; i < bins.size(); ++i) result[static_cast<std::size_t>(part[i])].push_back(bins[i]);
  return result;
}

std::vector<Stratum> stratify(const PowerPlane& power, const StrataOptions& options, const Stream& stream) {
  if (options.strata < 1 || options.cosines < options.strata) {
    throw std::invalid_argument(
        fmt::format("{} cosines in {} strata: expected at least one in each", options.cosines, options.strata));
  }
  if (!(options.spacing > 0 && std::isfinite(options.spacing))) {
    throw std::invalid_argument(fmt::format("spacing = {}: expected a factor above 0", options.spacing));
  }
  std::vector<Pixel> bins = power.half();
  const auto power_of = [&](const Pixel& bin) { return power.at(bin.x, bin.y); };
  double largest = 0;
  for (const Pixel& bin : bins) largest = std::max(largest, power_of(bin));
  std::erase_if(bins, [&](const Pixel& bin) { return power_of(bin) <= 1e-12 * largest; });
  if (bins.empty()) throw std::invalid_argument("a spectrum without power: expected some");
  std::ranges::stable_sort(bins, std::greater(), power_of);

  // A bin belongs to the share of energy that its middle falls into.
  double total = 0;
  std::size_t strongest = 0;
  for (const double least = options.kept * power.total(); strongest < bins.size() && (strongest == 0 || total < least);
       ++strongest) {
    total += power.multiplicity(bins[strongest]) * power_of(bins[strongest]);
  }
  bins.resize(strongest);
  std::vector<Stratum> strata(static_cast<std::size_t>(options.strata));
  double before = 0;
  for (const Pixel& bin : bins) {
    const int count = power.multiplicity(bin);
    const double energy = count * power_of(bin);
    const auto share = static_cast<int>((before + energy / 2) / total * options.strata);
    Stratum& stratum = strata[static_cast<std::size_t>(std::min(options.strata - 1, share))];
    stratum.bins.push_back(bin);
    stratum.area += count;
    stratum.energy += energy;
    before += energy;
  }
  std::erase_if(strata, [](const Stratum& s) { return s.bins.empty(); });

  // The smallest first: what they cannot take is left for the others.
  std::vector<std::size_t> order(strata.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return strata[i].bins.size(); });
  int cosines = options.cosines;
  for (std::size_t i = 0; i < order.size(); ++i) {
    Stratum& stratum = strata[order[i]];
    const auto others = static_cast<int>(order.size() - i);
    stratum.cosines =
        static_cast<int>(std::min<std::size_t>(stratum.bins.size(), static_cast<std::size_t>(cosines / others)));
    cosines -= stratum.cosines;
  }
  for (std::size_t i = 0; i < strata.size(); ++i) {
    Stratum& stratum = strata[i];
    stratum.spacing = options.spacing * power.side() * std::sqrt(stratum.cosines / (2.0 * stratum.area));
    const double delta = lrp_window_moments(options.window).energy_radius / stratum.spacing * power.side();
    const auto parts = static_cast<std::size_t>(stratum.cosines);
    stratum.parts =
        cluster_bins(erode_bins(stratum.bins, power.side(), delta, parts), stratum.cosines, stream.child(i));
    const std::vector<Point> centers = centers_of(stratum.parts);
    stratum.part_energy.resize(parts);
    for (const Pixel& bin : stratum.bins) {
      stratum.part_energy[static_cast<std::size_t>(nearest_center(bin, centers))] +=
          power.multiplicity(bin) * power_of(bin);
    }
  }
  return strata;
}

}  // namespace textonbench
