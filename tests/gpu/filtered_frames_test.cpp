// How near filtered frames of the ground come to 20 x 20 supersampled ones, by the footprint of their pixels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "methods/base/ground_view.h"
#include "methods/method.h"
#include "tests/gpu/texton_shader.h"

namespace textonbench::filtered_frames_test {

constexpr Seed seed{3};
/// Upper ends of the bands of the footprint's longer side, pixels of the plane.
constexpr std::array<double, 6> bands{1, 2, 4, 8, 16, 64};
using Errors = std::array<double, bands.size()>;

class FilteredFrames : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context_ = make_context();
    } catch (const GpuError& error) {
      GTEST_SKIP() << error.what();
    }
  }

  Image draw(ShaderFilter filter, ShaderWindow window, int supersampling) {
    Frame frame = frame_;
    frame.supersampling = supersampling;
    const ShaderFetch fetch =
        filter == ShaderFilter::anisotropic && context_->info().software ? ShaderFetch::manual : ShaderFetch::hardware;
    const auto noise = make_spline_noise(texton_, {.impacts = ImpactProcess::stratified, .mni = 5});
    const ShaderRequest request{.seed = seed, .fetch = fetch, .filter = filter, .window = window};
    return Renderer(*context_, noise->shader(request).value(), ShaderPath::fragment).draw(frame);
  }

  /// Root of the mean square difference over the pixels of each band and all channels, in standard deviations.
  Errors errors(const Image& image, const Image& reference) const {
    const GroundView view(frame_.size, *frame_.ground);
    const std::vector<double> scale = deviations(texton_);
    Errors sums{};
    Errors counts{};
    for (int y = 0; y < frame_.size.height; ++y) {
      for (int x = 0; x < frame_.size.width; ++x) {
        if (!view.covers(x, y)) continue;
        const double longer = view.footprint(x, y).colwise().norm().maxCoeff();
        std::size_t band = 0;
        while (longer > bands[band]) ++band;
        for (int c = 0; c < image.channels(); ++c) {
          const double difference = (image.at(c, x, y) - reference.at(c, x, y)) / scale[static_cast<std::size_t>(c)];
          sums[band] += difference * difference;
          counts[band] += 1;
        }
      }
    }
    for (std::size_t band = 0; band < bands.size(); ++band) {
      EXPECT_GT(counts[band], 300) << "few pixels in band " << band;
      sums[band] = std::sqrt(sums[band] / counts[band]);
    }
    return sums;
  }

  SplineTexton texton_ = shader_texton(1, 3, 1);
  Frame frame_{.size = {160, 120}, .origin = {0, 0}, .ground = GroundViewOptions{.height = 40, .pitch = 0.35}};
  std::unique_ptr<Context> context_;
};

/// Measured by Mesa 22.3, footprints up to 1, 2, 4, 8, 16 and 64 pixels, in standard deviations of the noise:
///
///   unfiltered                              0.093  0.229  0.472  0.649  0.791  0.918
///   trilinear                               0.093  0.209  0.341  0.326  0.287  0.300
///   anisotropic                             0.063  0.109  0.144  0.119  0.097  0.084
///   anisotropic, window of the kernel only  0.064  0.112  0.159  0.187  0.273  0.286
///
/// The bounds leave room for texture units, whose filters differ.
TEST_F(FilteredFrames, ComeNearerToSupersampledOnesThanUnfilteredOnesDo) {
  const Image reference = draw(ShaderFilter::none, ShaderWindow::footprint, 20);
  const Errors none = errors(draw(ShaderFilter::none, ShaderWindow::footprint, 1), reference);
  const Errors trilinear = errors(draw(ShaderFilter::trilinear, ShaderWindow::footprint, 1), reference);
  const Errors anisotropic = errors(draw(ShaderFilter::anisotropic, ShaderWindow::footprint, 1), reference);
  const Errors cut = errors(draw(ShaderFilter::anisotropic, ShaderWindow::kernel, 1), reference);
  constexpr Errors trilinear_gain{0.95, 1, 1.2, 1.6, 2, 2.5};
  constexpr Errors anisotropic_gain{1.2, 1.6, 2.5, 4, 6, 8};
  constexpr Errors window_gain{1, 1, 1.05, 1.3, 2, 2.5};
  for (std::size_t band = 0; band < bands.size(); ++band) {
    SCOPED_TRACE("footprints up to " + std::to_string(bands[band]) + " pixels");
    EXPECT_GT(none[band], trilinear_gain[band] * trilinear[band]);
    EXPECT_GT(none[band], anisotropic_gain[band] * anisotropic[band]);
    EXPECT_GT(cut[band], window_gain[band] * anisotropic[band]);
  }
}

}  // namespace textonbench::filtered_frames_test
