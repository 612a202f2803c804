// A small picture with a hole, and the command on it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "methods/base/image_io.h"
#include "methods/base/mask.h"
#include "tests/cli/program.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench::inpaint_test {

using Json = nlohmann::ordered_json;
using Arguments = std::vector<std::string>;

inline constexpr Extent size{48, 40};
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

inline bool in_hole(int x, int y) { return x >= 17 && x < 27 && y >= 12 && y < 20; }
inline constexpr const char* hole = "17,12,10,8";

inline Mask hole_mask() {
  Mask mask(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mask.set(x, y, in_hole(x, y));
  }
  return mask;
}

inline Image mask_picture(const Mask& mask) {
  Image picture(mask.extent(), 1);
  for (const Pixel& p : pixels_of(mask)) picture.at(0, p.x, p.y) = 1;
  return picture;
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
    EXPECT_THAT(outcome.err, testing::AllOf(testing::HasSubstr("error: "), message));
  }

  TemporaryFolder folder_;
  Image picture_;
};

}  // namespace textonbench::inpaint_test
