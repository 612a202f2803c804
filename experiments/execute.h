// RunSpec -> Record, in this process.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "experiments/exemplars.h"
#include "experiments/record.h"
#include "experiments/run_spec.h"

namespace textonbench {

/// Seeds of a run's parts, derived from the run's own: what the analysis draws, and the samples in order.
Seed analysis_seed(std::uint64_t seed);
Seed sample_seed(std::uint64_t seed, int index);

/// Draws the samples of a run in place of its model, and measures frames (MetricLevel::frame).
class FrameDrawer {
 public:
  virtual ~FrameDrawer() = default;
  virtual Image draw(const Model& model, const Domain& domain, Seed seed) = 0;
  virtual double measure(std::string_view metric, const Model& model, const Domain& domain, Seed seed) = 0;
  /// Adds to the record what drew, and what else was measured.
  virtual void describe(Record& record) const = 0;
};

/// Fits, draws the samples, measures, keeps the pictures in `results` (not the record: the caller appends it). A
/// refusal is a record of status "refused" with its reason. Throws what the method throws, and std::invalid_argument
/// when the exemplar is no longer the one that the run names. `results` may be null when no picture is asked for, and
/// `drawer` where the model itself draws the samples.
///
/// All samples are held at once, and for sample-level metrics as many of the floor: about
/// 2 x samples x size x channels x 4 bytes beside the model.
Record execute(const RunSpec& spec, const ExemplarCatalog& exemplars, const ResultsFolder* results,
               FrameDrawer* drawer = nullptr);

/// A record of status "failed" (or "refused") with the same fields, for a run that ended without one.
Record unsuccessful_record(const RunSpec& spec, const std::string& status, const std::string& reason);

}  // namespace textonbench
