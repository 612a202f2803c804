#include "methods/base/params.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace textonbench::params_test {

using testing::HasSubstr;
using Given = std::map<std::string, ParamValue>;

const std::vector<ParamSpec>& specs() {
  static const std::vector<ParamSpec> all = {
      {"impacts", std::string("poisson"), "", "how impacts are placed", 0, 0, {"poisson", "stratified"}},
      {"mni", 30.0, "1/pixel", "mean number of impacts", 0.5, 1e6},
      {"support", std::int64_t{31}, "pixel", "side of the support", 1},
      {"nugget", 0.0, "", "added to the diagonal", -std::numeric_limits<double>::infinity(), 1},
      {"turbulence", false, "", "sum of octaves"},
      {"label", std::string("none"), "", "free text"},
      {"offset", 0.25, "pixel", "any number"},
  };
  return all;
}

/// Message of the ParamError that `call` throws, which names the option `name`.
template <class Call>
std::string error_of(const std::string& name, const Call& call) {
  try {
    call();
  } catch (const ParamError& error) {
    EXPECT_EQ(error.name(), name);
    return error.what();
  }
  ADD_FAILURE() << "no ParamError for " << name;
  return {};
}

std::string given_error(const std::string& name, const ParamValue& value) {
  return error_of(name, [&] { Params(specs(), {{name, value}}); });
}

std::string parse_error(const std::string& name, std::string_view assignment) {
  return error_of(name, [&] { parse_param(specs(), assignment); });
}

TEST(Params, DefaultsAreComplete) {
  const Params params(specs(), {});
  EXPECT_EQ(params.values().size(), specs().size());
  EXPECT_EQ(params.text("impacts"), "poisson");
  EXPECT_EQ(params.number("mni"), 30.0);
  EXPECT_EQ(params.integer("support"), 31);
  EXPECT_FALSE(params.boolean("turbulence"));
}

TEST(Params, GivenValuesReplaceDefaults) {
  const Params params(
      specs(), Given{{"impacts", std::string("stratified")}, {"support", std::int64_t{1}}, {"turbulence", true}});
  EXPECT_EQ(params.text("impacts"), "stratified");
  EXPECT_EQ(params.integer("support"), 1);
  EXPECT_TRUE(params.boolean("turbulence"));
  EXPECT_EQ(params.number("mni"), 30.0);
}

TEST(Params, WholeNumbersStandForRealsOnly) {
  const Params params(specs(), Given{{"mni", std::int64_t{4}}});
  EXPECT_EQ(params.number("mni"), 4.0);
  EXPECT_TRUE(std::holds_alternative<double>(params.values().at("mni")));
  EXPECT_EQ(given_error("support", 3.0), "parameter support = 3: expected a whole number, at least 1");
}

TEST(Params, WrongKindsAreRefused) {
  EXPECT_EQ(given_error("mni", std::string("many")), "parameter mni = \"many\": expected a number in [0.5, 1000000]");
  EXPECT_EQ(given_error("mni", true), "parameter mni = true: expected a number in [0.5, 1000000]");
  EXPECT_EQ(given_error("turbulence", std::int64_t{1}), "parameter turbulence = 1: expected true or false");
  EXPECT_EQ(given_error("label", 0.5), "parameter label = 0.5: expected a text");
  EXPECT_EQ(given_error("impacts", false), "parameter impacts = false: expected one of poisson, stratified");
}

TEST(Params, RangesAreClosed) {
  EXPECT_NO_THROW(Params(specs(), Given{{"mni", 0.5}}));
  EXPECT_NO_THROW(Params(specs(), Given{{"mni", 1e6}}));
  EXPECT_EQ(given_error("mni", 0.49), "parameter mni = 0.49: expected a number in [0.5, 1000000]");
  EXPECT_EQ(given_error("mni", 1.5e6), "parameter mni = 1500000: expected a number in [0.5, 1000000]");
  EXPECT_EQ(given_error("support", std::int64_t{0}), "parameter support = 0: expected a whole number, at least 1");
  EXPECT_EQ(given_error("nugget", 2.0), "parameter nugget = 2: expected a number, at most 1");
  EXPECT_NO_THROW(Params(specs(), Given{{"nugget", -1e300}}));
}

TEST(Params, OnlyFiniteNumbersAreNumbers) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const char* name : {"mni", "nugget", "offset"}) {
    EXPECT_THAT(given_error(name, std::numeric_limits<double>::quiet_NaN()), HasSubstr("nan: expected a number"));
    EXPECT_THAT(given_error(name, infinity), HasSubstr("= inf: expected a number"));
    EXPECT_THAT(given_error(name, -infinity), HasSubstr("= -inf: expected a number"));
  }
}

TEST(Params, ChoicesAreChecked) {
  EXPECT_EQ(given_error("impacts", std::string("poison")),
            "parameter impacts = \"poison\": expected one of poisson, stratified (did you mean \"poisson\"?)");
  EXPECT_EQ(given_error("impacts", std::string("hexagonal")),
            "parameter impacts = \"hexagonal\": expected one of poisson, stratified");
}

TEST(Params, UnknownNamesAreRefusedWithTheNearest) {
  EXPECT_EQ(given_error("suport", std::int64_t{3}),
            "unknown parameter \"suport\" (did you mean \"support\"?): known are impacts, mni, support, nugget, "
            "turbulence, label, offset");
  EXPECT_THAT(given_error("iterations", std::int64_t{3}),
              testing::StartsWith("unknown parameter \"iterations\": known"));
  EXPECT_EQ(error_of("mni", [] { Params({}, {{"mni", 3.0}}); }), "unknown parameter \"mni\": this method has none");
}

TEST(Params, AnAdapterThatAsksForAnUndescribedNameIsAFault) {
  const Params params(specs(), {});
  EXPECT_THAT([&] { params.number("mean"); }, testing::ThrowsMessage<std::logic_error>(HasSubstr("\"mean\"")));
}

TEST(ParseParam, ReadsTheKindOfTheOption) {
  const auto parse = [](std::string_view assignment) { return parse_param(specs(), assignment); };
  EXPECT_EQ(parse("mni=12"), std::pair(std::string("mni"), ParamValue(12.0)));
  EXPECT_EQ(parse("mni=1.5e2"), std::pair(std::string("mni"), ParamValue(150.0)));
  EXPECT_EQ(parse("offset=-0.5"), std::pair(std::string("offset"), ParamValue(-0.5)));
  EXPECT_EQ(parse("support=7"), std::pair(std::string("support"), ParamValue(std::int64_t{7})));
  EXPECT_EQ(parse("turbulence=true"), std::pair(std::string("turbulence"), ParamValue(true)));
  EXPECT_EQ(parse("impacts=stratified"), std::pair(std::string("impacts"), ParamValue(std::string("stratified"))));
  EXPECT_EQ(parse("label=a=b"), std::pair(std::string("label"), ParamValue(std::string("a=b"))));
  EXPECT_EQ(parse("label="), std::pair(std::string("label"), ParamValue(std::string())));
}

TEST(ParseParam, WhatItReadsIsWhatWasWritten) {
  for (const char* assignment : {"mni=0.7", "mni=12", "support=31", "turbulence=false", "impacts=poisson"}) {
    const auto [name, value] = parse_param(specs(), assignment);
    EXPECT_EQ(name + "=" + to_string(value), assignment);
  }
}

TEST(ParseParam, RefusesWhatItCannotReadWholly) {
  EXPECT_EQ(parse_error("mni", "mni"), "parameter \"mni\": expected name=value");
  EXPECT_EQ(parse_error("=3", "=3"), "parameter \"=3\": expected name=value");
  EXPECT_EQ(parse_error("", ""), "parameter \"\": expected name=value");
  EXPECT_EQ(parse_error("mni", "mni="), "parameter mni = \"\": expected a number in [0.5, 1000000]");
  EXPECT_EQ(parse_error("mni", "mni=3x"), "parameter mni = \"3x\": expected a number in [0.5, 1000000]");
  EXPECT_EQ(parse_error("mni", "mni= 3"), "parameter mni = \" 3\": expected a number in [0.5, 1000000]");
  EXPECT_EQ(parse_error("support", "support=3.5"), "parameter support = \"3.5\": expected a whole number, at least 1");
  EXPECT_EQ(parse_error("support", "support=99999999999999999999"),
            "parameter support = \"99999999999999999999\": expected a whole number, at least 1");
  EXPECT_EQ(parse_error("support", "support=-3"), "parameter support = -3: expected a whole number, at least 1");
  EXPECT_EQ(parse_error("turbulence", "turbulence=yes"), "parameter turbulence = \"yes\": expected true or false");
  EXPECT_THAT(parse_error("offset", "offset=nan"), HasSubstr("nan: expected a number"));
  EXPECT_THAT(parse_error("offset", "offset=inf"), HasSubstr("inf: expected a number"));
  EXPECT_THAT(parse_error("impacts", "impacts=stratifed"), HasSubstr("(did you mean \"stratified\"?)"));
  EXPECT_THAT(parse_error("nmi", "nmi=3"), HasSubstr("unknown parameter \"nmi\" (did you mean \"mni\"?)"));
}

TEST(NearestName, SuggestsOnlyWhatIsNear) {
  const std::vector<std::string_view> names = {"rpn", "adsn", "texton_noise", "luminance_texton"};
  EXPECT_EQ(nearest_name("adsn", names), "adsn");
  EXPECT_EQ(nearest_name("rnp", names), "rpn");
  EXPECT_EQ(nearest_name("asdn", names), "adsn");
  EXPECT_EQ(nearest_name("texton-noise", names), "texton_noise");
  EXPECT_EQ(nearest_name("luminance_textons", names), "luminance_texton");
  EXPECT_EQ(nearest_name("gabor", names), "");
  EXPECT_EQ(nearest_name("xy", std::vector<std::string_view>{"ab", "a"}), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("rpn", {}), "");
  EXPECT_EQ(did_you_mean("rpm", names), " (did you mean \"rpn\"?)");
  EXPECT_EQ(did_you_mean("kriging", names), "");
}

}  // namespace textonbench::params_test
