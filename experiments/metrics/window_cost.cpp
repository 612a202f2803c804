#include "experiments/metrics/window_cost.h"

#include <algorithm>
#include <array>
#include <chrono>

namespace textonbench {
namespace {

double synthesis_seconds(const Model& model, const Domain& domain, Seed seed) {
  const auto start = std::chrono::steady_clock::now();
  model.synthesize(domain, seed);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::optional<double> distant_window_ratio(const Model& model, const Target&, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  constexpr Extent size{64, 64};
  constexpr double middle = 16384.0 / 2 - 32;
  constexpr std::size_t repetitions = 101;
  const Domain corner{.size = size}, distant{.size = size, .origin = {middle, middle}};
  std::array<double, repetitions> near_seconds{}, far_seconds{};
  for (std::size_t i = 0; i < repetitions; ++i) {
    near_seconds[i] = synthesis_seconds(model, corner, Seed{i});
    far_seconds[i] = synthesis_seconds(model, distant, Seed{i});
  }
  const auto median = [](std::array<double, repetitions>& values) {
    std::ranges::nth_element(values, values.begin() + repetitions / 2);
    return values[repetitions / 2];
  };
  return median(far_seconds) / median(near_seconds);
}

}  // namespace textonbench
