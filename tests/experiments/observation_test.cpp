#include "experiments/observation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace textonbench::observation_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Observation, IsWhatTheOptionDescribes) {
  const MethodEntry& inpainting = find_method("inpainting");
  const auto observed = observation(inpainting, {{"mask", std::string("rect:2,3,4,5")}}, {20, 10});
  ASSERT_TRUE(observed);
  EXPECT_EQ(observed->missing.count(), 20);
  EXPECT_TRUE(observed->missing.at(2, 3) && observed->missing.at(5, 7) && !observed->missing.at(6, 7));
  const auto half = observation(inpainting, {{"mask", std::string("pixels")}, {"missing", 50.0}}, {20, 10});
  EXPECT_EQ(half->missing.count(), 100);
}

TEST(Observation, IsNothingForOtherMethods) {
  EXPECT_FALSE(observation(find_method("adsn"), {}, {20, 10}));
  EXPECT_FALSE(observation(find_method("sot"), {}, {20, 10})) << "whose mask is a support";
}

TEST(Observation, NamesTheOptionInErrors) {
  EXPECT_THAT(
      [] {
        observation(find_method("inpainting"), {{"mask", std::string("rect:18,3,4,5")}}, {20, 10});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("option mask: ")));
}

}  // namespace textonbench::observation_test
