// Runs a plan: each run in a child process with a timeout, each result a record.
#pragma once

#include <cstddef>
#include <vector>

#include "experiments/child_process.h"
#include "experiments/exemplars.h"
#include "experiments/plan.h"
#include "experiments/record.h"

namespace textonbench {

struct RunOptions {
  int jobs = 1;        ///< children at once
  int threads = 1;     ///< threads of each child
  bool fresh = false;  ///< run again what is already recorded
  bool show_progress = true;
};

/// What `textonbench run` prints with --json.
struct RunSummary {
  std::size_t planned = 0;
  std::size_t recorded = 0;  ///< executed now, successfully
  std::size_t reused = 0;    ///< already there
  std::size_t failed = 0;    ///< crashed, timed out or threw; each has its record
  std::size_t refused = 0;
  double seconds = 0;
  std::vector<BadLine> bad_lines;  ///< of the records that were there before: skipped, kept in the file
};

/// What a child that has ended leaves of its run: the record that it sent, or one of status "failed" that says why
/// there is none: the signal, the limit that it broke, garbage where the record was expected.
Record record_of(const PlannedRun& run, const ChildProcess& child);

/// Every planned run ends as a record or was there before (status "ok" or "refused"; failures are tried again).
/// Children are forked, so this process must not have started threads. SIGINT and SIGTERM stop the children, keep
/// what is recorded and return what was done so far with `interrupted` set.
///
/// The folder also gets logs/run-DATE.log (progress), logs/ID.stderr (what a failed run printed) and, of a program
/// built from uncommitted sources, provenance/SHA256.diff. A run without a memory limit of its own may take its share,
/// among `jobs`, of three quarters of the machine's memory; one that a graphics processor draws has no limit then, and
/// runs beside no other such run.
RunSummary run_plan(const Plan& plan, const ExemplarCatalog& exemplars, const ResultsFolder& results,
                    const RunOptions& options, bool* interrupted);

}  // namespace textonbench
