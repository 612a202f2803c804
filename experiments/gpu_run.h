// Runs whose samples a graphics processor draws: the frames of the renderer in place of what the method synthesizes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/execute.h"
#include "methods/base/params.h"

namespace textonbench {

/// Options of RunSpec::gpu: path, fetch, filter, window, half, supersampling, height and pitch of a camera over the
/// ground (pitch 0: none), and scene, bump and displacement of a surface.
std::span<const ParamSpec> gpu_run_options();

/// Why a run cannot be what these parts of it say.
struct GpuObjection {
  std::string key;  ///< "metrics" or "periodic"
  std::string message;
};
/// Metrics of the level frame belong to runs with options under gpu, one that is timed draws either on a graphics
/// processor or in software, nothing of such a run is synthesized on the processor, and it draws the plane.
std::optional<GpuObjection> object_to_gpu(const std::vector<std::string>& metrics, bool on_gpu, bool periodic);

/// execute() for any run. With options under gpu the record also has provenance.gpu, as to_json(ContextInfo), and, when
/// it timed frames, timing, as to_json(FrameTiming). Frames are timed on a graphics processor alone, and refused with
/// "needs a GPU" where there is none, unless metrics whose names begin with "software_" are asked for: those are
/// measured by OSMesa.
Record execute_run(const RunSpec& spec, const ExemplarCatalog& exemplars, const ResultsFolder* results);

}  // namespace textonbench
