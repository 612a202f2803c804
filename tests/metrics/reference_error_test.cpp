#include "experiments/metrics/reference_error.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/texture.h"

namespace textonbench::reference_error_test {

constexpr float background = 1;

/// `value` on the upper half of its picture and a background below, beside a reference of another value.
class Constant final : public Model {
 public:
  Constant(const SplineTexton* texton, float value, std::optional<float> reference)
      : texton_(texton), value_(value), reference_(reference) {}
  Image synthesize(const Domain& domain, Seed) const override {
    Image picture(domain.size, texton_->coefficients.channels());
    for (int c = 0; c < picture.channels(); ++c) {
      for (int y = 0; y < picture.height(); ++y) {
        std::ranges::fill(picture.row(c, y), 2 * y < picture.height() ? value_ : background);
      }
    }
    return picture;
  }
  const SplineTexton* spline_texton() const override { return texton_; }
  std::unique_ptr<Model> reference() const override {
    return reference_ ? std::make_unique<Constant>(texton_, *reference_, std::nullopt) : nullptr;
  }
  Footprint footprint(const Domain&) const override { return {}; }

 private:
  const SplineTexton* texton_;
  float value_;
  std::optional<float> reference_;
};

/// ∫ (a β^1)² = a² (2/3)² in the plane.
TEST(ReferenceError, IsInStandardDeviationsOfTheNoiseAndLeavesABackgroundOut) {
  const Exemplar exemplar = test_exemplar({12, 12}, 3);
  const Target target = make_target(exemplar);
  SplineTexton texton;
  texton.support_area = 4;
  Image& coefficient = texton.coefficients.kernels.emplace_back(Extent{1, 1}, 3);
  for (int c = 0; c < 3; ++c) coefficient.at(c, 0, 0) = 0.5F;
  texton.coefficients.mean.assign(3, 0.0);
  const Domain domain{.size = {8, 10}};
  const double deviation = 0.5 * 2 / 3;
  EXPECT_NEAR(*reference_error(Constant(&texton, 0.75F, 0.5F), target, domain), 0.25 / deviation, 1e-6);
  EXPECT_EQ(*reference_error(Constant(&texton, 0.75F, 0.75F), target, domain), 0);
  EXPECT_FALSE(reference_error(Constant(&texton, 0.75F, std::nullopt), target, domain));
}

}  // namespace textonbench::reference_error_test
