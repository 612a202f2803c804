// RunSpec -> Record, in this process.
#pragma once

#include <cstdint>
#include <string>

#include "experiments/exemplars.h"
#include "experiments/record.h"
#include "experiments/run_spec.h"

namespace textonbench {

/// Seeds of a run's parts, derived from the run's own: what the analysis draws, and the samples in order.
Seed analysis_seed(std::uint64_t seed);
Seed sample_seed(std::uint64_t seed, int index);

/// Fits, draws the samples, measures, keeps the pictures in `results` (not the record: the caller appends it). A
/// refusal is a record of status "refused" with its reason. Throws what the method throws, and std::invalid_argument
/// when the exemplar is no longer the one that the run names. `results` may be null when no picture is asked for.
///
/// All samples are held at once, and for sample-level metrics as many of the floor: about
/// 2 x samples x size x channels x 4 bytes beside the model.
Record execute(const RunSpec& spec, const ExemplarCatalog& exemplars, const ResultsFolder* results);

/// A record of status "failed" (or "refused") with the same fields, for a run that ended without one.
Record unsuccessful_record(const RunSpec& spec, const std::string& status, const std::string& reason);

}  // namespace textonbench
