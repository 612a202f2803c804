// Pictures too large to be drawn at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "experiments/execute.h"
#include "experiments/exemplars.h"
#include "methods/base/image_io.h"
#include "methods/method.h"
#include "tests/cli/program.h"
#include "tests/sanitizer.h"
#include "tests/temporary_folder.h"

namespace textonbench::synth_test {

TEST(SynthTest, ALargeWindowIsDrawnInBandsOfOneField) {
  const TemporaryFolder folder;
  Exemplar exemplar{.name = "gray", .pixels = Image({24, 20}, 1), .sha256 = ""};
  fill_normal(Stream(Seed{5}), 0, 0, exemplar.pixels.row(0, 7));
  fill_normal(Stream(Seed{5}), 1, 0, exemplar.pixels.row(0, 12));
  write_image(exemplar.pixels, folder.path() / "gray.exr");
  const Outcome outcome = run_program(
      {"synth", "dsn", "gray.exr", "-p", "component=raw", "-p", "mni=3", "--size", "16448x1024", "-o", "large.exr"},
      {folder.path()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Image large = read_image(folder.path() / "large.exr").image;
  ASSERT_EQ(large.extent(), (Extent{16448, 1024}));

  const MethodEntry& dsn = find_method("dsn");
  const Params params(dsn.params, {{"component", std::string("raw")}, {"mni", 3.0}});
  const std::unique_ptr<Model> model = dsn.analyze({exemplar}, params, analysis_seed(1));
  const int top = 240;  // across the border of two bands
  const Image window =
      model->synthesize({.size = {300, 40}, .origin = {16000, static_cast<double>(top)}}, sample_seed(1, 0));
  double variance = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 300; ++x) {
      ASSERT_NEAR(large.at(0, 16000 + x, top + y), window.at(0, x, y), 1e-4) << x << ' ' << y;
      variance += window.at(0, x, y) * window.at(0, x, y) / 12000;
    }
  }
  EXPECT_GT(variance, 0.01);
}

TEST(SynthTest, AnOriginMovesTheWindow) {
  const TemporaryFolder folder;
  const auto synth = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"synth", "texton_noise", "white_noise", "-p", "support=9", "-p", "route=points"};
    all.insert(all.end(), more.begin(), more.end());
    return run_program(all, {folder.path()});
  };
  ASSERT_EQ(synth({"--size", "20x12", "-o", "whole.exr"}).status, 0);
  ASSERT_EQ(synth({"--size", "5x4", "--origin", "7,3", "-o", "part.exr"}).status, 0);
  const Image whole = read_image(folder.path() / "whole.exr").image;
  const Image part = read_image(folder.path() / "part.exr").image;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) EXPECT_EQ(part.at(1, x, y), whole.at(1, x + 7, y + 3)) << x << ' ' << y;
  }
  EXPECT_EQ(synth({"--periodic", "--origin", "7,3", "-o", "torus.exr"}).status, 2);
  // A measurement has no place to keep an origin in.
  EXPECT_EQ(run_program({"measure", "texton_noise", "white_noise", "--origin", "7,3"}, {folder.path()}).status, 2);
}

TEST(SynthTest, MemoryThatIsNotThereIsToldAndLeavesNoFile) {
  if (sanitized) GTEST_SKIP() << "a sanitizer reserves terabytes of addresses";
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      {"synth", "texton_noise", "white_noise", "--threads", "2", "--size", "60000x60000", "-o", "large.png"},
      {.folder = folder.path(), .most_memory = std::size_t{8} << 30});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, testing::AllOf(testing::HasSubstr("has not the memory"), testing::HasSubstr("--size")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "large.png"));
}

}  // namespace textonbench::synth_test
