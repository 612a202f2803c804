#include "experiments/metrics/torus_crop.h"

#include <algorithm>
#include <cmath>

#include "experiments/metrics/replicates.h"
#include "experiments/metrics/spot_samples.h"
#include "experiments/metrics/target_law.h"
#include "methods/spot/spot_noise.h"

namespace textonbench {
namespace {

constexpr Extent cropped{64, 64};
constexpr int longest_lag = 63;
constexpr int missing_pixels = 14;

const Texton* only_kernel(const Model& model) {
  const Texton* texton = model.texton();
  return texton != nullptr && texton->kernels.size() == 1 ? texton : nullptr;
}

Extent torus_of(const Texton& texton, int lacks) {
  return {cropped.width + texton.extent().width - 1 - lacks, cropped.height + texton.extent().height - 1 - lacks};
}

std::optional<double> crop_error(const Model& model, int lacks) {
  const Texton* texton = only_kernel(model);
  if (texton == nullptr) return std::nullopt;
  const Image& kernel = texton->kernels.front();
  const CrossSpectrum law = model.gaussian()->spectrum(torus_of(*texton, lacks));
  const Autocovariance circular = autocovariance(law);
  double error = 0;
  for (int c = 0; c < kernel.channels(); ++c) {
    const double variance = autocorrelation(kernel, c, 0, 0);
    if (variance == 0) continue;
    // Autocovariance leaves out frequency zero, which no deviation from an image's own mean has; that of the noise
    // from its expectation does.
    const double constant = std::norm(law.factors.front().at(c, 0, 0)) / static_cast<double>(law.grid().area());
    for_each_lag(longest_lag, [&](int x, int y) {
      const double difference = circular.at(c, c, x, y) + constant - autocorrelation(kernel, c, x, y);
      error = std::max(error, std::fabs(difference) / variance);
    });
  }
  return error;
}

std::optional<double> crop_deviation(const Model& model, const Target& target, int lacks) {
  const Texton* texton = only_kernel(model);
  if (texton == nullptr) return std::nullopt;
  const std::unique_ptr<Model> noise = make_spot_noise(*texton, {.impacts = Impacts::poisson, .mni = 30});
  const Domain torus{.size = torus_of(*texton, lacks), .periodic = true};
  const Seed seed = derive(derive(Seed{1}, "torus_crop_deviation"), target.exemplar.name);
  constexpr int samples = 512;
  const Replicates replicates = draw_replicates(samples, [&](int i) {
    const Image sample = noise->synthesize(torus, derive(seed, static_cast<std::uint64_t>(i)));
    return lag_products(centered(crop(sample, 0, 0, cropped), texton->mean, cropped), longest_lag);
  });
  std::vector<double> expected;
  for (int c = 0; c < texton->channels(); ++c) {
    for_each_lag(longest_lag,
                 [&](int x, int y) { expected.push_back(autocorrelation(texton->kernels.front(), c, x, y)); });
  }
  return largest_deviation(replicates, expected);
}

}  // namespace

std::optional<double> torus_crop_error(const Model& model, const Target&, const Domain&) {
  return crop_error(model, 0);
}

std::optional<double> small_torus_crop_error(const Model& model, const Target&, const Domain&) {
  return crop_error(model, missing_pixels);
}

std::optional<double> torus_crop_deviation(const Model& model, const Target& target, const Domain&) {
  return crop_deviation(model, target, 0);
}

std::optional<double> small_torus_crop_deviation(const Model& model, const Target& target, const Domain&) {
  return crop_deviation(model, target, missing_pixels);
}

}  // namespace textonbench
