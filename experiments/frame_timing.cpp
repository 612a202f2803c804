#include "experiments/frame_timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "experiments/progress.h"
#include "gpu/fetch_ceiling.h"
#include "gpu/texture.h"

namespace textonbench {
namespace {

constexpr int usual_frames = 200;
constexpr int usual_warm_up = 20;
constexpr int least_software_frames = 3;

/// Shares of `software_seconds`; the rest is for compiling.
constexpr double method_share = 0.5;
constexpr double ceiling_share = 0.15;

/// Samples of the plane in a frame.
double covered_samples(const Frame& frame) {
  const double samples = frame.supersampling * frame.supersampling;
  if (!frame.ground) return samples * static_cast<double>(frame.size.area());
  const GroundView view(frame.size, *frame.ground);
  double covered = 0;
  for (int y = 0; y < frame.size.height; ++y) {
    for (int x = 0; x < frame.size.width; ++x) covered += view.covers(x, y) ? 1 : 0;
  }
  if (covered == 0) throw std::invalid_argument("no pixel of the frame shows ground: expected a lower or steeper view");
  return samples * covered;
}

/// Milliseconds of `count` frames after `warm_up` others. In software by the clock, frame by frame: timer queries of
/// llvmpipe count what they wait for, and leave dispatches out.
std::vector<double> time_turn(Renderer& renderer, const Frame& frame, bool software, int warm_up, int count) {
  if (!software) return renderer.time(frame, warm_up, count);
  if (warm_up > 0) renderer.time(frame, warm_up - 1, 1);
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const auto start = std::chrono::steady_clock::now();
    renderer.time(frame, 0, 1);
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return times;
}

std::vector<double> time_recipe(Context& context, const ShaderRecipe& recipe, const FrameTimingOptions& options,
                                double share) {
  const bool software = context.info().software;
  Renderer renderer(context, recipe, options.path, options.surface);
  // The first frame compiles.
  const double typical = std::max(1e-3, time_turn(renderer, options.frame, software, 1, 1).front());
  int frames = options.frames > 0 ? options.frames : usual_frames;
  int warm_up = usual_warm_up;
  if (software) {
    const double fit = 1e3 * share * options.software_seconds / typical;
    if (options.frames == 0) frames = static_cast<int>(std::clamp<double>(fit, least_software_frames, frames));
    warm_up = std::min(warm_up, frames / 10);
  }
  // Between two reports of progress: a fifth of a second.
  const int turn = static_cast<int>(std::clamp<double>(200 / typical, 1, frames));
  Progress progress(static_cast<std::size_t>(frames), "frames of " + recipe.shader, options.show_progress, {});
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(frames));
  for (int left = frames; left > 0;) {
    const int count = std::min(left, turn);
    for (const double t : time_turn(renderer, options.frame, software, left == frames ? warm_up : 0, count)) {
      times.push_back(t);
      progress.advance("");
    }
    left -= count;
  }
  return times;
}

/// Fetches a second of a shader that does nothing else.
nlohmann::ordered_json or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

double fetch_ceiling(Context& context, const ShaderRecipe& recipe, const FrameTimingOptions& options, double samples) {
  const FrameTimes times = frame_times(time_recipe(context, recipe, options, ceiling_share));
  return 1e3 * recipe.useful_fetches * samples / times.median;
}

}  // namespace

FrameTimes frame_times(std::vector<double> milliseconds) {
  if (milliseconds.empty()) throw std::invalid_argument("times of no frame: expected at least one");
  std::ranges::sort(milliseconds);
  const auto quantile = [&](double share) {
    const double place = share * static_cast<double>(milliseconds.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, milliseconds.size() - 1);
    return std::lerp(milliseconds[below], milliseconds[above], place - static_cast<double>(below));
  };
  return {.median = quantile(0.5), .min = milliseconds.front(), .p05 = quantile(0.05), .p95 = quantile(0.95)};
}

FrameTiming time_frames(Context& context, const ShaderRecipe& recipe, const FrameTimingOptions& options) {
  require_drawable(context, options.frame.size);
  const double samples = covered_samples(options.frame);
  const auto pixels = static_cast<double>(options.frame.size.area());
  const std::vector<double> times = time_recipe(context, recipe, options, method_share);
  FrameTiming timing;
  timing.path = options.path;
  timing.frames = static_cast<int>(times.size());
  timing.milliseconds = frame_times(times);
  const double seconds = 1e-3 * timing.milliseconds.median;
  timing.frames_per_second = 1 / seconds;
  timing.ns_per_pixel = 1e9 * seconds / pixels;
  timing.useful_fetches_per_pixel = recipe.useful_fetches * samples / pixels;
  timing.fetches_per_second = recipe.useful_fetches * samples / seconds;
  if (recipe.textures.empty()) return timing;
  timing.coherent_ceiling = fetch_ceiling(context, fetch_ceiling_recipe(recipe, true), options, samples);
  timing.incoherent_ceiling = fetch_ceiling(context, fetch_ceiling_recipe(recipe, false), options, samples);
  timing.fetch_ceiling_fraction = timing.fetches_per_second / *timing.coherent_ceiling;
  return timing;
}

nlohmann::ordered_json to_json(const FrameTiming& timing) {
  const FrameTimes& ms = timing.milliseconds;
  return {{"path", shader_path_name(timing.path)},
          {"frames", timing.frames},
          {"ms", {{"median", ms.median}, {"min", ms.min}, {"p05", ms.p05}, {"p95", ms.p95}}},
          {"frames_per_second", timing.frames_per_second},
          {"ns_per_pixel", timing.ns_per_pixel},
          {"fetches_per_pixel", timing.useful_fetches_per_pixel},
          {"fetches_per_second", timing.fetches_per_second},
          {"fetch_ceiling",
           {{"coherent", or_null(timing.coherent_ceiling)}, {"incoherent", or_null(timing.incoherent_ceiling)}}},
          {"fetch_ceiling_fraction", or_null(timing.fetch_ceiling_fraction)}};
}

nlohmann::ordered_json to_json(const ContextInfo& info) {
  return {{"context", context_name(info.kind)},
          {"renderer", info.renderer},
          {"vendor", info.vendor},
          {"version", info.version},
          {"software", info.software}};
}

std::string_view shader_path_name(ShaderPath path) { return path == ShaderPath::compute ? "compute" : "fragment"; }

}  // namespace textonbench
