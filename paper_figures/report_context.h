// Sections of the report about what stands around the numbers: exemplars, machine, benchmarks.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/exemplars.h"
#include "paper_figures/picture_store.h"
#include "paper_figures/report_runs.h"

namespace textonbench {

/// Name, size, source, licence and SHA-256 of every exemplar of these runs, with its picture where a record keeps one,
/// and a link to its page (exemplar_pages.h) where it has one.
std::string exemplars_html(const std::vector<ReportRun>& runs, const ExemplarCatalog& exemplars, PictureStore& pictures,
                           const std::map<std::string, std::string>& pages);

/// Provenance of the records, each distinct one once.
std::string environment_html(const std::vector<ReportRun>& runs);

/// Rows of a Google Benchmark JSON document, medians where it has them, with their counters; empty when `json` is.
std::string speed_html(const std::string& json);

}  // namespace textonbench
