#include "experiments/metrics/plane_impacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/metrics/replicates.h"
#include "methods/base/impact_grid.h"
#include "methods/spot/spline_noise.h"

namespace textonbench {
namespace {

constexpr double plane_mni = 30;
constexpr double gaussian_mean = plane_mni * 0.625 * 0.625;
constexpr double cell_impacts = plane_mni * 0.6 * 0.6;

Stream impact_stream(const Target& target, std::string_view metric) {
  return Stream(Seed{1}).child(metric).child(target.exemplar.name);
}

/// Means over the points.
struct CellWork {
  double cells = 0, drawn = 0, used = 0;
};

std::optional<CellWork> work_at_points(const Model& model, const Target& target) {
  const SplineNoiseOptions* noise = spline_noise_of(model);
  if (noise == nullptr || noise->share) return std::nullopt;
  constexpr int points = 4096;
  const SplineTexton& texton = *model.spline_texton();
  const Extent extent = texton.coefficients.extent();
  const ImpactGrid grid = spline_noise_impacts(texton, *noise);
  const double reach_x = (extent.width + texton.order) / (2 * grid.side());
  const double reach_y = (extent.height + texton.order) / (2 * grid.side());
  const Stream stream = impact_stream(target, "plane_impacts");
  RandomSequence random(stream);
  CellWork sum;
  std::vector<CellImpact> impacts;
  for (int i = 0; i < points; ++i) {
    // In cell sides.
    const double x = 4096 * random.uniform(), y = 4096 * random.uniform();
    const auto first_x = static_cast<std::int64_t>(std::floor(x - reach_x));
    const auto last_x = static_cast<std::int64_t>(std::floor(x + reach_x));
    const auto last_y = static_cast<std::int64_t>(std::floor(y + reach_y));
    for (auto cy = static_cast<std::int64_t>(std::floor(y - reach_y)); cy <= last_y; ++cy) {
      for (std::int64_t cx = first_x; cx <= last_x; ++cx) {
        impacts.clear();
        grid.draw_cell(stream.key(), cx, cy, impacts);
        sum.cells += 1;
        sum.drawn += static_cast<double>(impacts.size());
        for (const CellImpact& impact : impacts) {
          const double dx = static_cast<double>(cx) + 0x1p-24 * impact.x - x;
          const double dy = static_cast<double>(cy) + 0x1p-24 * impact.y - y;
          if (std::fabs(dx) < reach_x && std::fabs(dy) < reach_y) sum.used += 1;
        }
      }
    }
  }
  return CellWork{sum.cells / points, sum.drawn / points, sum.used / points};
}

/// Of gaussian_mean, from the words of the stream.
std::vector<std::int64_t> gaussian_counts(const Target& target) {
  constexpr std::uint64_t pairs = 1 << 21;
  const Stream stream = impact_stream(target, "gaussian_counts");
  std::vector<std::int64_t> counts;
  counts.reserve(2 * pairs);
  for (std::uint64_t i = 0; i < pairs; ++i) {
    const auto words = stream.block(0, i);
    for (const std::size_t first : {std::size_t{0}, std::size_t{2}}) {
      counts.push_back(paper_count(gaussian_mean, std::max(words[first], 1U), words[first + 1]));
    }
  }
  return counts;
}

double mean_clamped(std::span<const std::int64_t> counts) {
  double sum = 0;
  for (const std::int64_t count : counts) sum += static_cast<double>(std::max<std::int64_t>(count, 0));
  return sum / static_cast<double>(counts.size());
}

/// Number of impacts and coordinates of the first two, of mean zero and variance one; zero where there are none.
using CellSketch = std::array<double, 5>;

CellSketch sketch_of(std::int64_t count, std::span<const CellImpact> impacts) {
  const auto centered = [](std::uint32_t coordinate) { return (0x1p-24 * coordinate - 0.5) * std::sqrt(12.0); };
  CellSketch sketch{(static_cast<double>(count) - cell_impacts) / std::sqrt(cell_impacts)};
  for (std::size_t i = 0; i < std::min<std::size_t>(impacts.size(), 2); ++i) {
    sketch[1 + 2 * i] = centered(impacts[i].x);
    sketch[2 + 2 * i] = centered(impacts[i].y);
  }
  return sketch;
}

CellSketch congruential_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy) {
  auto state = static_cast<std::uint32_t>(key) + static_cast<std::uint32_t>(1024 * cy + cx);
  const auto next = [&state] { return state *= 3039177861U; };
  const std::uint32_t u = std::max(next(), 1U);
  const std::int64_t count = std::max<std::int64_t>(paper_count(cell_impacts, u, next()), 0);
  std::vector<CellImpact> impacts(static_cast<std::size_t>(std::min<std::int64_t>(count, 2)));
  for (CellImpact& impact : impacts) {
    impact.x = next() >> 8U;
    impact.y = next() >> 8U;
  }
  return sketch_of(count, impacts);
}

/// sketch(key, cx, cy) of a cell.
template <class Sketch>
double neighbor_deviation(const Target& target, const Sketch& sketch) {
  // Blocks apart from each other within the period of 1024 cells.
  constexpr int block = 32, blocks_across = 16, stride = 48;
  constexpr std::array<std::pair<int, int>, 4> neighbors{std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1},
                                                         std::pair{-1, 1}};
  const std::uint64_t key = impact_stream(target, "cell_correlation").key();
  const Replicates replicates = draw_replicates(blocks_across * blocks_across, [&](int i) {
    const int left = 8 + stride * (i % blocks_across), top = 8 + stride * (i / blocks_across);
    std::vector<double> products(neighbors.size() * std::tuple_size_v<CellSketch>);
    for (int y = top; y < top + block; ++y) {
      for (int x = left; x < left + block; ++x) {
        const CellSketch own = sketch(key, x, y);
        std::size_t entry = 0;
        for (const auto& [dx, dy] : neighbors) {
          const CellSketch other = sketch(key, x + dx, y + dy);
          for (std::size_t j = 0; j < own.size(); ++j) products[entry++] += own[j] * other[j] / (block * block);
        }
      }
    }
    return std::vector<float>(products.begin(), products.end());
  });
  return largest_deviation(replicates, std::vector<double>(replicates.front().size()));
}

double grid_neighbor_deviation(const Target& target, ImpactProcess process) {
  const ImpactGrid grid(process, cell_impacts, 1, 1);
  return neighbor_deviation(target, [&](std::uint64_t key, std::int64_t cx, std::int64_t cy) {
    std::vector<CellImpact> impacts;
    grid.draw_cell(key, cx, cy, impacts);
    return sketch_of(static_cast<std::int64_t>(impacts.size()), impacts);
  });
}

}  // namespace

std::optional<double> cells_visited(const Model& model, const Target& target, const Domain&) {
  const auto work = work_at_points(model, target);
  return work ? std::optional(work->cells) : std::nullopt;
}

std::optional<double> impacts_drawn_ratio(const Model& model, const Target& target, const Domain&) {
  const auto work = work_at_points(model, target);
  return work ? std::optional(work->drawn / spline_noise_of(model)->mni) : std::nullopt;
}

std::optional<double> fetches_per_pixel(const Model& model, const Target& target, const Domain&) {
  const auto work = work_at_points(model, target);
  return work ? std::optional(work->used) : std::nullopt;
}

std::optional<double> gaussian_count_mean(const Model&, const Target& target, const Domain&) {
  return mean_clamped(gaussian_counts(target)) / gaussian_mean;
}

std::optional<double> gaussian_count_variance(const Model&, const Target& target, const Domain&) {
  const std::vector<std::int64_t> counts = gaussian_counts(target);
  const double mean = mean_clamped(counts);
  double squares = 0;
  for (const std::int64_t count : counts) {
    squares += std::pow(static_cast<double>(std::max<std::int64_t>(count, 0)) - mean, 2);
  }
  return squares / static_cast<double>(counts.size()) / gaussian_mean;
}

std::optional<double> negative_count_part(const Model&, const Target& target, const Domain&) {
  const std::vector<std::int64_t> counts = gaussian_counts(target);
  const auto negative = std::ranges::count_if(counts, [](std::int64_t count) { return count < 0; });
  return static_cast<double>(negative) / static_cast<double>(counts.size());
}

std::optional<double> congruential_cell_correlation(const Model&, const Target& target, const Domain&) {
  return neighbor_deviation(target, congruential_cell);
}

std::optional<double> hashed_cell_correlation(const Model&, const Target& target, const Domain&) {
  return grid_neighbor_deviation(target, ImpactProcess::paper);
}

std::optional<double> counter_cell_correlation(const Model&, const Target& target, const Domain&) {
  return grid_neighbor_deviation(target, ImpactProcess::poisson);
}

}  // namespace textonbench
