// Runs whose samples are frames.
#include "experiments/gpu_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "gpu/context.h"
#include "methods/base/image_io.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"

namespace textonbench::gpu_run_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class GpuRunTest : public testing::Test {
 protected:
  void SetUp() override {
    try {
      info_ = make_context()->info();
    } catch (const GpuError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  RunSpec make_spec(std::map<std::string, ParamValue> gpu) const {
    RunSpec spec;
    spec.method = "texton_noise";
    spec.params = Params(find_method("texton_noise").params,
                         {{"support", std::int64_t{15}}, {"iterations", std::int64_t{2}}, {"mni", 4.0}})
                      .values();
    spec.exemplar = "white_noise";
    spec.size = {48, 32};
    spec.periodic = false;
    spec.gpu = Params(gpu_run_options(), gpu).values();
    return spec;
  }
  Record run(const RunSpec& spec) const { return execute_run(spec, exemplars_, &results_); }
  double measured(const RunSpec& spec) const {
    return run(spec)["metrics"][spec.metrics.front()]["value"].get<double>();
  }

  ContextInfo info_;
  TemporaryFolder folder_;
  ResultsFolder results_{folder_.path()};
  ExemplarCatalog exemplars_{TEXTONBENCH_SOURCE_DIR};
};

TEST_F(GpuRunTest, SamplesAreThoseOfTheProcessor) {
  RunSpec spec = make_spec({{"fetch", "manual"}});
  spec.pictures = {"sample"};
  const Record frame = run(spec);
  EXPECT_EQ(frame["status"], "ok");
  EXPECT_EQ(frame["provenance"]["gpu"]["renderer"], info_.renderer);
  EXPECT_FALSE(frame.contains("timing"));
  spec.gpu.clear();
  const Record sample = run(spec);
  EXPECT_FALSE(sample["provenance"].contains("gpu"));
  const auto picture = [&](const Record& record) {
    return read_image(folder_.path() / record["pictures"]["sample"]["file"].get<std::string>()).image;
  };
  const Image a = picture(frame), b = picture(sample);
  ASSERT_EQ(a.extent(), b.extent());
  double largest = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      largest = std::max(largest, std::abs(double{a.at(0, x, y)} - double{b.at(0, x, y)}));
    }
  }
  EXPECT_LE(largest, 1.01 / 255) << "files of 8 bits";
}

TEST_F(GpuRunTest, SoftwareIsTimedUnderNamesOfItsOwn) {
  RunSpec spec = make_spec({});
  spec.metrics = {"software_color_ratio", "software_frame_ms", "software_ns_per_pixel"};
  const Record record = run(spec);
  ASSERT_EQ(record["status"], "ok") << record.dump();
  EXPECT_TRUE(record["provenance"]["gpu"]["software"].get<bool>());
  EXPECT_EQ(record["provenance"]["gpu"]["context"], "osmesa");
  const double ms = record["metrics"]["software_frame_ms"]["value"];
  EXPECT_GT(ms, 0);
  EXPECT_EQ(record["timing"]["ms"]["median"], ms);
  EXPECT_NEAR(record["metrics"]["software_ns_per_pixel"]["value"].get<double>(), 1e6 * ms / (48 * 32), 1e-6 * ms);
  EXPECT_GT(record["metrics"]["software_color_ratio"]["value"].get<double>(), 0);
}

TEST_F(GpuRunTest, SoftwareIsNoGraphicsProcessor) {
  RunSpec spec = make_spec({});
  spec.metrics = {"frame_ms"};
  const Record record = run(spec);
  if (!info_.software) {
    EXPECT_GT(record["metrics"]["frame_ms"]["value"].get<double>(), 0);
    return;
  }
  EXPECT_EQ(record["status"], "refused");
  EXPECT_THAT(record["reason"].get<std::string>(), AllOf(StartsWith("needs a GPU: "), HasSubstr(info_.renderer)));
  EXPECT_TRUE(record["metrics"].empty());
  spec.metrics.clear();
  spec.gpu["filter"] = "anisotropic";
  EXPECT_THAT(run(spec)["reason"].get<std::string>(), HasSubstr("no anisotropic filter of its own"));
}

TEST_F(GpuRunTest, FiltersAreHeldAgainstSupersampling) {
  RunSpec spec = make_spec({{"fetch", "manual"}, {"pitch", 20.0}, {"height", 24.0}});
  spec.metrics = {"supersampling_error"};
  const double unfiltered = measured(spec);
  spec.gpu["filter"] = "anisotropic";
  const double filtered = measured(spec);
  EXPECT_GT(filtered, 0);
  EXPECT_LT(filtered, 0.5 * unfiltered);
  spec.gpu["filter"] = "none";
  spec.gpu["supersampling"] = std::int64_t{20};
  EXPECT_EQ(measured(spec), 0);
}

TEST_F(GpuRunTest, AFilterOfTheTextureAloneLeavesTheShaderAsItIs) {
  RunSpec spec = make_spec({{"pitch", 20.0}, {"height", 24.0}});
  spec.metrics = {"sampler_filter_error"};
  EXPECT_LT(measured(spec), 1e-3);
}

TEST_F(GpuRunTest, WhatCannotBeIsRefusedBeforeAnythingIsDrawn) {
  RunSpec spec = make_spec({});
  spec.periodic = true;
  EXPECT_THROW(run(spec), std::invalid_argument);
  spec.periodic = false;
  spec.metrics = {"synthesize_seconds"};
  EXPECT_THROW(run(spec), std::invalid_argument);
}

TEST_F(GpuRunTest, ACommandAndAConfigDoTheSame) {
  const Surroundings here{folder_.path()};
  std::ofstream(folder_.path() / "c.toml")
      << "title = \"T\"\nsource = \"S\"\n[[runs]]\nname = \"a\"\nmethod = \"texton_noise\"\n"
      << "exemplars = \"white_noise\"\nsize = [48, 32]\nperiodic = false\nsamples = 1\n"
      << "params = {support = 15, iterations = 2, mni = 4}\n"
      << "metrics = [\"supersampling_error\"]\ngpu = {fetch = \"manual\", pitch = 20}\n";
  const Outcome outcome = run_program({"run", "c.toml", "--json"}, here);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Record record = ResultsFolder(folder_.path() / "results").read().records.at(0);
  ASSERT_EQ(record["status"], "ok") << record.dump();
  const auto command = record["command"].get<std::string>();
  EXPECT_THAT(command, AllOf(StartsWith("textonbench measure "), HasSubstr("--gpu fetch=manual")));
  const Outcome repeated = run_program(
      {"measure", "texton_noise", "white_noise",         "-p",    "support=15", "-p",     "iterations=2", "-p",
       "mni=4",   "--gpu",        "fetch=manual",        "--gpu", "pitch=20",   "--size", "48x32",        "--samples",
       "1",       "--metrics",    "supersampling_error", "--json"},
      here);
  ASSERT_EQ(repeated.status, 0) << repeated.err;
  const Record measured = Record::parse(repeated.out);
  EXPECT_EQ(measured["metrics"], record["metrics"]);
  EXPECT_EQ(measured["id"], record["id"]);
  EXPECT_EQ(measured["gpu"]["renderer"], info_.renderer);
}

}  // namespace textonbench::gpu_run_test
