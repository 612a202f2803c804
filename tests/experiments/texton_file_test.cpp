#include "experiments/texton_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "methods/base/random.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench::texton_file_test {

using testing::HasSubstr;

class TextonFileTest : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "a.texton"; }

  std::string message_for(const std::string& text) const {
    std::ofstream(file()) << text;
    try {
      read_texton_file(file());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

/// Order 1, 4 x 3 with a frame: two coefficients inside.
const std::string small =
    "TEXTON\n1\n1\n0.25 0.5 0.75\n4 3\n"
    "0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
    "0 0 0\n1 -2 3\n4e-1 5 6\n0 0 0\n"
    "0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
    "grass.png 128x128\n";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = small;
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(TextonFileTest, ReadsTheFormatOfTheAuthors) {
  std::ofstream(file()) << small;
  const TextonFile texton = read_texton_file(file());
  EXPECT_EQ(texton.order, 1);
  EXPECT_EQ(texton.mean[2], 0.75);
  EXPECT_EQ(texton.coefficients.extent(), (Extent{4, 3}));
  EXPECT_EQ(texton.coefficients.at(1, 1, 1), -2);
  EXPECT_EQ(texton.coefficients.at(0, 2, 1), 0.4F);
  EXPECT_EQ(texton.source, "grass.png 128x128");
}

TEST_F(TextonFileTest, TheBottomRowComesFirst) {
  std::ofstream(file()) << "TEXTON\n1\n0\n0 0 0\n1 2\n1 1 1\n2 2 2\nsource\n";
  const TextonFile texton = read_texton_file(file());
  EXPECT_EQ(texton.coefficients.at(0, 0, 0), 2);
  EXPECT_EQ(texton.coefficients.at(0, 0, 1), 1);
}

TEST_F(TextonFileTest, WhatIsWrittenIsReadBackBitForBit) {
  TextonFile texton{.order = 0, .mean = {0.1, 0.2, 0.3}, .coefficients = Image({5, 4}, 3), .source = "made up 5x4"};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 4; ++y)
      fill_normal(Stream(Seed{2}).child(c), static_cast<std::uint64_t>(y), 0, texton.coefficients.row(c, y));
  }
  write_texton_file(texton, file());
  const TextonFile read = read_texton_file(file());
  EXPECT_EQ(read.order, 0);
  EXPECT_EQ(read.source, texton.source);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(read.mean.at(c), texton.mean.at(c), 1e-9);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 5; ++x) EXPECT_EQ(read.coefficients.at(c, x, y), texton.coefficients.at(c, x, y));
    }
  }
  texton.coefficients.at(1, 2, 3) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(write_texton_file(texton, file()), std::invalid_argument);
  texton.coefficients.at(1, 2, 3) = 0;
  texton.order = 1;
  EXPECT_THROW(write_texton_file(texton, file()), std::invalid_argument) << "no frame of zeros";
  EXPECT_EQ(read_texton_file(file()).order, 0) << "what was there before is kept";
}

TEST_F(TextonFileTest, TellsWhatIsWrongAndWhere) {
  EXPECT_EQ(message_for(small), "accepted");
  EXPECT_THAT(message_for(""), HasSubstr("a.texton:1: the file ends here, expected TEXTON"));
  EXPECT_THAT(message_for("\x89PNG"), HasSubstr("a.texton:1:"));
  EXPECT_THAT(message_for(changed("TEXTON\n1", "TEXTON\n2")),
              HasSubstr("a.texton:2: version 2 of the format: expected 1"));
  EXPECT_THAT(message_for(changed("1\n1\n0", "1\n9\n0")), HasSubstr("a.texton:3: order 9: expected 0 to 5"));
  EXPECT_THAT(message_for(changed("0.5 ", "nan ")), HasSubstr("a.texton:4:"));
  EXPECT_THAT(message_for(changed("4 3", "0 3")), HasSubstr("a.texton:5: 0 x 3: expected sides from 1"));
  EXPECT_THAT(message_for(changed("4 3", "99999 99999")), HasSubstr("a.texton:5:"));
  EXPECT_THAT(message_for(changed("1 -2 3", "1 inf 3")), HasSubstr("a.texton:11: \"1 inf 3\": expected three finite"));
  EXPECT_THAT(message_for(changed("1 -2 3", "1 -2")), HasSubstr("a.texton:11: \"1 -2\": expected three finite"));
  EXPECT_THAT(message_for(changed("1 -2 3", "1 -2 3x")), HasSubstr("a.texton:11:"));
  const std::string cut = small.substr(0, small.find("1 -2 3"));
  EXPECT_THAT(message_for(cut), HasSubstr("a.texton:5: 4 x 3 coefficients announced and 30 bytes left"));
  EXPECT_THAT(message_for(cut.substr(0, cut.size() - 1) + std::string(80, ' ') + "\n"),
              HasSubstr("a.texton:11: the file ends here, expected three finite coefficients"));
  EXPECT_THAT(message_for(small + "more\n"), HasSubstr("goes on after the line"));
  EXPECT_THAT(message_for(changed("4 3\n0 0 0", "4 3\n0 1 0")), HasSubstr("the coefficient at (0, 2) is not zero"));
  EXPECT_THROW(read_texton_file(folder_.path() / "none.texton"), std::invalid_argument);
}

TEST_F(TextonFileTest, ReadsAPublishedTexton) {
  const char* data = std::getenv("TEXTONBENCH_DATA");
  const char* reference = std::getenv("TEXTONBENCH_REFERENCE");
  if (data == nullptr || reference == nullptr) {
    GTEST_SKIP() << "set TEXTONBENCH_DATA and TEXTONBENCH_REFERENCE to folders with 0000_2_s32.texton and its array";
  }
  const TextonFile texton = read_texton_file(std::filesystem::path(data) / "textons" / "0000_2_s32.texton");
  const std::vector<double> array = read_npy(std::filesystem::path(reference) / "tv_published_0000_2_s32_texton.npy");
  ASSERT_EQ(texton.coefficients.extent(), (Extent{32, 32}));
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        EXPECT_FLOAT_EQ(texton.coefficients.at(c, x, y),
                        static_cast<float>(array[static_cast<std::size_t>((y * 32 + x) * 3 + c)]));
      }
    }
  }
}

}  // namespace textonbench::texton_file_test
