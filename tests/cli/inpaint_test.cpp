// textonbench inpaint: what it writes, what it tells, and what it refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/execute.h"
#include "methods/base/image_io.h"
#include "methods/conditional/inpainting.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench::inpaint_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;
using Arguments = std::vector<std::string>;

constexpr Extent size{48, 40};
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

bool in_hole(int x, int y) { return x >= 17 && x < 27 && y >= 12 && y < 20; }
const char* const hole = "17,12,10,8";

Mask hole_mask() {
  Mask mask(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mask.set(x, y, in_hole(x, y));
  }
  return mask;
}

Image mask_picture(const Mask& mask) {
  Image picture(mask.extent(), 1);
  for (const Pixel& p : pixels_of(mask)) picture.at(0, p.x, p.y) = 1;
  return picture;
}

void expect_same_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.extent(), b.extent());
  ASSERT_EQ(a.channels(), b.channels());
  for (int c = 0; c < a.channels(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(a.at(c, x, y)), std::bit_cast<std::uint32_t>(b.at(c, x, y)))
            << c << ' ' << x << ' ' << y;
      }
    }
  }
}

class InpaintTest : public testing::Test {
 protected:
  InpaintTest() : picture_(test_texture(size, 3)) {
    write_image(picture_, file("u.exr"));
    write_image(picture_, file("u.png"));
    write_image(mask_picture(hole_mask()), file("hole.png"));
  }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  Image read(const std::string& name) const { return read_image(file(name)).image; }
  Outcome run(Arguments arguments) const {
    arguments.insert(arguments.begin(), "inpaint");
    return run_program(arguments, {folder_.path()});
  }
  Json run_json(Arguments arguments) const {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
  void expect_refused(const Arguments& arguments, const testing::Matcher<const std::string&>& message) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("error: "), message));
  }

  TemporaryFolder folder_;
  Image picture_;
};

TEST_F(InpaintTest, KnownPixelsKeepTheirBitsAndMissingOnesAreDrawn) {
  const Outcome outcome = run({"u.exr", "--rect", hole, "-o", "v.exr", "--seed", "4"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("v.exr: 48x40, 80 pixels missing, 144 conditioning"), HasSubstr("dense")));
  const Image v = read("v.exr");
  double squares = 0;
  double cross = 0;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const float before = picture_.at(c, x, y);
        if (!in_hole(x, y)) {
          ASSERT_EQ(std::bit_cast<std::uint32_t>(v.at(c, x, y)), std::bit_cast<std::uint32_t>(before));
        } else {
          squares += std::pow(v.at(c, x, y) - 0.55, 2) / 240;
          cross += v.at(c, x, y) == before ? 1 : 0;
        }
      }
    }
  }
  EXPECT_EQ(cross, 0);
  // Deviations of the texture are some 0.08 to 0.11.
  EXPECT_GT(squares, 0.03 * 0.03);
  EXPECT_LT(squares, 0.2 * 0.2);
  const Inpainting model(picture_, hole_mask(), nullptr, {});
  expect_same_bits(v, model.sample(sample_seed(4, 0)).image);
}

TEST_F(InpaintTest, LevelsOfAnEightBitPictureStayTheSame) {
  ASSERT_EQ(run({"u.png", "--mask", "hole.png", "-o", "v.png"}).status, 0);
  const Image u = read("u.png");
  const Image v = read("v.png");
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (!in_hole(x, y)) ASSERT_EQ(u.at(c, x, y), v.at(c, x, y));
      }
    }
  }
}

TEST_F(InpaintTest, TheSameSeedGivesTheSameBytes) {
  ASSERT_EQ(run({"u.exr", "--rect", hole, "-o", "a.exr", "--threads", "1", "--solver", "schwarz"}).status, 0);
  ASSERT_EQ(run({"u.exr", "--mask", "hole.png", "-o", "b.exr", "--threads", "4", "--solver", "schwarz"}).status, 0);
  ASSERT_EQ(run({"u.exr", "--rect", hole, "-o", "c.exr", "--seed", "2", "--solver", "schwarz"}).status, 0);
  EXPECT_EQ(content_of(file("a.exr")), content_of(file("b.exr")));
  EXPECT_NE(content_of(file("a.exr")), content_of(file("c.exr")));
}

TEST_F(InpaintTest, SamplesAreNumberedAndDiffer) {
  const Json document = run_json({"u.exr", "--rect", hole, "-o", "v.exr", "--samples", "3"});
  ASSERT_EQ(document["samples"].size(), 3U);
  EXPECT_EQ(document["samples"][0]["files"], Json{"v.exr"});
  EXPECT_EQ(document["samples"][2]["files"], Json{"v_3.exr"});
  const Inpainting model(picture_, hole_mask(), nullptr, {});
  expect_same_bits(read("v_2.exr"), model.sample(sample_seed(1, 1)).image);
  EXPECT_NE(content_of(file("v.exr")), content_of(file("v_2.exr")));
  EXPECT_NE(content_of(file("v_2.exr")), content_of(file("v_3.exr")));
}

TEST_F(InpaintTest, TheDocumentTellsTheSystemAndItsSolution) {
  const Json document = run_json({"u.exr", "--rect", hole, "-o", "v.exr", "--solver", "cg", "--border", "2",
                                  "--tolerance", "1e-8", "--nugget", "0.01", "--iterations", "5000"});
  EXPECT_EQ(document["missing_pixels"], 80);
  EXPECT_EQ(document["conditioning_pixels"], 14 * 12 - 80);
  for (int c = 0; c < 3; ++c) {
    double sum = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) sum += in_hole(x, y) ? 0.0 : double{picture_.at(c, x, y)};
    }
    EXPECT_NEAR(document["mean"][static_cast<std::size_t>(c)].get<double>(), sum / (48 * 40 - 80), 1e-9);
  }
  const Json& sample = document["samples"][0];
  EXPECT_EQ(sample["solver"], "cg");
  EXPECT_EQ(sample["unknowns"], 3 * 88);
  EXPECT_EQ(sample["reason"], "tolerance");
  EXPECT_EQ(sample["converged"], true);
  EXPECT_LT(sample["residual"], 1e-7);
  EXPECT_GT(sample["iterations"], 10);
  EXPECT_GE(sample["seconds"]["solve"], 0);
  EXPECT_GE(document["seconds"], sample["seconds"]["solve"]);
}

TEST_F(InpaintTest, ComponentsAddUpToTheSample) {
  const Json document = run_json({"u.exr", "--rect", hole, "-o", "v.exr", "--components"});
  EXPECT_EQ(document["components"],
            (Json{"v_masked.exr", "v_conditioning.exr", "v_kriging.exr", "v_innovation.exr", "v_strip.png"}));
  EXPECT_EQ(document["kriging"]["solver"], "dense");
  const Image v = read("v.exr");
  const Image kriging = read("v_kriging.exr");
  const Image innovation = read("v_innovation.exr");
  const Image masked = read("v_masked.exr");
  const Image conditioning = read("v_conditioning.exr");
  const Inpainting model(picture_, hole_mask(), nullptr, {});
  expect_same_bits(kriging, model.kriging());
  const Image random = model.innovation(sample_seed(1, 0));
  for (int c = 0; c < 3; ++c) {
    const auto mean = document["mean"][static_cast<std::size_t>(c)].get<double>();
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        ASSERT_NEAR(kriging.at(c, x, y) + innovation.at(c, x, y) - (in_hole(x, y) ? mean : innovation.at(c, 0, 0)),
                    v.at(c, x, y), 1e-6);
        ASSERT_NEAR(innovation.at(c, x, y) - mean, random.at(c, x, y), 1e-6);
        const bool near = x >= 14 && x < 30 && y >= 9 && y < 23;
        // The texture's mean is above one half, so what is not shown is black.
        ASSERT_EQ(masked.at(c, x, y), in_hole(x, y) ? 0.0F : picture_.at(c, x, y));
        ASSERT_EQ(conditioning.at(c, x, y), near && !in_hole(x, y) ? picture_.at(c, x, y) : 0.0F);
      }
    }
  }
  EXPECT_GT(read("v_strip.png").width(), 5 * 160);
}

TEST_F(InpaintTest, MissingPixelsMayHoldAnything) {
  Image holes = picture_;
  for (const Pixel& p : pixels_of(hole_mask())) {
    for (int c = 0; c < 3; ++c) holes.at(c, p.x, p.y) = c == 1 ? std::numeric_limits<float>::infinity() : nan;
  }
  write_image(holes, file("holes.exr"));
  ASSERT_EQ(run({"u.exr", "--rect", hole, "-o", "v.exr", "--components"}).status, 0);
  const Outcome outcome = run({"holes.exr", "--rect", hole, "-o", "w.exr", "--components"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {".exr", "_masked.exr", "_conditioning.exr", "_innovation.exr", "_strip.png"}) {
    EXPECT_EQ(content_of(file(std::string("v") + name)), content_of(file(std::string("w") + name))) << name;
  }
  expect_refused({"holes.exr", "--rect", "17,12,10,7", "-o", "x.exr"},
                 AllOf(HasSubstr("holes.exr"), HasSubstr("(17, 19)"), HasSubstr("nan"), HasSubstr("finite")));
}

TEST_F(InpaintTest, RectanglesAndShapesAreMasks) {
  EXPECT_EQ(run_json({"u.exr", "--rect", "0,0,5,5", "--rect", "3,3,5,5", "-o", "v.exr"})["missing_pixels"], 46);
  EXPECT_EQ(run_json({"u.exr", "--mask", "rect:0,0,5,5;3,3,5,5", "-o", "w.exr"})["missing_pixels"], 46);
  EXPECT_EQ(content_of(file("v.exr")), content_of(file("w.exr")));
  EXPECT_EQ(run_json({"u.exr", "--mask", "ragged", "--missing", "5", "-o", "v.exr"})["missing_pixels"], 96);
  EXPECT_EQ(run_json({"u.exr", "--mask", "pixels", "-o", "v.exr"})["missing_pixels"], 192);
}

TEST_F(InpaintTest, AMaskMayTouchAllBorders) {
  Mask frame(size, true);
  for (int y = 3; y < size.height - 3; ++y) {
    for (int x = 3; x < size.width - 3; ++x) frame.set(x, y, false);
  }
  Mask cross(size);
  for (int x = 0; x < size.width; ++x) cross.set(x, 20, true);
  for (int y = 0; y < size.height; ++y) cross.set(24, y, true);
  for (const Mask& mask : {frame, cross}) {
    write_image(mask_picture(mask), file("mask.png"));
    for (const char* covariance : {"plane", "torus"}) {
      const Outcome outcome = run({"u.exr", "--mask", "mask.png", "--covariance", covariance, "--nugget", "1e-3",
                                   "--border", "1", "-o", "v.exr"});
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_FALSE(find_non_finite(read("v.exr")));
    }
  }
}

TEST_F(InpaintTest, TheModelMayBeThatOfAPartOrOfAnotherExemplar) {
  const Image other = test_texture({30, 50}, 3, 9);
  write_image(other, file("other.exr"));
  ASSERT_EQ(run({"u.exr", "--rect", hole, "--exemplar", "other.exr", "-o", "a.exr"}).status, 0);
  const Exemplar exemplar{"other", other, ""};
  expect_same_bits(read("a.exr"), Inpainting(picture_, hole_mask(), &exemplar, {}).sample(sample_seed(1, 0)).image);
  ASSERT_EQ(run({"u.exr", "--rect", hole, "--clean", "2,3,12,30", "-o", "b.exr"}).status, 0);
  expect_same_bits(
      read("b.exr"),
      Inpainting(picture_, hole_mask(), nullptr, {.clean = Rectangle{2, 3, {12, 30}}}).sample(sample_seed(1, 0)).image);
  expect_refused({"u.exr", "--rect", hole, "--exemplar", "other.exr", "--clean", "0,0,16,16", "-o", "c.exr"},
                 HasSubstr("expected one"));
  expect_refused({"u.exr", "--rect", hole, "--clean", "40,0,16,16", "-o", "c.exr"},
                 AllOf(HasSubstr("40,0,16,16"), HasSubstr("48x40")));
  expect_refused({"u.exr", "--rect", hole, "--clean", "1,1,2147483647,16", "-o", "c.exr"}, HasSubstr("48x40"));
  expect_refused({"u.exr", "--rect", hole, "--clean", "40,0", "-o", "c.exr"}, HasSubstr("x,y,w,h"));
}

TEST_F(InpaintTest, MapsOfOneSurfaceAreDrawnTogether) {
  write_image(test_texture(size, 1, 7), file("height.png"));
  const Outcome outcome = run({"u.png+height.png", "--rect", hole, "--components", "-o", "v.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read("v_u.png").channels(), 3);
  EXPECT_EQ(read("v_height.png").channels(), 1);
  EXPECT_EQ(read("v_kriging_height.png").extent(), size);
  EXPECT_EQ(read("v_strip.png").channels(), 3);
}

TEST_F(InpaintTest, ASolutionThatIsNotToTheToleranceIsToldWithWhatToDo) {
  const Outcome outcome =
      run({"u.exr", "--rect", hole, "-o", "v.exr", "--solver", "normal", "--iterations", "3", "--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("warning"), HasSubstr("3 iterations"), HasSubstr("--iterations"),
                                 HasSubstr("--solver schwarz"), HasSubstr("--nugget")));
  EXPECT_TRUE(std::filesystem::exists(file("v.exr")));
  EXPECT_THAT(run({"u.exr", "--rect", hole, "-o", "v.exr", "--quiet"}).err, testing::IsEmpty());
}

TEST_F(InpaintTest, ASingularSystemIsToldWithTheNuggetThatHelps) {
  const Arguments all{"u.exr", "--rect", hole, "--covariance", "torus", "--border", "20", "-o", "v.exr"};
  expect_refused(all, AllOf(HasSubstr("singular"), HasSubstr("nugget")));
  Arguments with_nugget = all;
  with_nugget.insert(with_nugget.end(), {"--nugget", "1e-3"});
  EXPECT_EQ(run(with_nugget).status, 0);
}

TEST_F(InpaintTest, RefusesMasksThatDoNotFit) {
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

TEST_F(InpaintTest, RefusesPicturesThatTellNoModel) {
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

TEST_F(InpaintTest, RefusesOptionsOutOfRange) {
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

TEST_F(InpaintTest, AnOutputThatCannotBeWrittenLeavesEarlierFiles) {
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

TEST_F(InpaintTest, HelpEndsWithExamples) {
  const Outcome outcome = run({"--help"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("not zero in any channel means missing"), HasSubstr("--nugget"),
                                 HasSubstr("textonbench inpaint photo.png --mask"), Not(HasSubstr("--model"))));
}

}  // namespace textonbench::inpaint_test
