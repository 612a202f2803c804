#include "paper_figures/number_format.h"

#include <gtest/gtest.h>

#include <cmath>

namespace textonbench::number_format_test {

TEST(NumberFormat, KeepsFourDigitsOfANumberWithoutError) {
  EXPECT_EQ(format_number(0), "0");
  EXPECT_EQ(format_number(0.52048), "0.5205");
  EXPECT_EQ(format_number(-12.3456), "-12.35");
  EXPECT_EQ(format_number(786432), "786432");
  EXPECT_EQ(format_number(NAN), "–");
}

TEST(NumberFormat, WritesPowersOfTenOutsideTheReadableRange) {
  EXPECT_EQ(format_number(1572864), "1.573·10⁶");
  EXPECT_EQ(format_number(2.5e-7), "2.500·10⁻⁷");
  EXPECT_EQ(format_plain(2.5e-7, 3.1e-8), "2.50·10⁻⁷ ± 0.31·10⁻⁷");
}

TEST(NumberFormat, GivesTheErrorTwoDigitsAndTheValueAsManyDecimals) {
  EXPECT_EQ(format_plain(0.432149, 0.00234), "0.4321 ± 0.0023");
  EXPECT_EQ(format_plain(12.3456, 1.5), "12.3 ± 1.5");
  EXPECT_EQ(format_plain(1234.5, 56), "1234 ± 56");
  EXPECT_EQ(format_plain(-0.0001, 0.02), "0.000 ± 0.020") << "no sign on a zero";
  EXPECT_EQ(format_plain(0.5, 0.0), "0.5000") << "a zero error is no error";
}

TEST(NumberFormat, ShowsAtMostSixDigitsOfAValueWithATinyError) {
  EXPECT_EQ(format_plain(0.1305193615, 9.8e-9), "0.130519 ± 9.8·10⁻⁹");
  EXPECT_EQ(format_plain(1234.5678, 1e-5), "1234.57 ± 1.0·10⁻⁵");
}

TEST(NumberFormat, WritesExactNumbersThatReadBack) {
  EXPECT_EQ(std::stod(format_exact(0.1 + 0.2)), 0.1 + 0.2);
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
  EXPECT_EQ(format_bytes(700), "700 B");
  EXPECT_EQ(format_size(640, 480), "640 × 480");
}

}  // namespace textonbench::number_format_test
