#include "methods/base/exemplar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace textonbench::exemplar_test {

using testing::AllOf;
using testing::HasSubstr;

Exemplar varied(Extent extent, int channels) {
  Exemplar exemplar{"bark", Image(extent, channels), std::string(64, '0')};
  exemplar.pixels.at(channels - 1, extent.width - 1, extent.height - 1) = 1.0F;
  return exemplar;
}

void expect_refused(const Exemplar& exemplar, const std::string& reason) {
  EXPECT_THAT([&] { require_usable(exemplar); },
              testing::ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("\"bark\""), HasSubstr(reason))));
}

TEST(RequireUsable, AcceptsGrayColorAndStacksThatVaryAnywhere) {
  EXPECT_NO_THROW(require_usable(varied({2, 2}, 1)));
  EXPECT_NO_THROW(require_usable(varied({17, 3}, 3)));  // only the last sample of the last channel differs
  Exemplar stack = varied({9, 4}, 7);
  EXPECT_NO_THROW(require_usable(stack));
  stack.maps = {{"albedo", 3}, {"normal", 3}, {"height", 1}};
  EXPECT_NO_THROW(require_usable(stack));
}

TEST(RequireUsable, RefusesWhatNoModelCanBeFittedTo) {
  expect_refused(Exemplar{"bark", Image(), ""}, "has no pixels");
  expect_refused(varied({1, 1}, 3), "is 1x1 pixels: expected at least 2x2");
  expect_refused(varied({1, 40}, 3), "is 1x40 pixels: expected at least 2x2");
  expect_refused(varied({40, 1}, 1), "is 40x1 pixels: expected at least 2x2");
  Exemplar stack = varied({8, 8}, 5);
  stack.maps = {{"albedo", 3}, {"height", 1}};
  expect_refused(stack, "has 5 channels, and maps of 4: expected as many");
}

TEST(RequireUsable, TellsPlaceAndValueOfANonFiniteSample) {
  Exemplar exemplar = varied({8, 6}, 3);
  exemplar.pixels.at(2, 5, 4) = std::numeric_limits<float>::infinity();
  expect_refused(exemplar, "sample inf at x 5, y 4, channel 2 is not finite");
  exemplar.pixels.at(1, 7, 0) = std::numeric_limits<float>::quiet_NaN();
  expect_refused(exemplar, "sample nan at x 7, y 0, channel 1 is not finite");
}

TEST(RequireUsable, RefusesConstantColor) {
  Exemplar exemplar{"bark", Image({9, 9}, 3), ""};
  expect_refused(exemplar, "is constant: there is no texture to model");
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) {
      exemplar.pixels.at(1, x, y) = 0.5F;  // channels differ from each other, pixels do not
    }
  }
  expect_refused(exemplar, "is constant");
}

}  // namespace textonbench::exemplar_test
