// Configs whose samples a graphics processor draws, up to the plan.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/gpu_run.h"
#include "experiments/metrics/metric.h"
#include "experiments/plan.h"
#include "tests/experiments/exemplar_home.h"

namespace textonbench::gpu_plan_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class GpuPlanTest : public testing::Test {
 protected:
  /// Line 7 on.
  Plan plan(const std::string& rest) const {
    const std::filesystem::path file = home_.path() / "c.toml";
    std::ofstream(file) << "title = \"T\"\nsource = \"S\"\n[[runs]]\nname = \"a\"\nmethod = \"texton_noise\"\n"
                        << "exemplars = \"ring\"\n"
                        << rest << "\n";
    return make_plan(read_config(file, Profile::quick), ExemplarCatalog(home_.path()));
  }
  std::string error_of(const std::string& rest) const {
    try {
      plan(rest);
    } catch (const ConfigError& error) {
      return std::string(error.what()).substr((home_.path() / "c.toml").string().size() + 1);
    }
    return "no error";
  }

  const ExemplarHome home_;
  const DataVariable data_{home_.data()};
};

TEST_F(GpuPlanTest, OptionsAreCompleteAndSweptLikeParameters) {
  const Plan p = plan(
      "periodic = false\nmetrics = [\"frame_ms\"]\nparams.support = [15, 31]\n"
      "gpu.path = [\"fragment\", \"compute\"]\ngpu.pitch = 20");
  ASSERT_EQ(p.runs.size(), 4U);
  for (const PlannedRun& run : p.runs) {
    EXPECT_EQ(run.spec.gpu.size(), gpu_run_options().size());
    EXPECT_EQ(run.spec.gpu.at("pitch"), ParamValue(20.0));
    EXPECT_EQ(run.spec.gpu.at("filter"), ParamValue("none"));
  }
  EXPECT_EQ(p.runs[0].spec.gpu.at("path"), ParamValue("fragment"));
  EXPECT_EQ(p.runs[1].spec.gpu.at("path"), ParamValue("compute"));
  EXPECT_EQ(p.runs[1].spec.params.at("support"), ParamValue(std::int64_t{15}));
  EXPECT_EQ(p.runs[2].spec.params.at("support"), ParamValue(std::int64_t{31}));
}

TEST_F(GpuPlanTest, WithoutOptionsThereIsNoGraphicsProcessor) {
  const Plan p = plan("periodic = false\nmetrics = [\"@all\"]");
  ASSERT_EQ(p.runs.size(), 1U);
  EXPECT_TRUE(p.runs[0].spec.gpu.empty());
  for (const std::string& name : p.runs[0].spec.metrics) {
    EXPECT_NE(find_metric(name).level, MetricLevel::frame) << name;
  }
}

TEST_F(GpuPlanTest, BadOptionsAreToldWithTheirPlace) {
  EXPECT_THAT(error_of("periodic = false\nmetrics = [\"frame_ms\"]\ngpu.pth = \"compute\""),
              AllOf(StartsWith("9:5: "), HasSubstr("unknown parameter \"pth\" (did you mean \"path\"?)")));
  EXPECT_THAT(error_of("periodic = false\nmetrics = [\"frame_ms\"]\ngpu.path = [\"compute\", \"vertex\"]"),
              AllOf(StartsWith("9:24: "), HasSubstr("\"vertex\""), HasSubstr("fragment")));
  EXPECT_THAT(error_of("periodic = false\nmetrics = [\"frame_ms\"]\ngpu.pitch = 95"), HasSubstr("pitch"));
}

TEST_F(GpuPlanTest, MetricsOfFramesAndOptionsBelongTogether) {
  EXPECT_THAT(error_of("periodic = false\nmetrics = [\"rme\", \"frame_ms\"]"),
              AllOf(StartsWith("8:11: "), HasSubstr("frame_ms is of frames"), HasSubstr("gpu.path")));
  EXPECT_THAT(error_of("periodic = false\nmetrics = [\"ns_per_pixel\"]\ngpu.path = \"compute\""),
              HasSubstr("expected frame_ms or frame_ns_per_pixel"));
  EXPECT_THAT(error_of("periodic = false\nmetrics = [\"frame_ms\", \"software_frame_ms\"]\ngpu.path = \"compute\""),
              HasSubstr("begin with software_"));
  EXPECT_THAT(error_of("metrics = [\"frame_ms\"]\ngpu.path = \"compute\""), HasSubstr("periodic = true"));
}

}  // namespace textonbench::gpu_plan_test
