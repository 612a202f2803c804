// A results folder written by hand, with small pictures.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "experiments/config.h"
#include "experiments/files.h"
#include "experiments/plan.h"
#include "experiments/record.h"
#include "methods/base/image_io.h"

namespace textonbench {

class FiguresTest : public testing::Test {
 protected:
  FiguresTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("textonbench_figures_") + std::to_string(::getpid()) + "_" +
                 testing::UnitTest::GetInstance()->current_test_info()->name())),
        results_(folder_) {
    ::setenv("TEXTONBENCH_HOME", TEXTONBENCH_SOURCE_DIR, 1);
    config_.name = "lectures2022/page";
    config_.file = "/elsewhere/configs/lectures2022/page.toml";
    config_.title = "Page";
    config_.source = "Lectures";
  }
  ~FiguresTest() override { std::filesystem::remove_all(folder_); }

  /// Adds a run to the plan; its record is not there yet.
  const PlannedRun& plan_run(const std::string& label, const std::string& exemplar, std::uint64_t seed = 1,
                             const std::map<std::string, ParamValue>& params = {}) {
    RunSpec spec{.method = "rpn",
                 .params = params,
                 .exemplar = exemplar,
                 .exemplar_sha256 = std::string(64, 'a'),
                 .size = {},
                 .periodic = true,
                 .seed = seed,
                 .samples = 4,
                 .metrics = {"mean_error", "rme"},
                 .pictures = {"exemplar", "sample"}};
    plan_.runs.push_back({spec, "id" + std::to_string(plan_.runs.size()) + std::string(13, '0'), label});
    plan_.by_label[label].push_back(plan_.runs.size() - 1);
    return plan_.runs.back();
  }

  /// The record of a run, not yet appended.
  Record record_of(const PlannedRun& run, double rme, double rme_error = 0.01) const {
    return {
        {"schema", 1},
        {"id", run.id},
        {"status", "ok"},
        {"spec", to_json(run.spec)},
        {"command", "textonbench measure rpn '" + run.spec.exemplar + "'"},
        {"exemplar", {{"width", 8}, {"height", 6}, {"channels", 3}}},
        {"metrics",
         {{"rme", {{"value", rme}, {"stderr", rme_error}, {"unit", "1"}, {"floor", 0.125}}},
          {"mean_error", {{"value", 0.5}, {"stderr", nullptr}, {"unit", "sd"}, {"floor", nullptr}}}}},
        {"pictures", Record::object()},
        {"time",
         {{"wall_seconds", 1.5}, {"cpu_seconds", 1.25}, {"peak_bytes", 1048576}, {"finished", "2022-01-01T00:00:00Z"}}},
        {"provenance", {{"code_version", "c0de"}, {"git_commit", "1111111"}, {"git_dirty", false}, {"cpu", "Abacus"}}}};
  }

  Record unsuccessful(const PlannedRun& run, const std::string& status, const std::string& reason) const {
    Record record = record_of(run, 0);
    record["status"] = status;
    record["reason"] = reason;
    record["metrics"] = Record::object();
    return record;
  }

  /// Keeps a picture of one color and names it in the record.
  void add_picture(Record& record, const std::string& name, Extent extent, float red, float green, float blue) const {
    Image image(extent, 3);
    const float color[]{red, green, blue};
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < extent.height; ++y) std::ranges::fill(image.row(c, y), color[c]);
    }
    const std::filesystem::path draft = folder_ / "draft.png";
    write_image(image, draft);
    record["pictures"][name] = {
        {"file", results_.keep_picture(draft)}, {"width", extent.width}, {"height", extent.height}};
  }

  FigureTable& add_figure(const std::string& name, const std::string& kind, const std::vector<std::string>& runs) {
    FigureTable table;
    table.place = {"page.toml", 7, 1};
    table.name = name;
    table.kind = kind;
    table.title = "Title of " + name;
    table.caption = "Caption of " + name;
    table.runs = runs;
    config_.figures.push_back(table);
    return config_.figures.back();
  }

  std::filesystem::path figure_file(const std::string& file) const {
    return folder_ / "figures" / "lectures2022" / "page" / file;
  }

  std::filesystem::path folder_;
  ResultsFolder results_;
  Config config_;
  Plan plan_;
};

}  // namespace textonbench
