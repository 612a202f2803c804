#include "methods/spot/spot_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "methods/base/convolution.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

/// Rows that one thread sums at a time: few enough that they stay in the L2 cache under a strip of impacts.
constexpr int band_rows = 32;

/// Floats of a cache line: sums are made line by line of the output, so that none of its accesses straddles two.
constexpr int line = 16;

RowSpan span_of(const Image& image, int y) {
  RowSpan span{image.width(), 0};
  for (int c = 0; c < image.channels(); ++c) {
    const auto row = image.row(c, y);
    for (int x = 0; x < image.width(); ++x) {
      if (row[static_cast<std::size_t>(x)] != 0) {
        span.first = std::min(span.first, x);
        span.end = std::max(span.end, x + 1);
      }
    }
  }
  return span.end == 0 ? RowSpan{} : span;
}

/// Lines of floats, one register each where they are that wide: of the output, aligned, and of a kernel, anywhere.
using Line = float __attribute__((vector_size(line * sizeof(float)), may_alias));
using UnalignedLine = float __attribute__((vector_size(line * sizeof(float)), aligned(alignof(float)), may_alias));

struct KernelRows {
  const float* data;  ///< pixel (0, 0), with a line of zeros before and after each row
  std::ptrdiff_t stride;
  const RowSpan* spans;
  int count;
};

/// to(x0 + x, y) += s * kernel(x, y) in rows of `stride` floats, which start on a line and are clipped to it.
__attribute__((target_clones("default", "avx2", "avx512f"))) void add_rows(const KernelRows& kernel, float s,
                                                                           std::ptrdiff_t x0, std::ptrdiff_t stride,
                                                                           float* to) {
  for (int y = 0; y < kernel.count; ++y) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, x0 + kernel.spans[y].first) / line * line;
    const std::ptrdiff_t end = std::min(stride, x0 + kernel.spans[y].end);
    const float* from = kernel.data + y * kernel.stride - x0;
    for (std::ptrdiff_t x = first; x < end; x += line) {
      *reinterpret_cast<Line*>(to + x) += s * *reinterpret_cast<const UnalignedLine*>(from + x);
    }
    to += stride;
  }
}

/// Σ_k Σ_x h_{k, c}(x).
double kernel_sum(const SpotKernels& kernels, int channel) {
  double sum = 0;
  for (const Image& kernel : kernels.images) {
    for (int y = 0; y < kernel.height(); ++y) {
      for (const float v : kernel.row(channel, y)) {
        sum += v;
      }
    }
  }
  return sum;
}

/// Shift of impacts along an axis before kernels are laid down: the dilation of the plane's window, or one turn of the
/// torus for the kernels that are cut by its border.
std::array<std::int64_t, 2> shifts(bool periodic, int length, int kernel_length) {
  return periodic ? std::array<std::int64_t, 2>{-std::int64_t{length}, 0}
                  : std::array<std::int64_t, 2>{1 - std::int64_t{kernel_length}, 1 - std::int64_t{kernel_length}};
}

/// Adds the impacts of a strip to the rows [top, end) of one channel.
void add_strip(const SpotKernels& kernels, const ImpactStrip& strip, float scale, int channel,
               std::span<const std::int64_t> x_shifts, std::int64_t y_shift, int top, int end, Image& out) {
  const auto [kernel_width, kernel_height] = kernels.extent();
  if (strip.first_row + y_shift >= end || strip.end_row - 1 + y_shift + kernel_height <= top) {
    return;
  }
  for (const Impact& impact : strip.impacts) {
    const std::int64_t y0 = impact.y + y_shift;
    const auto first = static_cast<int>(std::max<std::int64_t>(0, top - y0));
    const auto last = static_cast<int>(std::min<std::int64_t>(kernel_height, end - y0));
    if (first >= last) {
      continue;
    }
    const Image& kernel = kernels.framed[static_cast<std::size_t>(impact.kernel)];
    const KernelRows rows{kernel.row(channel, first).data() + line, kernel.row_stride(),
                          kernels.spans[static_cast<std::size_t>(impact.kernel)].data() + first, last - first};
    for (const std::int64_t x_shift : x_shifts) {
      const std::int64_t x0 = impact.x + x_shift;
      if (x0 < out.width() && x0 + kernel_width > 0) {
        add_rows(rows, scale * impact.weight, x0, out.row_stride(),
                 out.row(channel, static_cast<int>(y0 + first)).data());
      }
    }
  }
}

/// The image between a line of zeros on its left and one on its right.
Image frame(const Image& image) {
  Image framed({image.width() + 2 * line, image.height()}, image.channels());
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      std::ranges::copy(image.row(c, y), framed.row(c, y).begin() + line);
    }
  }
  return framed;
}

}  // namespace

SpotKernels::SpotKernels(const std::vector<Image>& full) {
  int left = full.front().width();
  int right = 0;
  int top = full.front().height();
  int bottom = 0;
  for (const Image& kernel : full) {
    for (int y = 0; y < kernel.height(); ++y) {
      const RowSpan span = span_of(kernel, y);
      if (span.first < span.end) {
        left = std::min(left, span.first);
        right = std::max(right, span.end);
        top = std::min(top, y);
        bottom = std::max(bottom, y + 1);
      }
    }
  }
  images.reserve(full.size());
  framed.reserve(full.size());
  spans.reserve(full.size());
  for (const Image& kernel : full) {
    images.push_back(crop(kernel, left, top, {right - left, bottom - top}));
    framed.push_back(frame(images.back()));
    std::vector<RowSpan>& rows = spans.emplace_back();
    rows.reserve(static_cast<std::size_t>(bottom - top));
    for (int y = 0; y < bottom - top; ++y) {
      rows.push_back(span_of(images.back(), y));
      span_pixels += rows.back().end - rows.back().first;
    }
  }
}

Image sum_direct(const SpotKernels& kernels, const ImpactSet& impacts, double scale, const std::vector<double>& start,
                 const SumDomain& domain) {
  const int channels = kernels.channels();
  std::vector<float> first_value;
  first_value.reserve(start.size());
  for (int c = 0; c < channels; ++c) {
    const double expected = impacts.mean_weight * kernel_sum(kernels, c);
    first_value.push_back(static_cast<float>(start[static_cast<std::size_t>(c)] - scale * expected));
  }
  const auto x_shifts = shifts(domain.periodic, domain.size.width, kernels.extent().width);
  const auto y_shifts = shifts(domain.periodic, domain.size.height, kernels.extent().height);
  const std::size_t turns = domain.periodic ? 2 : 1;
  Image out = Image::uninitialized(domain.size, channels);
  parallel_for((domain.size.height + band_rows - 1) / band_rows, [&](int band) {
    const int top = band * band_rows;
    const int end = std::min(top + band_rows, domain.size.height);
    for (int c = 0; c < channels; ++c) {
      for (int y = top; y < end; ++y) {
        std::fill_n(out.row(c, y).data(), out.row_stride(), first_value[static_cast<std::size_t>(c)]);
      }
      for (const std::int64_t y_shift : std::span(y_shifts).first(turns)) {
        for (const ImpactStrip& strip : impacts.strips) {
          add_strip(kernels, strip, static_cast<float>(scale), c, std::span(x_shifts).first(turns), y_shift, top, end,
                    out);
        }
      }
    }
  });
  return out;
}

Image sum_spectral(const SpotKernels& kernels, const ImpactSet& impacts, double scale, const std::vector<double>& start,
                   const SumDomain& domain) {
  const auto [width, height] = kernels.extent();
  const Extent field_size =
      domain.periodic ? domain.size : Extent{domain.size.width + width - 1, domain.size.height + height - 1};
  std::vector<Image> fields(kernels.images.size(), Image(field_size, 1));
  for (const ImpactStrip& strip : impacts.strips) {
    for (const Impact& impact : strip.impacts) {
      fields[static_cast<std::size_t>(impact.kernel)].at(0, impact.x, impact.y) += impact.weight;
    }
  }
  for (Image& field : fields) {
    parallel_for(field_size.height, [&](int y) {
      for (float& v : field.row(0, y)) {
        v = static_cast<float>(scale * (v - impacts.mean_weight));
      }
    });
  }
  Image out = domain.periodic ? convolve_circular(kernels.images, fields) : convolve_valid(kernels.images, fields);
  add_constant(start, out);
  return out;
}

// The nanoseconds are those of benchmarks/dsn_bench on one thread of a Sapphire Rapids server (1024², supports of 15²
// to 256²), where the chosen route is the faster one or nearly so; only their ratio matters.

RouteCost cost_direct(const SpotKernels& kernels, double impacts, const SumDomain& domain) {
  constexpr double row_nanoseconds = 1.5;
  constexpr double line_nanoseconds = 1.6;
  const auto [width, height] = kernels.extent();
  const double reached_columns = domain.size.width + (domain.periodic ? 0.0 : width - 1.0);
  const double mean_span = static_cast<double>(kernels.span_pixels) / kernels.count() / height;
  const double rows = impacts * reached_columns * domain.size.height * height * kernels.channels();
  // A span meets (span + line − 1) / line lines on average over its places.
  const double lines = rows * (mean_span + line - 1) / line;
  const double sums = impacts * static_cast<double>(domain.size.area()) * mean_span * height * kernels.channels();
  return {2 * sums, row_nanoseconds * rows + line_nanoseconds * lines};
}

RouteCost cost_spectral(const SpotKernels& kernels, const SumDomain& domain) {
  constexpr double operation_nanoseconds = 0.14;
  const auto pixels =
      static_cast<double>((domain.periodic ? domain.size : convolution_grid(kernels.extent(), domain.size)).area());
  // Transforms: of the counts and of the channels of every kernel, and back for each channel.
  const double products = static_cast<double>(kernels.count()) * kernels.channels();
  const double transforms = kernels.count() + products + kernels.channels();
  // A complex product, and the addition of two after the first kernel.
  const double operations = pixels * (transforms * 2.5 * std::log2(pixels) + 4 * products - kernels.channels());
  return {operations, operation_nanoseconds * operations};
}

}  // namespace textonbench
