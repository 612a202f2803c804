// How FFTW's plans are made, and where their wisdom is kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "methods/base/fft.h"
#include "methods/base/fft_plan.h"
#include "tests/base/scratch_folder.h"

namespace textonbench::fft_plans_test {

using testing::HasSubstr;

// The environment is read when a plan is made, and plans live as long as their process; so a new process runs tests of
// this program, under the given settings of variables; all of these tests, also where this process has only its share.
int run_tests_of_new_process(const std::string& settings, const std::string& filter, const std::filesystem::path& log) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  return std::system(("env -u GTEST_TOTAL_SHARDS -u GTEST_SHARD_INDEX " + settings + " '" + program +
                      "' --gtest_filter=" + filter + " >'" + log.string() + "' 2>&1")
                         .c_str());
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(FftPlans, MeasuredPlansAreRightAndKeepTheirWisdom) {
  const ScratchFolder scratch;
  const auto log = scratch / "log";
  const auto wisdom = scratch.path() / "cache" / "textonbench" / "fftwf-wisdom";
  const std::string cache = "XDG_CACHE_HOME='" + (scratch / "cache").string() + "' ";
  const std::string tests = "ForwardFft.IsTheNaiveTransform";

  EXPECT_EQ(run_tests_of_new_process(cache + "TEXTONBENCH_FFT_PLAN=estimate", tests, log), 0) << contents(log);
  EXPECT_FALSE(exists(wisdom));
  EXPECT_EQ(run_tests_of_new_process(cache + "TEXTONBENCH_FFT_PLAN=measure", tests, log), 0) << contents(log);
  EXPECT_THAT(contents(wisdom), HasSubstr("fftw"));

  // A damaged file is made anew.
  std::ofstream(wisdom) << "(fftw-3.3.10 fftwf_wisdom #x0";
  EXPECT_EQ(run_tests_of_new_process(cache + "TEXTONBENCH_FFT_PLAN=measure", tests, log), 0) << contents(log);
  EXPECT_GT(contents(wisdom).size(), 100U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(wisdom.parent_path()), {}), 1) << "drafts are left over";
}

TEST(FftPlans, AnUnwritableCacheOnlyCostsTime) {
  const ScratchFolder scratch;
  const auto log = scratch / "log";
  EXPECT_EQ(run_tests_of_new_process("XDG_CACHE_HOME=/dev/null TEXTONBENCH_FFT_PLAN=measure",
                                     "InverseFft.IgnoresTheImaginaryPartOfSelfConjugateBins", log),
            0)
      << contents(log);
}

TEST(FftPlans, AnUnknownRigorIsRefused) {
  const ScratchFolder scratch;
  const auto log = scratch / "log";
  EXPECT_NE(run_tests_of_new_process("TEXTONBENCH_FFT_PLAN=fast", "ForwardFft.LeavesItsInputAlone", log), 0);
  EXPECT_THAT(contents(log), HasSubstr("TEXTONBENCH_FFT_PLAN=\"fast\": expected \"estimate\" or \"measure\""));
}

TEST(FftPlans, RigorAndVersionAreTold) {
  EXPECT_THAT(fft_plan_rigor(), testing::AnyOf(testing::StrEq("estimate"), testing::StrEq("measure")));
  EXPECT_THAT(fft_library_version(), HasSubstr("fftw-3"));
}

}  // namespace textonbench::fft_plans_test
