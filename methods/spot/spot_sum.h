// Sum of kernels over a set of impacts, by one of two routes that give the same image to rounding, and what each costs.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/spot/impacts.h"

namespace textonbench {

/// Part of a kernel's row outside which all its channels are zero.
struct RowSpan {
  int first = 0;
  int end = 0;
};

/// Kernels cropped to the smallest rectangle that holds what is not zero of any, with the spans of their rows.
struct SpotKernels {
  explicit SpotKernels(const std::vector<Image>& full);

  std::vector<Image> images;
  std::vector<Image> framed;                ///< the same with 16 columns of zeros on either side
  std::vector<std::vector<RowSpan>> spans;  ///< [kernel][row]
  std::int64_t span_pixels = 0;             ///< in the spans of all kernels

  Extent extent() const { return images.front().extent(); }
  int channels() const { return images.front().channels(); }
  int count() const { return static_cast<int>(images.size()); }
};

/// Where the sum is wanted. On a torus impacts are pixels of it and kernels are wrapped; on the plane impacts are in
/// the window that reaches extent − 1 pixels of the kernels further up and to the left.
struct SumDomain {
  Extent size;
  bool periodic = false;
};

/// start_c + scale Σ_i (weight_i h_{k_i, c}(x − x_i) − its expectation over all impacts).
Image sum_direct(const SpotKernels& kernels, const ImpactSet& impacts, double scale, const std::vector<double>& start,
                 const SumDomain& domain);
Image sum_spectral(const SpotKernels& kernels, const ImpactSet& impacts, double scale, const std::vector<double>& start,
                   const SumDomain& domain);

/// Arithmetic operations of a route, in all, and an estimate of its time on one thread.
struct RouteCost {
  double operations = 0;
  double nanoseconds = 0;
};
/// `impacts`: how many a pixel.
RouteCost cost_direct(const SpotKernels& kernels, double impacts, const SumDomain& domain);
RouteCost cost_spectral(const SpotKernels& kernels, const SumDomain& domain);

}  // namespace textonbench
