#include "methods/base/double_fft.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "methods/base/fft_plan.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

constexpr int block = SpectrumColumns::count;

/// Scratch of this thread: `complex_count` bins, then a row of reals.
std::complex<double>* scratch(std::size_t complex_count) {
  thread_local AlignedBuffer<std::complex<double>> buffer;
  if (buffer.size() < complex_count) buffer = AlignedBuffer<std::complex<double>>(complex_count);
  return buffer.data();
}

}  // namespace

BoxTransform::BoxTransform(Extent grid, Extent box) : grid_(grid), box_(box) {
  if (box.width < 1 || box.height < 1 || box.width > grid.width || box.height > grid.height) {
    throw std::invalid_argument(fmt::format("box of {}x{} on a grid of {}x{}: expected one that fits", box.width,
                                            box.height, grid.width, grid.height));
  }
}

void BoxTransform::rows_forward(const Planes& fields, Workspace& half) const {
  const RealLineFft plan(grid_.width);
  half.resize(static_cast<std::size_t>(fields.channels) * static_cast<std::size_t>(box_.height) *
              static_cast<std::size_t>(columns()));
  parallel_for(fields.channels * box_.height, [&](int i) {
    auto* line = reinterpret_cast<double*>(scratch(static_cast<std::size_t>(columns())));
    const double* row = fields.row(0, 0) + std::ptrdiff_t{i} * box_.width;
    std::copy_n(row, box_.width, line);
    std::fill(line + box_.width, line + grid_.width, 0.0);
    plan.forward(line, half.data() + std::ptrdiff_t{i} * columns());
  });
}

void BoxTransform::rows_inverse(Workspace& half, Planes& fields) const {
  const RealLineFft plan(grid_.width);
  parallel_for(fields.channels * box_.height, [&](int i) {
    auto* line = reinterpret_cast<double*>(scratch(static_cast<std::size_t>(columns())));
    plan.inverse(half.data() + std::ptrdiff_t{i} * columns(), line);
    std::copy_n(line, box_.width, fields.row(0, 0) + std::ptrdiff_t{i} * box_.width);
  });
}

void BoxTransform::all_columns(Passes passes, int channels, const ColumnMap& map, Workspace& half) const {
  const DoubleLineFft forward(grid_.height, FftDirection::forward);
  const DoubleLineFft backward(grid_.height, FftDirection::backward);
  const int height = grid_.height;
  half.resize(static_cast<std::size_t>(channels) * static_cast<std::size_t>(box_.height) *
              static_cast<std::size_t>(columns()));
  parallel_for((columns() + block - 1) / block, [&](int b) {
    const SpectrumColumns lines{
        .first = b * block,
        .height = height,
        .bins = scratch(static_cast<std::size_t>(channels) * block * static_cast<std::size_t>(height))};
    const int count = std::min(block, columns() - lines.first);
    const auto row = [&](int c, int y) {
      return half.data() + (std::ptrdiff_t{c} * box_.height + y) * columns() + lines.first;
    };
    if (passes != Passes::inverse) {
      for (int c = 0; c < channels; ++c) {
        std::complex<double>* out = lines.column(c, 0);
        for (int y = 0; y < box_.height; ++y) {
          const std::complex<double>* in = row(c, y);
          for (int i = 0; i < count; ++i) out[std::ptrdiff_t{i} * height + y] = in[i];
        }
        for (int i = 0; i < count; ++i) {
          std::fill(lines.column(c, i) + box_.height, lines.column(c, i) + height, 0.0);
          forward(lines.column(c, i));
        }
      }
    }
    map(lines);
    if (passes != Passes::forward) {
      for (int c = 0; c < channels; ++c) {
        for (int i = 0; i < count; ++i) backward(lines.column(c, i));
        const std::complex<double>* in = lines.column(c, 0);
        for (int y = 0; y < box_.height; ++y) {
          std::complex<double>* out = row(c, y);
          for (int i = 0; i < count; ++i) out[i] = in[std::ptrdiff_t{i} * height + y];
        }
      }
    }
  });
}

void BoxTransform::map(Planes& fields, const ColumnMap& map, Workspace& workspace) const {
  rows_forward(fields, workspace);
  all_columns(Passes::both, fields.channels, map, workspace);
  rows_inverse(workspace, fields);
}

void BoxTransform::forward(const Planes& fields, const ColumnMap& visit, Workspace& workspace) const {
  rows_forward(fields, workspace);
  all_columns(Passes::forward, fields.channels, visit, workspace);
}

void BoxTransform::inverse(const ColumnMap& source, Planes& fields, Workspace& workspace) const {
  all_columns(Passes::inverse, fields.channels, source, workspace);
  rows_inverse(workspace, fields);
}

}  // namespace textonbench
