// How long a graphics processor takes for a frame, and how near its fetches come to the most that it can do.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "gpu/renderer.h"

namespace textonbench {

struct FrameTimingOptions {
  ShaderPath path = ShaderPath::fragment;
  Frame frame;
  std::optional<SurfaceScene> surface{};  ///< that the frame shows
  /// 0: 200 after 20 to warm up. In software 3 to 200, after a tenth as many, that take about `software_seconds`.
  int frames = 0;
  double software_seconds = 10;
  bool show_progress = false;
};

/// Of the times of frames, in milliseconds. Quantiles are interpolated linearly between the times in order.
struct FrameTimes {
  double median = 0, min = 0, p05 = 0, p95 = 0;
};

struct FrameTiming {
  ShaderPath path = ShaderPath::fragment;
  int frames = 0;
  FrameTimes milliseconds;
  double frames_per_second = 0;         ///< of the median, as all below
  double ns_per_pixel = 0;              ///< of all pixels of the frame
  double useful_fetches_per_pixel = 0;  ///< mean over them
  double fetches_per_second = 0;        ///< useful ones
  /// Of a shader that only fetches (gpu/fetch_ceiling.h), on the same path and frame; of none without textures.
  std::optional<double> coherent_ceiling, incoherent_ceiling;
  std::optional<double> fetch_ceiling_fraction;  ///< fetches_per_second / coherent_ceiling
};

FrameTimes frame_times(std::vector<double> milliseconds);

/// Draws the frame again and again, timed by queries of the graphics processor, or of software by the clock. Throws as
/// Renderer does, and std::invalid_argument for a frame without a pixel that shows the plane.
FrameTiming time_frames(Context& context, const ShaderRecipe& recipe, const FrameTimingOptions& options);

/// Keys: path, frames, ms {median, min, p05, p95}, frames_per_second, ns_per_pixel, fetches_per_pixel,
/// fetches_per_second, fetch_ceiling {coherent, incoherent}, fetch_ceiling_fraction, the last two null without
/// textures.
nlohmann::ordered_json to_json(const FrameTiming& timing);
/// Keys: context, renderer, vendor, version, software.
nlohmann::ordered_json to_json(const ContextInfo& info);

std::string_view shader_path_name(ShaderPath path);

}  // namespace textonbench
