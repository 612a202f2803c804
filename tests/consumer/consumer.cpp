// Fits ADSN to a small image and prints the mean of a larger sample.
#include <cstdio>

#include "methods/base/spectrum.h"
#include "methods/method.h"

int main() {
  using namespace textonbench;
  Exemplar exemplar{.name = "noise", .pixels = Image({16, 16}, 1), .sha256 = ""};
  for (int y = 0; y < 16; ++y)
    fill_normal(Stream(Seed{1}), static_cast<std::uint64_t>(y), 0, exemplar.pixels.row(0, y));
  const MethodEntry& adsn = find_method("adsn");
  const auto model = adsn.analyze({exemplar}, Params(adsn.params, {}), Seed{1});
  const Image sample = model->synthesize({.size = {256, 256}}, Seed{2});
  std::printf("exemplar %.3f sample %.3f\n", channel_means(exemplar.pixels)[0], channel_means(sample)[0]);
}
