#include "experiments/metrics/reference_error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "methods/spot/spline_spectrum.h"

namespace textonbench {
namespace {

/// ∫h², summed over channels.
double spline_variance(const SplineTexton& texton) {
  double sum = 0;
  for (const Image& kernel : texton.coefficients.kernels) {
    const Image overlap = spline_overlap(kernel, texton.order);
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < kernel.height(); ++y) {
        const auto a = kernel.row(c, y);
        sum += std::inner_product(a.begin(), a.end(), overlap.row(c, y).begin(), 0.0);
      }
    }
  }
  return sum;
}

}  // namespace

double distance_in_deviations(const Image& found, const Image& expected, const SplineTexton& texton) {
  double squares = 0;
  std::int64_t count = 0;
  for (int c = 0; c < found.channels(); ++c) {
    for (int y = 0; y < found.height(); ++y) {
      for (int x = 0; x < found.width(); ++x) {
        const double distance = double{found.at(c, x, y)} - expected.at(c, x, y);
        squares += distance * distance;
        count += distance != 0 ? 1 : 0;
      }
    }
  }
  // Mean over the pixels that count, of the squares of all channels.
  const double pixels = std::max<double>(1, static_cast<double>(count) / found.channels());
  return std::sqrt(squares / pixels / spline_variance(texton));
}

std::optional<double> reference_error(const Model& model, const Target&, const Domain& domain) {
  const std::unique_ptr<Model> reference = model.reference();
  if (reference == nullptr || model.spline_texton() == nullptr) return std::nullopt;
  return distance_in_deviations(model.synthesize(domain, Seed{1}), reference->synthesize(domain, Seed{1}),
                                *model.spline_texton());
}

}  // namespace textonbench
