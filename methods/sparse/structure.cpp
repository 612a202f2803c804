#include "methods/sparse/structure.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

#include "methods/base/fft.h"
#include "methods/base/parallel.h"
#include "methods/sparse/wave_filter.h"

namespace textonbench {
namespace {

constexpr int vector = 16;

int wrapped(std::int64_t k, int side) { return static_cast<int>(((k % side) + side) % side); }

/// The bin of the half spectrum that holds k or −k, and whether it is −k.
struct StoredBin {
  int kx, ky;
  bool conjugate;
};

StoredBin stored(const Pixel& bin, int side) {
  const int x = wrapped(bin.x, side), y = wrapped(bin.y, side);
  if (2 * x <= side) return {x, y, false};
  return {wrapped(-bin.x, side), wrapped(-bin.y, side), true};
}

std::int64_t floor_of(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace

std::vector<Pixel> strongest_bins(const PowerPlane& power, double ratio) {
  std::vector<Pixel> bins = power.half();
  std::ranges::stable_sort(bins, std::greater(), [&](const Pixel& bin) { return power.at(bin.x, bin.y); });
  if (ratio >= 1) return bins;
  const double wanted = ratio * power.total();
  double sum = 0;
  std::size_t count = 0;
  while (count < bins.size() && sum < wanted) {
    sum += power.multiplicity(bins[count]) * power.at(bins[count].x, bins[count].y);
    ++count;
  }
  bins.resize(count);
  return bins;
}

Image restrict_to_bins(const Image& block, const std::vector<Pixel>& bins) {
  const int side = block.width();
  const Spectrum all = forward_fft(block);
  Spectrum some(block.extent(), block.channels());
  for (const Pixel& bin : bins) {
    for (const Pixel& each : {bin, Pixel{-bin.x, -bin.y}}) {
      const StoredBin at = stored(each, side);
      if (at.conjugate) continue;
      for (int c = 0; c < block.channels(); ++c) some.at(c, at.kx, at.ky) = all.at(c, at.kx, at.ky);
    }
  }
  return inverse_fft(some);
}

Structure::Structure(Image image, const std::vector<Pixel>& bins, const StructureOptions& options)
    : image_(std::move(image)) {
  const int whole = image_.width();
  cut(whole, options.cosines == 0 ? static_cast<int>(bins.size()) : options.cosines, bins);
  for (int side = whole / 2; side >= 1 && deviation_ > options.precision; side /= 2) cut(side, options.cosines, {});
}

void Structure::cut(int side, int cosines, const std::vector<Pixel>& bins) {
  const int whole = image_.width();
  side_ = side;
  // A block is half a block larger on each side than its part of the image; the whole image and a pixel are not.
  const int period = side == whole || side == 1 ? side : 2 * side;
  const int margin = (period - side) / 2;
  period_bits_ = std::countr_zero(static_cast<unsigned>(period));
  const std::vector<Pixel> candidates = bins.empty() ? PowerPlane(std::max(2, period)).half() : bins;
  cosines_ = period == 1 ? 1 : std::min(cosines, static_cast<int>(candidates.size()));
  padded_ = (cosines_ + vector - 1) / vector * vector;
  const int across = whole / side;
  const auto blocks = static_cast<std::size_t>(across) * static_cast<std::size_t>(across);
  integers_ = AlignedBuffer<std::int32_t>(blocks * 3 * static_cast<std::size_t>(padded_));
  colors_ = AlignedBuffer<float>(blocks * 2 * static_cast<std::size_t>(padded_ * image_.channels()));
  integers_.set_zero();
  colors_.set_zero();
  parallel_for(across * across, [&](int block) {
    Image samples({period, period}, image_.channels());
    for (int c = 0; c < image_.channels(); ++c) {
      for (int y = 0; y < period; ++y) {
        for (int x = 0; x < period; ++x) {
          samples.at(c, x, y) = image_.at(c, wrapped(block % across * side - margin + x, whole),
                                          wrapped(block / across * side - margin + y, whole));
        }
      }
    }
    store(static_cast<std::size_t>(block), samples, candidates, cosines_);
  });
  deviation_ = measure_deviation();
}

void Structure::store(std::size_t block, const Image& samples, const std::vector<Pixel>& bins, int cosines) {
  const int side = samples.width();
  std::int32_t* kx = integers_.data() + block * 3 * static_cast<std::size_t>(padded_);
  float* color = colors_.data() + block * 2 * static_cast<std::size_t>(padded_ * samples.channels());
  if (side == 1) {
    for (int c = 0; c < samples.channels(); ++c) color[std::ptrdiff_t{2} * c * padded_] = samples.at(c, 0, 0);
    return;
  }
  const Spectrum spectrum = forward_fft(samples);
  const PowerPlane plane(side);
  const auto value = [&](int c, const Pixel& bin) {
    const StoredBin at = stored(bin, side);
    const std::complex<float> z = spectrum.at(c, at.kx, at.ky);
    return at.conjugate ? std::conj(z) : z;
  };
  std::vector<std::pair<float, Pixel>> ranked;
  ranked.reserve(bins.size());
  for (const Pixel& bin : bins) {
    float power = 0;
    for (int c = 0; c < samples.channels(); ++c) power += std::norm(value(c, bin));
    ranked.emplace_back(static_cast<float>(plane.multiplicity(bin)) * power, bin);
  }
  std::ranges::stable_sort(ranked, std::greater(), [](const auto& one) { return one.first; });
  for (int j = 0; j < cosines; ++j) {
    const Pixel& bin = ranked[static_cast<std::size_t>(j)].second;
    kx[j] = bin.x;
    kx[padded_ + j] = bin.y;
    const float scale = static_cast<float>(plane.multiplicity(bin)) / static_cast<float>(samples.extent().area());
    for (int c = 0; c < samples.channels(); ++c) {
      const std::complex<float> z = scale * value(c, bin);
      color[std::ptrdiff_t{2} * c * padded_ + j] = z.real();
      color[(std::ptrdiff_t{2} * c + 1) * padded_ + j] = z.imag();
    }
  }
}

PaddedWaves Structure::waves_of(std::size_t block) const {
  const std::int32_t* kx = integers_.data() + block * 3 * static_cast<std::size_t>(padded_);
  return {padded_, kx, kx + padded_, reinterpret_cast<const std::uint32_t*>(kx + std::ptrdiff_t{2} * padded_),
          colors_.data() + block * 2 * static_cast<std::size_t>(padded_ * image_.channels())};
}

PaddedWaves Structure::block(int x, int y) const {
  return waves_of(static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width() / side_) +
                  static_cast<std::size_t>(x));
}

Structure Structure::filtered(double footprint, bool mip) const {
  const int whole = image_.width();
  int side = side_;
  while (mip && is_cut() && side < whole && 4 * side <= footprint) side *= 2;
  if (side > side_) {
    Structure means(image_);
    means.cut(side, 1, {{0, 0}});
    return means;
  }
  Structure clamped(*this);
  const double period = std::ldexp(1.0, period_bits_);
  const auto blocks = static_cast<std::size_t>(whole / side) * static_cast<std::size_t>(whole / side);
  for (std::size_t block = 0; block < blocks; ++block) {
    const PaddedWaves waves = clamped.waves_of(block);
    float* color = clamped.colors_.data() + block * 2 * static_cast<std::size_t>(padded_ * image_.channels());
    for (int j = 0; j < cosines_; ++j) {
      const auto part = static_cast<float>(box_response(waves.kx[j], waves.ky[j], period, footprint));
      for (int i = 0; i < 2 * image_.channels(); ++i) color[std::ptrdiff_t{i} * padded_ + j] *= part;
    }
  }
  return clamped;
}

void Structure::add(const WavePoint& point, float weight, float* out) const {
  constexpr std::int64_t pixel = std::int64_t{1} << plane_bits;
  const auto turns = [this](std::int64_t distance) {
    constexpr int even = 32 - plane_bits;
    return static_cast<std::uint32_t>(period_bits_ <= even
                                          ? static_cast<std::uint64_t>(distance) << (even - period_bits_)
                                          : static_cast<std::uint64_t>(distance >> (period_bits_ - even)));
  };
  WavesAround around;
  if (!is_cut()) {
    around.count = 1;
    around.waves[0] = waves_of(0);
    around.turn_x[0] = turns(point.x);
    around.turn_y[0] = turns(point.y);
    around.window[0] = weight;
  } else {
    const int across = image_.width() / side_;
    const std::int64_t side = side_ * pixel;
    // Block i has its center at (i + 1/2) side − 1/2 and its first sample `margin` before its part of the image.
    const std::int64_t margin = side_ == 1 ? 0 : side / 2;
    const std::int64_t half = (side - pixel) / 2;
    const std::int64_t left = floor_of(point.x - half, side), top = floor_of(point.y - half, side);
    const auto part = [&](std::int64_t at, std::int64_t block) {
      const double away = static_cast<double>(at - half - block * side) / static_cast<double>(side);
      return 0.5 + 0.5 * std::cos(std::numbers::pi * away);
    };
    const double right_part = 1 - part(point.x, left), bottom_part = 1 - part(point.y, top);
    for (int dy = 0; dy <= 1; ++dy) {
      for (int dx = 0; dx <= 1; ++dx) {
        const double share = (dx == 1 ? right_part : 1 - right_part) * (dy == 1 ? bottom_part : 1 - bottom_part);
        if (share <= 0) continue;
        const int i = around.count++;
        around.waves[i] =
            waves_of(static_cast<std::size_t>(wrapped(top + dy, across)) * static_cast<std::size_t>(across) +
                     static_cast<std::size_t>(wrapped(left + dx, across)));
        around.turn_x[i] = turns(point.x - (left + dx) * side + margin);
        around.turn_y[i] = turns(point.y - (top + dy) * side + margin);
        around.window[i] = weight * static_cast<float>(share);
      }
    }
  }
  PointSums sums;
  sum_wave_values(around, image_.channels(), sums);
  for (int c = 0; c < image_.channels(); ++c) out[c] += sums.value[c];
}

double Structure::measure_deviation() const {
  const int whole = image_.width();
  std::vector<double> rows(static_cast<std::size_t>(whole));
  parallel_for(whole, [&](int y) {
    for (int x = 0; x < whole; ++x) {
      float values[Image::max_channels] = {};
      add({std::int64_t{x} << plane_bits, std::int64_t{y} << plane_bits}, 1, values);
      for (int c = 0; c < image_.channels(); ++c) {
        rows[static_cast<std::size_t>(y)] +=
            std::abs(static_cast<double>(values[c]) - static_cast<double>(image_.at(c, x, y)));
      }
    }
  });
  double sum = 0;
  for (const double row : rows) sum += row;
  return sum / (static_cast<double>(image_.extent().area()) * image_.channels());
}

}  // namespace textonbench
