#include "experiments/metrics/frame_metrics.h"

#include <array>

namespace textonbench {
namespace {

constexpr std::array entries_of_frames{
    MetricEntry{.name = "frame_ms",
                .title = "Time of a frame",
                .unit = "ms",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "median over 200 frames by timer queries of the graphics processor"},
    MetricEntry{.name = "frame_ns_per_pixel",
                .title = "Frame time a pixel",
                .unit = "ns",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "median time of a frame / its pixels"},
    MetricEntry{.name = "frame_fetches_per_second",
                .title = "Useful fetches a second",
                .unit = "1/s",
                .level = MetricLevel::frame,
                .better = Better::higher,
                .reference = "texture fetches that the frame's values depend on / median time of a frame"},
    MetricEntry{.name = "frame_ceiling_fraction",
                .title = "Fraction of the fetch ceiling",
                .unit = "1",
                .level = MetricLevel::frame,
                .better = Better::higher,
                .reference = "useful fetches a second / those of a shader that fetches as many of the same texture "
                             "coherently and does nothing else"},
    MetricEntry{.name = "frame_color_ratio",
                .title = "Time of a frame over that of its first channel",
                .unit = "1",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "median time of a frame / that of the same noise with its first channel alone"},
    MetricEntry{.name = "software_frame_ms",
                .title = "Time of a frame in software",
                .unit = "ms",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "median over 3 to 200 frames that Mesa draws on the processor, by the clock"},
    MetricEntry{.name = "software_ns_per_pixel",
                .title = "Frame time a pixel in software",
                .unit = "ns",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "median time of a frame in software / its pixels"},
    MetricEntry{.name = "software_color_ratio",
                .title = "Time of a frame over that of its first channel, in software",
                .unit = "1",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "as frame_color_ratio, drawn in software"},
    MetricEntry{.name = "sampler_filter_error",
                .title = "Distance of the filter's shader without its filter",
                .unit = "1",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference =
                    "RMSE of an unfiltered frame to that of the shader of filtered ones, as it is, on a texton "
                    "without mip levels, over the noise's standard deviation (CGF 2017, Section 5)",
                .source = "reference_error"},
    MetricEntry{.name = "supersampling_error",
                .title = "Filter error",
                .unit = "1",
                .level = MetricLevel::frame,
                .better = Better::lower,
                .reference = "RMSE of a frame to the mean of 20 x 20 points a pixel of the same impacts, by the same "
                             "shader, over the noise's standard deviation (CGF 2017, Section 5 and Figure 3)",
                .source = "reference_error"},
};

}  // namespace

std::span<const MetricEntry> frame_metrics() { return entries_of_frames; }

}  // namespace textonbench
