#include "methods/base/impact_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "methods/base/portable_math.h"

namespace textonbench {
namespace {

constexpr int position_bits = 24;

std::int64_t floor_division(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// Wang's integer hash.
std::uint32_t wang_hash(std::uint32_t s) {
  s = (s ^ 61U) ^ (s >> 16U);
  s *= 9U;
  s ^= s >> 4U;
  s *= 0x27D4EB2DU;
  return s ^ (s >> 15U);
}

/// Marsaglia's xorshift, whose state is never 0.
class XorShift32 {
 public:
  explicit XorShift32(std::uint32_t state) : state_(state == 0 ? 1 : state) {}
  std::uint32_t next() {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 17U;
    state_ ^= state_ << 5U;
    return state_;
  }

 private:
  std::uint32_t state_;
};

/// Random words of a cell.
class CellWords {
 public:
  CellWords(std::uint64_t key, std::int64_t cx, std::int64_t cy)
      : key_(key), cx_(static_cast<std::uint64_t>(cx)), cy_(static_cast<std::uint64_t>(cy)) {}
  /// Words of block j.
  std::array<std::uint32_t, 4> block(std::uint64_t j) const { return philox_block(key_ ^ j, cy_, cx_); }

 private:
  std::uint64_t key_;
  std::uint64_t cx_;
  std::uint64_t cy_;
};

CellImpact impact_of(std::uint32_t u, std::uint32_t v, std::uint32_t kernels, float weight) {
  return {u >> 8U, v >> 8U, static_cast<std::int32_t>((((u & 255U) << 8U | (v & 255U)) * kernels) >> 16U), weight};
}

}  // namespace

std::vector<std::uint32_t> poisson_thresholds(double mean) {
  if (!(mean >= 0 && mean <= max_cell_mean)) {
    throw std::invalid_argument(fmt::format("{} impacts a cell: expected a mean of 0 to {}", mean, max_cell_mean));
  }
  // Sums of mean^n / n!, the last of which is exp(mean) to rounding.
  std::vector<double> sums{1};
  double term = 1;
  for (int n = 1; term > 0x1p-60 * sums.back() || n <= mean; ++n) {
    term *= mean / n;
    sums.push_back(sums.back() + term);
  }
  std::vector<std::uint32_t> thresholds;
  thresholds.reserve(sums.size());
  for (const double sum : sums) {
    const double threshold = std::floor(0x1p32 * (sum / sums.back()));
    if (threshold < 0x1p32) {
      thresholds.push_back(static_cast<std::uint32_t>(threshold));
    }
  }
  return thresholds;
}

std::int64_t paper_count(double mean, std::uint32_t u, std::uint32_t v) {
  float cosine = 0;
  float sine = 0;
  portable::cos_sin(v, cosine, sine);
  const double radius = std::sqrt(-2 * portable::log(0x1p-32 * u));
  return static_cast<std::int64_t>(std::floor(mean + 0.5 + std::sqrt(mean) * radius * cosine));
}

ImpactGrid::ImpactGrid(ImpactProcess process, double intensity, double side, int kernels)
    : process_(process), intensity_(intensity), kernels_(static_cast<std::uint32_t>(kernels)) {
  if (!(intensity >= 1e-12 && intensity <= 64)) {
    throw std::invalid_argument(fmt::format("{} impacts a pixel: expected 1e-12 to 64", intensity));
  }
  if (kernels < 1 || kernels > 65536) {
    throw std::invalid_argument(fmt::format("{} kernels: expected 1 to 65536", kernels));
  }
  const double wanted = process == ImpactProcess::stratified ? 1 / std::sqrt(intensity) : side;
  if (!(wanted > 0 && wanted <= 0x1p20)) {
    throw std::invalid_argument(fmt::format("cells of {} pixels: expected a side of at most 2^20", wanted));
  }
  side_ = std::max<std::int64_t>(1, std::llround(wanted * side_unit));
  if (process == ImpactProcess::stratified) {
    intensity_ = 1 / (this->side() * this->side());
  } else if (cell_mean() > max_cell_mean) {
    throw std::invalid_argument(fmt::format("cells of {} pixels with {} impacts each: expected a mean of at most {}",
                                            this->side(), cell_mean(), max_cell_mean));
  } else if (process != ImpactProcess::paper) {
    thresholds_ = poisson_thresholds(cell_mean());
  }
}

template <class Visit>
void ImpactGrid::visit_paper_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy, const Visit& visit) const {
  const auto place = static_cast<std::uint32_t>(1024 * (cy & 1023) + (cx & 1023));
  XorShift32 random(wang_hash(place + static_cast<std::uint32_t>(key)));
  const std::uint32_t u = random.next();
  for (std::int64_t rest = paper_count(cell_mean(), u, random.next()); rest > 0; --rest) {
    const std::uint32_t x = random.next();
    visit(impact_of(x, random.next(), kernels_, 1));
  }
}

template <class Visit>
void ImpactGrid::visit_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy, const Visit& visit) const {
  if (process_ == ImpactProcess::paper) {
    visit_paper_cell(key, cx, cy, visit);
    return;
  }
  const CellWords words(key, cx, cy);
  const auto first = words.block(0);
  if (process_ == ImpactProcess::stratified) {
    visit(impact_of(first[2], first[3], kernels_, first[0] >> 31U == 0 ? 1.0F : -1.0F));
    return;
  }
  const bool is_signed = process_ == ImpactProcess::signed_poisson;
  const auto visit_impact = [&](std::uint32_t u, std::uint32_t v) {
    visit(impact_of(u, v, kernels_, is_signed && (v & 1U) != 0 ? -1.0F : 1.0F));
  };
  const auto count = std::ranges::upper_bound(thresholds_, first[0]) - thresholds_.begin();
  if (count > 0) {
    visit_impact(first[2], first[3]);
  }
  for (std::ptrdiff_t i = 1; i < count; i += 2) {
    const auto block = words.block(static_cast<std::uint64_t>(i + 1) / 2);
    visit_impact(block[0], block[1]);
    if (i + 1 < count) {
      visit_impact(block[2], block[3]);
    }
  }
}

void ImpactGrid::draw_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy,
                           std::vector<CellImpact>& impacts) const {
  visit_cell(key, cx, cy, [&](const CellImpact& impact) { impacts.push_back(impact); });
}

void ImpactGrid::draw(std::uint64_t key, const PlaneRectangle& rectangle, std::vector<PlaneImpact>& impacts) const {
  const std::int64_t last_row = floor_division(rectangle.bottom - 1, plane_side());
  const std::int64_t last_column = floor_division(rectangle.right - 1, plane_side());
  // Sides are in 2^−10 pixel and positions in 2^−24 of them.
  constexpr int shift = side_bits + position_bits - plane_bits;
  for (std::int64_t cy = floor_division(rectangle.top, plane_side()); cy <= last_row; ++cy) {
    for (std::int64_t cx = floor_division(rectangle.left, plane_side()); cx <= last_column; ++cx) {
      visit_cell(key, cx, cy, [&](const CellImpact& impact) {
        const std::int64_t x = cx * plane_side() + ((impact.x * side_) >> shift);
        const std::int64_t y = cy * plane_side() + ((impact.y * side_) >> shift);
        if (x >= rectangle.left && x < rectangle.right && y >= rectangle.top && y < rectangle.bottom) {
          impacts.push_back({x, y, kernel_at_ ? kernel_at_(x, y) : impact.kernel, impact.weight});
        }
      });
    }
  }
}

std::vector<PlaneRectangle> ImpactGrid::cell_rows(const PlaneRectangle& rectangle) const {
  const std::int64_t first = floor_division(rectangle.top, plane_side());
  const std::int64_t last = floor_division(rectangle.bottom - 1, plane_side());
  std::vector<PlaneRectangle> rows;
  rows.reserve(static_cast<std::size_t>(last - first + 1));
  for (std::int64_t cy = first; cy <= last; ++cy) {
    rows.push_back({rectangle.left, std::max(rectangle.top, cy * plane_side()), rectangle.right,
                    std::min(rectangle.bottom, (cy + 1) * plane_side())});
  }
  return rows;
}

}  // namespace textonbench
