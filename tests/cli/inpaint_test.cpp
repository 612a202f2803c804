// textonbench inpaint: what it draws and writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "experiments/execute.h"
#include "methods/conditional/inpainting.h"
#include "tests/cli/inpaint_picture.h"

namespace textonbench::inpaint_test {

using testing::AllOf;
using testing::HasSubstr;

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
        if (in_hole(x, y)) continue;
        ASSERT_EQ(u.at(c, x, y), v.at(c, x, y));
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

}  // namespace textonbench::inpaint_test
