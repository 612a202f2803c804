// Records made up for tests of what reads them.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "experiments/result_set.h"
#include "experiments/run_spec.h"

namespace textonbench {

struct SyntheticRun {
  std::string method = "adsn", exemplar = "ring";
  std::uint64_t seed = 1;
  int samples = 3;
  std::map<std::string, double> metrics{};
  std::string status = "ok";
  std::string cpu = "Example 3000";
};

inline Record make_synthetic_record(const SyntheticRun& run) {
  Record metrics = Record::object(), names = Record::array();
  std::vector<std::string> measured;
  for (const auto& [name, value] : run.metrics) {
    metrics[name] = {{"value", value}, {"stderr", nullptr}, {"unit", "1"}, {"floor", nullptr}};
    names.push_back(name);
    measured.push_back(name);
  }
  Record record = {
      {"schema", 1}, {"id", run.method + "_" + run.exemplar + "_" + std::to_string(run.seed)}, {"status", run.status}};
  if (run.status != "ok") record["reason"] = "made up";
  record["spec"] = {{"method", run.method},     {"params", {{"component", "periodic"}, {"order", 3}}},
                    {"exemplar", run.exemplar}, {"exemplar_sha256", "0123"},
                    {"size", {0, 0}},           {"periodic", true},
                    {"seed", run.seed},         {"samples", run.samples},
                    {"metrics", names},         {"pictures", Record::array()}};
  record["exemplar"] = {{"width", 64}, {"height", 32}, {"channels", 3}};
  record["metrics"] = metrics;
  record["pictures"] = Record::object();
  record["time"] = {
      {"wall_seconds", 0.5}, {"cpu_seconds", 0.4}, {"peak_bytes", 1000}, {"finished", "2024-01-02T03:04:05Z"}};
  record["provenance"] = {{"version", "0.1.0"},   {"code_version", code_version(run.method, measured, false)},
                          {"git_commit", "abc"},  {"git_dirty", false},
                          {"compiler", "GNU 12"}, {"cpu", run.cpu},
                          {"cores", 4},           {"threads", 2}};
  return record;
}

/// Runs on 13 exemplars with 4 seeds each; `change` fills in what is measured.
inline ResultSet make_synthetic_set(const std::function<void(SyntheticRun&)>& change) {
  ResultSet set;
  set.file = "synthetic.jsonl";
  for (int exemplar = 0; exemplar < 13; ++exemplar) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SyntheticRun run{.exemplar = "exemplar_" + std::to_string(exemplar), .seed = seed};
      change(run);
      const Record record = make_synthetic_record(run);
      set.runs[computation(record)] = record;
    }
  }
  return set;
}

}  // namespace textonbench
