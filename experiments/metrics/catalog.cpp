#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "experiments/metrics/autocovariance.h"
#include "experiments/metrics/color_covariance.h"
#include "experiments/metrics/cramer_von_mises.h"
#include "experiments/metrics/metric.h"
#include "experiments/metrics/model_error.h"
#include "experiments/metrics/moments.h"
#include "experiments/metrics/patch_distance.h"
#include "experiments/metrics/spectral_distance.h"

namespace textonbench {
namespace {

constexpr std::array catalog{
    MetricEntry{.name = "rme",
                .title = "Relative model error",
                .unit = "1",
                .level = MetricLevel::model,
                .better = Better::lower,
                .reference = "EUSIPCO 2014, eq. 3, with factor 2 on the cross term: sqrt(W2² / target variance)",
                .of_model = rme},
    MetricEntry{.name = "rme_printed",
                .title = "Relative model error as printed",
                .unit = "1",
                .level = MetricLevel::model,
                .better = Better::neither,
                .reference = "EUSIPCO 2014, eq. 3, as printed (no factor 2 on the cross term)",
                .of_model = rme_printed},
    MetricEntry{.name = "ot_distance",
                .title = "Optimal-transport distance",
                .unit = "value",
                .level = MetricLevel::model,
                .better = Better::lower,
                .reference = "EUSIPCO 2014, eq. 1: sqrt(W2² a pixel) between the Gaussian laws",
                .of_model = ot_distance},
    MetricEntry{.name = "mean_error",
                .title = "Mean error",
                .unit = "sd",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "‖sample mean − target mean‖ in target standard deviations, rms over channels",
                .of_samples = mean_error},
    MetricEntry{.name = "color_covariance_error",
                .title = "Color covariance error",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "Bures distance between covariances at one pixel / sqrt(trace of the target's)",
                .of_samples = color_covariance_error},
    MetricEntry{.name = "autocovariance_error_8",
                .title = "Autocovariance error, lags up to 8",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "sqrt(Σ ‖Ĉ(v) − Γ(v)‖² / Σ ‖Γ(v)‖²), |v|∞ <= 8",
                .of_samples = autocovariance_error_8},
    MetricEntry{.name = "autocovariance_error_32",
                .title = "Autocovariance error, lags up to 32",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "sqrt(Σ ‖Ĉ(v) − Γ(v)‖² / Σ ‖Γ(v)‖²), |v|∞ <= 32",
                .of_samples = autocovariance_error_32},
    MetricEntry{.name = "autocovariance_error_quarter",
                .title = "Autocovariance error, lags up to a quarter of the side",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "sqrt(Σ ‖Ĉ(v) − Γ(v)‖² / Σ ‖Γ(v)‖²), |v_x| <= W/4, |v_y| <= H/4",
                .of_samples = autocovariance_error_quarter},
    MetricEntry{.name = "log_spectral_distance",
                .title = "Log-spectral distance",
                .unit = "dB",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "mean |10 log₁₀(power / target power)| over half-octave rings x 8 orientations",
                .of_samples = log_spectral_distance},
    MetricEntry{.name = "skewness",
                .title = "Skewness",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::nearer_zero,
                .reference = "μ₃ / μ₂^{3/2}, mean over channels",
                .of_samples = skewness},
    MetricEntry{.name = "excess_kurtosis",
                .title = "Excess kurtosis",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::nearer_zero,
                .reference = "μ₄ / μ₂² − 3, mean over channels",
                .of_samples = excess_kurtosis},
    MetricEntry{.name = "cramer_von_mises",
                .title = "Cramér–von Mises statistic",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "1/(12n) + Σ (Φ(z_i) − (2i − 1)/(2n))² on decorrelated pixels; 1/6 for the exact law",
                .of_samples = cramer_von_mises},
    MetricEntry{.name = "patch_distance",
                .title = "Patch distance",
                .unit = "1",
                .level = MetricLevel::sample,
                .better = Better::lower,
                .reference = "sliced W2² of 3 x 3 and 8 x 8 patches at 3 scales / target variance, 512 directions",
                .of_samples = patch_distance},
    MetricEntry{.name = "analyze_seconds",
                .title = "Analysis time",
                .unit = "s",
                .level = MetricLevel::cost,
                .better = Better::lower,
                .reference = "wall time from exemplar to model"},
    MetricEntry{.name = "synthesize_seconds",
                .title = "Synthesis time",
                .unit = "s",
                .level = MetricLevel::cost,
                .better = Better::lower,
                .reference = "wall time of one sample"},
    MetricEntry{.name = "ns_per_pixel",
                .title = "Synthesis time a pixel",
                .unit = "ns",
                .level = MetricLevel::cost,
                .better = Better::lower,
                .reference = "synthesis time / pixels of the sample"},
    MetricEntry{.name = "model_bytes",
                .title = "Model size",
                .unit = "byte",
                .level = MetricLevel::cost,
                .better = Better::lower,
                .reference = "bytes that must be kept to synthesize"},
    MetricEntry{.name = "operations_per_pixel",
                .title = "Operations a pixel",
                .unit = "1",
                .level = MetricLevel::cost,
                .better = Better::lower,
                .reference = "arithmetic operations for each pixel of the sample; an FFT counts 2.5 n log₂ n a plane"},
};

}  // namespace

std::span<const MetricEntry> metric_catalog() { return catalog; }

const MetricEntry& find_metric(std::string_view name) {
  std::vector<std::string_view> names;
  names.reserve(catalog.size());
  for (const MetricEntry& entry : catalog) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw std::invalid_argument(
      fmt::format("unknown metric \"{}\"{}; \"textonbench list metrics\" shows all", name, did_you_mean(name, names)));
}

}  // namespace textonbench
