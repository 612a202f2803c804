// textonbench inpaint: what it tells and what it refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/inpaint_picture.h"

namespace textonbench::inpaint_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using InpaintRefusals = InpaintTest;

TEST_F(InpaintRefusals, ASolutionThatIsNotToTheToleranceIsToldWithWhatToDo) {
  const Outcome outcome =
      run({"u.exr", "--rect", hole, "-o", "v.exr", "--solver", "normal", "--iterations", "3", "--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning"), HasSubstr("3 iterations"), HasSubstr("--iterations"),
                                 HasSubstr("--solver schwarz"), HasSubstr("--nugget")));
  EXPECT_TRUE(std::filesystem::exists(file("v.exr")));
  EXPECT_THAT(run({"u.exr", "--rect", hole, "-o", "v.exr", "--quiet"}).err, testing::IsEmpty());
}

TEST_F(InpaintRefusals, ASingularSystemIsToldWithTheNuggetThatHelps) {
  const Arguments all{"u.exr", "--rect", hole, "--covariance", "torus", "--border", "10", "-o", "v.exr"};
  expect_refused(all, AllOf(HasSubstr("singular"), HasSubstr("nugget")));
  Arguments with_nugget = all;
  with_nugget.insert(with_nugget.end(), {"--nugget", "1e-3"});
  EXPECT_EQ(run(with_nugget).status, 0);
}

TEST_F(InpaintRefusals, RefusesMasksThatDoNotFit) {
  write_image(Image({48, 41}, 1), file("other_size.png"));
  expect_refused({"u.exr", "--mask", "other_size.png", "-o", "v.exr"},
                 AllOf(HasSubstr("other_size.png"), HasSubstr("48x41"), HasSubstr("48x40")));
  write_image(mask_picture(Mask(size)), file("nothing.png"));
  expect_refused({"u.exr", "--mask", "nothing.png", "-o", "v.exr"}, HasSubstr("no pixel is missing"));
  write_image(mask_picture(Mask(size, true)), file("everything.png"));
  expect_refused({"u.exr", "--mask", "everything.png", "-o", "v.exr"}, HasSubstr("every pixel is missing"));
  expect_refused({"u.exr", "--rect", "40,0,9,5", "-o", "v.exr"}, AllOf(HasSubstr("40,0,9,5"), HasSubstr("48x40")));
  expect_refused({"u.exr", "--rect", "4,0,9", "-o", "v.exr"}, HasSubstr("x,y,w,h"));
  expect_refused({"u.exr", "--mask", "hols", "-o", "v.exr"}, AllOf(HasSubstr("\"hols\""), HasSubstr("holes")));
  expect_refused({"u.exr", "-o", "v.exr"}, AllOf(HasSubstr("--mask"), HasSubstr("--rect")));
  expect_refused({"u.exr", "--mask", "hole.png", "--rect", hole, "-o", "v.exr"},
                 AllOf(HasSubstr("--mask"), HasSubstr("--rect")));
  expect_refused({"u.exr", "--rect", hole, "--missing", "5", "-o", "v.exr"}, HasSubstr("--missing"));
  EXPECT_FALSE(std::filesystem::exists(file("v.exr")));
}

TEST_F(InpaintRefusals, RefusesPicturesThatTellNoModel) {
  expect_refused({"u.exr", "--rect", "0,0,48,39", "-o", "v.exr"},
                 AllOf(HasSubstr("48 known pixels"), HasSubstr("at least 64")));
  Image flat(size, 3);
  flat.at(1, 20, 15) = 1;  // missing
  write_image(flat, file("flat.exr"));
  expect_refused({"flat.exr", "--rect", hole, "-o", "v.exr"}, AllOf(HasSubstr("flat.exr"), HasSubstr("one color")));
  write_image(test_texture(size, 1), file("gray.png"));
  expect_refused({"u.exr", "--rect", hole, "--exemplar", "gray.png", "-o", "v.exr"},
                 AllOf(HasSubstr("3 channels"), HasSubstr("gray"), HasSubstr("of 1")));
  expect_refused({"gray.png", "--rect", hole, "--exemplar", "u.exr", "-o", "v.exr"}, HasSubstr("of 3"));
  expect_refused({"missing.png", "--rect", hole, "-o", "v.exr"}, HasSubstr("missing.png"));
  expect_refused({"u.exr", "--rect", hole, "--exemplar", "missing.png", "-o", "v.exr"}, HasSubstr("missing.png"));
}

TEST_F(InpaintRefusals, RefusesOptionsOutOfRange) {
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--border", "0"},
                                                                                      {"--border", "two"},
                                                                                      {"--nugget", "-1"},
                                                                                      {"--nugget", "nan"},
                                                                                      {"--solver", "gauss"},
                                                                                      {"--covariance", "sphere"},
                                                                                      {"--tolerance", "2"},
                                                                                      {"--iterations", "0"}}) {
    expect_refused({"u.exr", "--rect", hole, fmt::format("{}={}", option, value), "-o", "v.exr"},
                   AllOf(HasSubstr(option.substr(2)), HasSubstr(value), HasSubstr("expected")));
  }
  EXPECT_EQ(run({"u.exr", "--rect", hole, "--samples", "0", "-o", "v.exr"}).status, 2);
}

TEST_F(InpaintRefusals, AnOutputThatCannotBeWrittenLeavesEarlierFiles) {
  std::ofstream(file("v.png")) << "earlier";
  std::ofstream(file("v.jpg")) << "earlier";
  std::filesystem::create_directory(file("folder.png"));
  expect_refused({"u.exr", "--rect", hole, "-o", "v.jpg"}, AllOf(HasSubstr("v.jpg"), HasSubstr(".png or .exr")));
  expect_refused({"u.exr", "--rect", hole, "-o", "nowhere/v.png"}, HasSubstr("nowhere/v.png: cannot be written"));
  expect_refused({"u.exr", "--rect", hole, "-o", "folder.png"}, HasSubstr("folder.png: cannot be written"));
  expect_refused({"u.exr", "--mask", "everything", "-o", "v.png"}, HasSubstr("everything"));
  const Outcome full = run_program({"inpaint", "u.exr", "--rect", hole, "-o", "v.png"},
                                   {.folder = folder_.path(), .largest_file = 1024});
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.err, HasSubstr("v.png: cannot be written"));
  EXPECT_EQ(content_of(file("v.png")), "earlier");
  EXPECT_EQ(content_of(file("v.jpg")), "earlier");
}

TEST_F(InpaintRefusals, HelpEndsWithExamples) {
  const Outcome outcome = run({"--help"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("not zero in any channel means missing"), HasSubstr("--nugget"),
                                 HasSubstr("textonbench inpaint photo.png --mask"), Not(HasSubstr("--model"))));
}

}  // namespace textonbench::inpaint_test
