#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "experiments/metrics/target_law.h"
#include "tests/metrics/metric_fixture.h"

namespace textonbench::autocovariance_test {

/// Γ_{cd}(v) of the spot by its definition: on Z², or on a torus where all pairs of pixels v apart modulo its size
/// count.
double naive_law(const Target& target, int c, int d, int vx, int vy, const Extent* torus) {
  const Image& p = target.periodic_component;
  double sum = 0;
  for (int y = 0; y < p.height(); ++y) {
    for (int x = 0; x < p.width(); ++x) {
      for (int y2 = 0; y2 < p.height(); ++y2) {
        for (int x2 = 0; x2 < p.width(); ++x2) {
          const int dx = x2 - x - vx, dy = y2 - y - vy;
          const bool apart = torus == nullptr ? dx == 0 && dy == 0 : dx % torus->width == 0 && dy % torus->height == 0;
          if (!apart) continue;
          sum += (p.at(c, x2, y2) - target.gaussian.mean[static_cast<std::size_t>(c)]) *
                 (p.at(d, x, y) - target.gaussian.mean[static_cast<std::size_t>(d)]);
        }
      }
    }
  }
  return sum / static_cast<double>(p.extent().area());
}

void expect_law(const Target& target, const Domain& domain, Extent reach, const Extent* torus) {
  const LagWindow window(target, domain, reach);
  for (int c = 0; c < window.channels(); ++c) {
    for (int d = 0; d < window.channels(); ++d) {
      for (int y = -reach.height; y <= reach.height; ++y) {
        for (int x = -reach.width; x <= reach.width; ++x) {
          EXPECT_NEAR(window.at(c, d, x, y), naive_law(target, c, d, x, y, torus), 1e-8)
              << c << d << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(TargetLaw, IsThatOfTheSpotOnEveryDomain) {
  const Exemplar exemplar = smooth_exemplar({10, 8}, 3, 0.8);
  const Target target = make_target(exemplar);
  const Extent own{10, 8}, larger{13, 25}, smaller{6, 5};
  expect_law(target, {.size = own, .periodic = true}, {4, 3}, &own);
  expect_law(target, {.size = larger, .periodic = true}, {4, 11}, &larger);
  expect_law(target, {.size = smaller, .periodic = true}, {2, 2}, &smaller);
  expect_law(target, {.size = own, .periodic = false}, {4, 3}, nullptr);
  expect_law(target, {.size = larger, .periodic = false}, {3, 11}, nullptr);
}

TEST(TargetLaw, RefusesAStepThatIsNotOnePixel) {
  const Exemplar exemplar = smooth_exemplar({32, 32}, 1);
  const Target target = make_target(exemplar);
  const Domain zoomed{.size = {32, 32}, .step = 0.5};
  for (const char* metric : {"autocovariance_error_8", "log_spectral_distance", "cramer_von_mises", "patch_distance"}) {
    EXPECT_THROW(find_metric(metric).of_samples(target, zoomed, Seed{1}), std::invalid_argument) << metric;
  }
}

/// The error by its definition, over all lags of both half planes.
double naive_error(const Target& target, const Image& sample, const Domain& domain, Extent reach) {
  double squares = 0, energy = 0;
  for (int c = 0; c < sample.channels(); ++c) {
    for (int d = 0; d < sample.channels(); ++d) {
      for (int vy = -reach.height; vy <= reach.height; ++vy) {
        for (int vx = -reach.width; vx <= reach.width; ++vx) {
          double sum = 0;
          int pairs = 0;
          for (int y = 0; y < sample.height(); ++y) {
            for (int x = 0; x < sample.width(); ++x) {
              int x2 = x + vx, y2 = y + vy;
              if (domain.periodic) {
                x2 = (x2 + sample.width()) % sample.width();
                y2 = (y2 + sample.height()) % sample.height();
              } else if (x2 < 0 || y2 < 0 || x2 >= sample.width() || y2 >= sample.height()) {
                continue;
              }
              sum += (sample.at(c, x2, y2) - target.gaussian.mean[static_cast<std::size_t>(c)]) *
                     (sample.at(d, x, y) - target.gaussian.mean[static_cast<std::size_t>(d)]);
              ++pairs;
            }
          }
          const double wanted = naive_law(target, c, d, vx, vy, domain.periodic ? &domain.size : nullptr);
          squares += std::pow(sum / pairs - wanted, 2);
          energy += wanted * wanted;
        }
      }
    }
  }
  return std::sqrt(squares / energy);
}

TEST(AutocovarianceError, IsItsDefinition) {
  const Exemplar exemplar = smooth_exemplar({12, 9}, 3, 0.8);
  const Target target = make_target(exemplar);
  for (const Domain domain : {Domain{.size = {12, 9}, .periodic = true}, Domain{.size = {15, 11}, .periodic = false},
                              Domain{.size = {16, 8}, .periodic = true}}) {
    const Image sample = smooth_exemplar(domain.size, 3, 1.0, 2).pixels;
    const int w = domain.size.width, h = domain.size.height;
    EXPECT_NEAR(measure("autocovariance_error_quarter", target, {sample}, domain).value,
                naive_error(target, sample, domain, {w / 4, h / 4}), 2e-5);
    // 8 is more than half of the height: the reach is cut.
    EXPECT_NEAR(measure("autocovariance_error_8", target, {sample}, domain).value,
                naive_error(target, sample, domain, {std::min(8, (w - 1) / 2), (h - 1) / 2}), 2e-5);
  }
}

TEST(AutocovarianceError, OfARandomPhaseImageIsZeroAndOfItsContrastExact) {
  const Exemplar exemplar = smooth_exemplar({96, 80}, 3);
  const Target target = make_target(exemplar);
  const Domain domain{.size = {96, 80}, .periodic = true};
  const std::vector<Image> exact = draw("rpn", {}, exemplar, domain, 1, 4);
  const std::vector<Image> scaled{mapped(exact.front(), [&](double value, int c) {
    const double m = target.gaussian.mean[static_cast<std::size_t>(c)];
    return m + 1.2 * (value - m);
  })};
  for (const char* name : {"autocovariance_error_8", "autocovariance_error_32", "autocovariance_error_quarter"}) {
    EXPECT_NEAR(measure(name, target, exact, domain).value, 0, 1e-5) << name;
    EXPECT_NEAR(measure(name, target, scaled, domain).value, 0.44, 1e-5) << name;
  }
}

}  // namespace textonbench::autocovariance_test
