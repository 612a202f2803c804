#include "methods/spot/impacts.h"

#include <algorithm>
#include <cmath>

#include "methods/base/parallel.h"

namespace textonbench {
namespace {

std::int64_t floor_quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

std::int32_t draw_kernel(RandomSequence& random, int kernels) {
  return kernels == 1 ? 0 : static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(kernels)));
}

/// Appends the impact at the point (x, y) of the plane if it is in the window.
void append_inside(const PlaneWindow& window, std::int64_t x, std::int64_t y, std::int32_t kernel, float weight,
                   std::vector<Impact>& impacts) {
  const std::int64_t column = x - window.x;
  const std::int64_t row = y - window.y;
  if (column >= 0 && column < window.size.width && row >= 0 && row < window.size.height) {
    impacts.push_back({static_cast<std::int32_t>(column), static_cast<std::int32_t>(row), kernel, weight});
  }
}

/// The strip of the plane's rows [first, end) that the window has.
ImpactStrip strip_of(const PlaneWindow& window, std::int64_t first, std::int64_t end) {
  const auto row = [&](std::int64_t y) {
    return static_cast<int>(std::clamp<std::int64_t>(y - window.y, 0, window.size.height));
  };
  return {row(first), row(end), {}};
}

/// Calls draw(cy, row_stream) -> ImpactStrip for cy in [first, last].
template <class Draw>
std::vector<ImpactStrip> draw_rows(const Stream& stream, std::int64_t first, std::int64_t last, const Draw& draw) {
  std::vector<ImpactStrip> strips(static_cast<std::size_t>(last - first + 1));
  parallel_for(static_cast<int>(strips.size()), [&](int i) {
    strips[static_cast<std::size_t>(i)] = draw(first + i, stream.child(static_cast<std::uint64_t>(first + i)));
  });
  return strips;
}

ImpactSet draw_sparse_poisson(const Stream& stream, double intensity, int kernels, const PlaneWindow& window) {
  const PoissonCells cells = poisson_cells(intensity);
  const int shift = cells.shift;
  const double mean = cells.mean;
  const std::uint32_t mask = (1U << static_cast<unsigned>(shift)) - 1;
  const auto draw = [&](std::int64_t cy, const Stream& row) {
    ImpactStrip strip = strip_of(window, cy << shift, (cy + 1) << shift);
    for (std::int64_t cx = window.x >> shift; cx <= (window.x + window.size.width - 1) >> shift; ++cx) {
      RandomSequence random(row.child(static_cast<std::uint64_t>(cx)));
      for (std::int64_t rest = random.poisson(mean); rest > 0; --rest) {
        const std::uint32_t word = random.next();
        const std::int32_t kernel = draw_kernel(random, kernels);
        append_inside(window, (cx << shift) + (word & mask), (cy << shift) + ((word >> 16U) & mask), kernel, 1,
                      strip.impacts);
      }
    }
    return strip;
  };
  return {draw_rows(stream, window.y >> shift, (window.y + window.size.height - 1) >> shift, draw),
          intensity / kernels};
}

/// A stream serves a segment of a row.
ImpactSet draw_dense_poisson(const Stream& stream, double intensity, int kernels, const PlaneWindow& window) {
  constexpr int shift = 6;
  const double mean = intensity / kernels;
  const auto draw = [&](std::int64_t y, const Stream& row) {
    ImpactStrip strip = strip_of(window, y, y + 1);
    strip.impacts.reserve(static_cast<std::size_t>(window.size.width) * static_cast<std::size_t>(kernels));
    for (std::int64_t segment = window.x >> shift; segment <= (window.x + window.size.width - 1) >> shift; ++segment) {
      RandomSequence random(row.child(static_cast<std::uint64_t>(segment)));
      for (std::int64_t x = segment << shift; x < (segment + 1) << shift; ++x) {
        for (std::int32_t kernel = 0; kernel < kernels; ++kernel) {
          const double number = static_cast<double>(random.poisson(mean));
          append_inside(window, x, y, kernel, static_cast<float>(number - mean), strip.impacts);
        }
      }
    }
    return strip;
  };
  return {draw_rows(stream, window.y, window.y + window.size.height - 1, draw), 0};
}

/// First and last of the cells that have a point of the pixels [first, first + count).
std::pair<std::int64_t, std::int64_t> cells_of(const CellAxis& axis, std::int64_t first, int count) {
  return {floor_quotient(first * axis.denominator, axis.numerator),
          floor_quotient((first + count) * axis.denominator - 1, axis.numerator)};
}

/// Pixel of a point drawn uniformly among the `numerator` steps of 1 / denominator pixel that make up the cell.
std::int64_t draw_pixel(RandomSequence& random, const CellAxis& axis, std::int64_t cell) {
  const auto step = static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(axis.numerator)));
  return floor_quotient(cell * axis.numerator + step, axis.denominator);
}

CellAxis torus_axis(double side, int length) {
  return {length, std::max(std::int64_t{1}, static_cast<std::int64_t>(std::llround(length / side)))};
}

}  // namespace

std::int64_t ImpactSet::size() const {
  std::size_t total = 0;
  for (const ImpactStrip& strip : strips) {
    total += strip.impacts.size();
  }
  return static_cast<std::int64_t>(total);
}

ImpactSet draw_poisson(const Stream& stream, double intensity, int kernels, const PlaneWindow& window) {
  return intensity < dense_intensity ? draw_sparse_poisson(stream, intensity, kernels, window)
                                     : draw_dense_poisson(stream, intensity, kernels, window);
}

PoissonCells poisson_cells(double intensity) {
  const int shift = std::clamp(static_cast<int>(std::floor(0.5 * std::log2(32 / intensity))), 1, 15);
  return {shift, intensity * static_cast<double>(std::int64_t{1} << (2 * shift))};
}

CellLattice plane_lattice(double intensity) {
  constexpr std::int64_t steps = 1024;
  const CellAxis axis{std::llround(static_cast<double>(steps) / std::sqrt(intensity)), steps};
  return {axis, axis};
}

CellLattice torus_lattice(double intensity, Extent torus) {
  const double side = 1 / std::sqrt(intensity);
  return {torus_axis(side, torus.width), torus_axis(side, torus.height)};
}

ImpactSet draw_stratified(const Stream& stream, const CellLattice& lattice, int kernels, const PlaneWindow& window) {
  const auto columns = cells_of(lattice.x, window.x, window.size.width);
  const auto rows = cells_of(lattice.y, window.y, window.size.height);
  const auto draw = [&](std::int64_t cy, const Stream& row) {
    ImpactStrip strip = strip_of(window, floor_quotient(cy * lattice.y.numerator, lattice.y.denominator),
                                 floor_quotient((cy + 1) * lattice.y.numerator - 1, lattice.y.denominator) + 1);
    strip.impacts.reserve(static_cast<std::size_t>(columns.second - columns.first + 1));
    for (std::int64_t cx = columns.first; cx <= columns.second; ++cx) {
      RandomSequence random(row.child(static_cast<std::uint64_t>(cx)));
      const float sign = (random.next() & 1U) == 0 ? 1.0F : -1.0F;
      const std::int64_t x = draw_pixel(random, lattice.x, cx);
      const std::int64_t y = draw_pixel(random, lattice.y, cy);
      append_inside(window, x, y, draw_kernel(random, kernels), sign, strip.impacts);
    }
    return strip;
  };
  return {draw_rows(stream, rows.first, rows.second, draw), 0};
}

}  // namespace textonbench
