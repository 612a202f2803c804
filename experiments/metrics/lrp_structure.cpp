#include "experiments/metrics/lrp_structure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include "methods/base/fft.h"
#include "methods/sparse/lrp.h"

namespace textonbench {
namespace {

/// The analysis of a model that has a structure.
const LrpAnalysis* analysis_with_structure(const Model& model) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  return lrp != nullptr && lrp->fixed ? lrp : nullptr;
}

double mean_square(const Image& u) {
  double sum = 0;
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < u.height(); ++y) {
      for (const float v : u.row(c, y)) sum += double{v} * v;
    }
  }
  return sum / (static_cast<double>(u.extent().area()) * u.channels());
}

/// The block of the exemplar, its own means taken off.
Image centered_block(const LrpAnalysis& lrp, const Target& target) {
  const int side = lrp.fixed->structure.period();
  Image block = crop(target.exemplar.pixels, lrp.block.x, lrp.block.y, {side, side});
  for (int c = 0; c < block.channels(); ++c) {
    double mean = 0;
    for (int y = 0; y < side; ++y) {
      for (const float v : block.row(c, y)) mean += static_cast<double>(v) / (side * side);
    }
    for (int y = 0; y < side; ++y) {
      for (float& v : block.row(c, y)) v -= static_cast<float>(mean);
    }
  }
  return block;
}

double standard_deviation(const Target& target) {
  double variance = 0;
  const int channels = target.exemplar.pixels.channels();
  for (int c = 0; c < channels; ++c) variance += target.covariance.at(c, c, 0, 0) / channels;
  return std::sqrt(variance);
}

/// Pairs of points on either side of borders of blocks, `gap` apart.
std::vector<WavePoint> pairs_across_blocks(int period, std::int64_t gap) {
  std::vector<WavePoint> points;
  points.reserve(512);
  for (std::int64_t i = 0; i < 256; ++i) {
    const std::int64_t border = (i % 16 - 8) * period * plane_pixel / 2, along = (i * 7919 % 4096) * plane_pixel / 7;
    const std::int64_t before = border - gap / 2, behind = before + gap;
    points.push_back(i < 128 ? WavePoint{before, along} : WavePoint{along, before});
    points.push_back(i < 128 ? WavePoint{behind, along} : WavePoint{along, behind});
  }
  return points;
}

/// Root-mean-square change of the displacement from point 2i to 2i + 1, σ.
double displacement_change(const FixedPhases& fixed, const std::vector<WavePoint>& points) {
  std::vector<WavePoint> displaced(points.size());
  fixed.displace(Seed{1}, points, displaced);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    for (const auto axis : {&WavePoint::x, &WavePoint::y}) {
      const std::int64_t before = displaced[i].*axis - points[i].*axis;
      const std::int64_t behind = displaced[i + 1].*axis - points[i + 1].*axis;
      sum += std::pow(static_cast<double>(behind - before) / plane_pixel, 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(points.size())) / fixed.turbulence;
}

/// Median processor time of each model at the points of 64 x 64 pixels, over turns that all of them take.
template <std::size_t count>
std::array<double, count> point_times(const std::array<std::unique_ptr<Model>, count>& models) {
  constexpr int turns = 15, side = 64;
  std::vector<Point2> points;
  points.reserve(std::size_t{side} * side);
  for (int i = 0; i < side * side; ++i) {
    const int row = i / side;
    points.push_back({i % side + 0.25, row + 0.5});
  }
  std::vector<float> values(points.size() * Image::max_channels);
  std::array<std::vector<double>, count> times;
  for (std::uint64_t turn = 0; turn < turns; ++turn) {
    for (std::size_t place = 0; place < count; ++place) {
      const std::size_t i = (place + turn) % count;
      const auto channels = static_cast<std::size_t>(lrp_analysis_of(*models[i])->field.channels);
      const std::clock_t start = std::clock();
      models[i]->procedural()->evaluate(points, Seed{turn}, std::span(values).first(points.size() * channels));
      times[i].push_back(static_cast<double>(std::clock() - start));
    }
  }
  std::array<double, count> medians{};
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::nth_element(times[i], times[i].begin() + turns / 2);
    medians[i] = times[i][turns / 2];
  }
  return medians;
}

std::unique_ptr<Model> with_options(const LrpAnalysis& lrp, const Target& target,
                                    const std::function<void(FixedPhaseOptions&)>& change) {
  LrpOptions options = lrp.options;
  change(options.fixed);
  return make_lrp(analyze_lrp(target.exemplar, options, Seed{1}));
}

/// Power of the structure on a raster in octaves of the radial frequency, from one period a raster on.
std::vector<double> octave_power(const FixedPhases& fixed) {
  const int side = 2 * fixed.structure.period(), channels = fixed.structure.image().channels();
  std::vector<double> power(16);
  constexpr std::uint64_t seeds = 4;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    std::vector<WavePoint> points;
    for (std::int64_t i = 0; i < std::int64_t{side} * side; ++i)
      points.push_back({i % side * plane_pixel, i / side * plane_pixel});
    std::vector<float> values(points.size() * static_cast<std::size_t>(channels));
    fixed.add(Seed{seed}, points, values);
    Image image({side, side}, channels);
    for (int c = 0; c < channels; ++c) {
      for (int y = 0; y < side; ++y) {
        const auto from = values.begin() + (std::ptrdiff_t{c} * side + y) * side;
        std::copy(from, from + side, image.row(c, y).begin());
      }
    }
    const Spectrum spectrum = forward_fft(image);
    for (int ky = 0; ky < side; ++ky) {
      for (int kx = 0; kx <= side / 2; ++kx) {
        const double radius = std::hypot(kx, ky <= side / 2 ? ky : ky - side);
        if (radius < 1) continue;
        for (int c = 0; c < channels; ++c) {
          power[static_cast<std::size_t>(std::log2(radius))] += static_cast<double>(std::norm(spectrum.at(c, kx, ky)));
        }
      }
    }
  }
  return power;
}

}  // namespace

std::optional<double> lrp_copy_error(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr) return std::nullopt;
  const int side = lrp->fixed->structure.period();
  Image sample = model.synthesize({.size = {side, side}}, Seed{1});
  const Image& exemplar = target.exemplar.pixels;
  for (int c = 0; c < sample.channels(); ++c) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) sample.at(c, x, y) -= exemplar.at(c, lrp->block.x + x, lrp->block.y + y);
    }
  }
  return std::sqrt(mean_square(sample) / mean_square(centered_block(*lrp, target)));
}

std::optional<double> lrp_printed_copy_error(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr) return std::nullopt;
  Image block = centered_block(*lrp, target);
  const double power = mean_square(block);
  const int side = block.width();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      double windows = 0;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          windows += lrp_window(lrp->field.window, std::hypot((x + 0.5) / side - 0.5 - i, (y + 0.5) / side - 0.5 - j));
        }
      }
      for (int c = 0; c < block.channels(); ++c) block.at(c, x, y) *= static_cast<float>(windows - 1);
    }
  }
  return std::sqrt(mean_square(block) / power);
}

std::optional<double> lrp_structure_deviation(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  return lrp == nullptr ? std::nullopt : std::optional(lrp->fixed->structure.deviation());
}

std::optional<double> lrp_block_side(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  return lrp == nullptr ? std::nullopt : std::optional<double>(lrp->fixed->structure.block_side());
}

std::optional<double> lrp_table_entries(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr) return std::nullopt;
  const Structure& structure = lrp->fixed->structure;
  double entries = std::pow(structure.period() / structure.block_side(), 2) * structure.cosines();
  for (const WaveLayer& layer : lrp->field.layers) entries += static_cast<double>(layer.bins.size());
  return entries;
}

std::optional<double> lrp_distortion_jump(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr || lrp->fixed->turbulence <= 0) return std::nullopt;
  return displacement_change(*lrp->fixed, pairs_across_blocks(lrp->fixed->structure.period(), plane_pixel >> 10));
}

std::optional<double> lrp_swapped_distortion_jump(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr || lrp->fixed->turbulence <= 0) return std::nullopt;
  // Each point where its block is taken from: the displacement is that of there.
  const int period = lrp->fixed->structure.period();
  std::vector<WavePoint> points = pairs_across_blocks(period, plane_pixel >> 10);
  const Stream stream = placement_stream(Seed{1});
  for (WavePoint& point : points) {
    PlacedPoint places[4];
    place_at_random(stream, period, point, places);
    point = places[0].point;
  }
  return displacement_change(*lrp->fixed, points);
}

std::optional<double> lrp_jump(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) return std::nullopt;
  constexpr std::int64_t gap = plane_pixel >> 12;
  std::vector<WavePoint> pairs = pairs_across_blocks(lrp->spectrum.side(), gap);
  for (std::size_t l = 0; l < lrp->field.layers.size(); ++l) {
    const WaveLattice lattice(lrp->field, l, Seed{1});
    const std::int64_t spacing = lattice.layer().spacing;
    for (std::int64_t i = 0; i < 64; ++i) {
      // The ends of a window at its height, and where another lattice point becomes the nearest.
      for (const std::int64_t border : {spacing + spacing / 2, spacing / 2}) {
        const std::int64_t x = lattice.center_x(i) + border - gap / 2;
        const std::int64_t y = lattice.center_y(0) + (border < spacing ? i * spacing / 64 : 0);
        pairs.push_back({x, y});
        pairs.push_back({x + gap, y});
      }
    }
  }
  std::vector<Point2> points;
  points.reserve(pairs.size());
  for (const WavePoint& p : pairs) {
    points.push_back({static_cast<double>(p.x) / plane_pixel, static_cast<double>(p.y) / plane_pixel});
  }
  const auto channels = static_cast<std::size_t>(lrp->field.channels);
  std::vector<float> values(points.size() * channels);
  model.procedural()->evaluate(points, Seed{1}, values);
  double most = 0;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    most = std::max(most, std::abs(static_cast<double>(values[i + 1] - values[i])));
  }
  return most / standard_deviation(target);
}

std::optional<double> lrp_fixed_time_ratio(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr) return std::nullopt;
  const auto times = point_times<2>(
      {with_options(*lrp, target, [](FixedPhaseOptions& fixed) { fixed.turbulence = 0, fixed.placement = false; }),
       with_options(*lrp, target, [](FixedPhaseOptions& fixed) { fixed = {}; })});
  return times[0] / times[1];
}

std::optional<double> lrp_placement_time_ratio(const Model& model, const Target& target, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr) return std::nullopt;
  const auto times = point_times<2>(
      {with_options(*lrp, target, [](FixedPhaseOptions& fixed) { fixed.turbulence = 0, fixed.placement = true; }),
       with_options(*lrp, target, [](FixedPhaseOptions& fixed) { fixed.turbulence = 0, fixed.placement = false; })});
  return times[0] / times[1];
}

std::optional<double> lrp_radial_change(const Model& model, const Target&, const Domain&) {
  const LrpAnalysis* lrp = analysis_with_structure(model);
  if (lrp == nullptr) return std::nullopt;
  FixedPhases plain = *lrp->fixed;
  plain.turbulence = 0;
  plain.placement = false;
  const std::vector<double> before = octave_power(plain), after = octave_power(*lrp->fixed);
  double total = 0, sum = 0;
  for (const double power : before) total += power;
  int octaves = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] < 0.01 * total) continue;
    sum += std::abs(10 * std::log10(after[i] / before[i]));
    ++octaves;
  }
  return sum / octaves;
}

}  // namespace textonbench
