#include "methods/sparse/gabor_pursuit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/base/convolution.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

/// λ falls by this factor, and a λ is done when the coefficients change by less than this part of them.
constexpr double next_penalty = 0.7;
constexpr double settled_change = 1e-3;
constexpr double least_penalty = 1e-5;
/// Powers below this part of the greatest smoothed one are weighted as if they were that.
constexpr float least_power = 1e-5F;
constexpr int updates = 8;

void require_power(const Image& power) {
  const auto wrap = [](int i, int n) { return i == 0 ? 0 : n - i; };
  double sum = 0, odd = 0;
  for (int y = 0; y < power.height(); ++y) {
    for (int x = 0; x < power.width(); ++x) {
      const float v = power.at(0, x, y);
      if (!(std::isfinite(v) && v >= 0)) {
        throw std::invalid_argument(
            fmt::format("power {} at bin ({}, {}): expected a finite number of at least 0", v, x, y));
      }
      sum += v;
      odd += std::abs(v - power.at(0, wrap(x, power.width()), wrap(y, power.height())));
    }
  }
  if (!(sum > 0)) throw std::invalid_argument("a power that is zero everywhere has no kernels");
  if (odd > 1e-4 * sum) {
    throw std::invalid_argument(
        fmt::format("a power whose odd part is {:.3g} of it: expected p(k) = p(-k), as of real pictures", odd / sum));
  }
}

/// Calls visit(a, b, …) with the rows of images of the same shape.
template <class Visit, class... Images>
void for_rows(const Visit& visit, Image& first, Images&... others) {
  parallel_for(first.channels() * first.height(), [&](int i) {
    visit(first.row(i / first.height(), i % first.height()), others.row(i / first.height(), i % first.height())...);
  });
}

/// Σ a b, of rows in order.
double inner_product(const Image& a, const Image& b) {
  double sum = 0;
  for (int c = 0; c < a.channels(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      const auto one = a.row(c, y), other = b.row(c, y);
      float row = 0;
      for (std::size_t x = 0; x < one.size(); ++x) row += one[x] * other[x];
      sum += double{row};
    }
  }
  return sum;
}

/// The problem with coefficients and residuals scaled: c_b(F) = s(F) x_b(F), and residuals times m(ξ).
class ScaledProblem {
 public:
  ScaledProblem(const GaborDictionary& dictionary, const Image& power, const PursuitOptions& options)
      : dictionary_(dictionary), power_(power), weight_(power.extent(), 1), scale_(power.extent(), dictionary.bands()) {
    const Image smooth = dictionary.correlate(power);
    const int middle = dictionary.bands() / 2;
    float most = 0;
    for (int y = 0; y < power.height(); ++y) most = std::max(most, *std::ranges::max_element(smooth.row(middle, y)));
    for (int y = 0; y < power.height(); ++y) {
      for (int x = 0; x < power.width(); ++x) {
        const float level = options.residual == PursuitResidual::power
                                ? 1
                                : std::sqrt(std::max(smooth.at(middle, x, y), least_power * most) / most);
        weight_.at(0, x, y) = 1 / level;
        for (int b = 0; b < bands(); ++b) scale_.at(b, x, y) = dictionary.is_center(b, x, y) ? level : 0;
        // E (p − q)² = scatter q², and E p² = (1 + scatter) q².
        noise_ += std::pow(double{power.at(0, x, y)} / level, 2);
      }
    }
    noise_ -= std::pow(double{power.at(0, 0, 0)} * weight_.at(0, 0, 0), 2);
    noise_ *= options.scatter / (1 + options.scatter);
    weight_.at(0, 0, 0) = 0;
    for (int b = 0; b < dictionary.bands(); ++b) norm_.push_back(static_cast<float>(dictionary.norm(b)));
    smoothness_ = 1.02 * greatest_eigenvalue();
  }

  /// Lipschitz constant of the gradient.
  double smoothness() const { return smoothness_; }
  double noise() const { return noise_; }
  int bands() const { return dictionary_.bands(); }
  Image zero() const { return {power_.extent(), bands()}; }

  /// q = Σ c G of coefficients x.
  Image model(const Image& x) const { return dictionary_.sum(coefficients(x)); }
  Image coefficients(const Image& x) const {
    Image c = x;
    for (int b = 0; b < bands(); ++b) multiply(scale_, b, c, b);
    return c;
  }
  /// m (q − p) in place of q; the sum of its squares.
  double residual(Image& q) const {
    for (int y = 0; y < q.height(); ++y) {
      const auto row = q.row(0, y);
      const auto p = power_.row(0, y), m = weight_.row(0, y);
      for (std::size_t x = 0; x < row.size(); ++x) row[x] = m[x] * (row[x] - p[x]);
    }
    return inner_product(q, q);
  }
  /// Gradient of half that sum, of m (q − p), which is changed.
  Image gradient(Image& r) const {
    multiply(weight_, 0, r, 0);
    Image g = dictionary_.correlate(r);
    for (int b = 0; b < bands(); ++b) multiply(scale_, b, g, b);
    return g;
  }
  float norm(int band) const { return norm_[static_cast<std::size_t>(band)]; }
  const Image& scale() const { return scale_; }

  /// Relative model error of a power q, its negative rounding aside.
  double relative_error(const Image& q) const {
    double distance = 0, sum = 0;
    for (int y = 0; y < q.height(); ++y) {
      for (int x = y == 0 ? 1 : 0; x < q.width(); ++x) {
        const double p = power_.at(0, x, y);
        distance += std::pow(std::sqrt(std::max(0.0, double{q.at(0, x, y)})) - std::sqrt(p), 2);
        sum += p;
      }
    }
    return std::sqrt(distance / sum);
  }

 private:
  static void multiply(const Image& by, int from, Image& u, int channel) {
    for (int y = 0; y < u.height(); ++y) {
      const auto row = u.row(channel, y);
      const auto factor = by.row(from, y);
      for (std::size_t x = 0; x < row.size(); ++x) row[x] *= factor[x];
    }
  }

  /// Of the scaled dictionary's square, by the power method from a constant.
  double greatest_eigenvalue() const {
    Image x = zero();
    for (int b = 0; b < bands(); ++b) {
      for (int y = 0; y < x.height(); ++y) std::ranges::fill(x.row(b, y), 1.0F);
    }
    double value = 0;
    for (int i = 0; i < 30; ++i) {
      const auto length = static_cast<float>(std::sqrt(inner_product(x, x)));
      for_rows(
          [&](const std::span<float>& row) {
            for (float& v : row) v /= length;
          },
          x);
      Image q = model(x);
      multiply(weight_, 0, q, 0);
      x = gradient(q);
      value = std::sqrt(inner_product(x, x));
    }
    return value;
  }

  const GaborDictionary& dictionary_;
  const Image& power_;
  Image weight_, scale_;  // m, s
  std::vector<float> norm_;
  double noise_ = 0, smoothness_ = 0;
};

/// λ above which all coefficients are zero.
double greatest_penalty(const ScaledProblem& problem) {
  Image q(problem.scale().extent(), 1);
  problem.residual(q);
  const Image g = problem.gradient(q);
  double most = 0;
  for (int b = 0; b < g.channels(); ++b) {
    for (int y = 0; y < g.height(); ++y) {
      for (int x = 0; x < g.width(); ++x) {
        const float scale = problem.scale().at(b, x, y);
        if (scale > 0) most = std::max(most, -double{g.at(b, x, y)} / (problem.norm(b) * scale));
      }
    }
  }
  return most;
}

/// FISTA for one λ from where it stands.
class Fista {
 public:
  explicit Fista(const ScaledProblem& problem) : problem_(problem), x_(problem.zero()), y_(x_) {}

  const Image& solution() const { return x_; }
  double residual() const { return residual_; }
  double change() const { return change_; }
  double rme() const { return rme_; }
  void restart() {
    y_ = x_;
    inertia_ = 1;
  }

  void step(double penalty) {
    Image r = problem_.model(y_);
    rme_ = problem_.relative_error(r);
    residual_ = problem_.residual(r);
    const Image g = problem_.gradient(r);
    const double next = (1 + std::sqrt(1 + 4 * inertia_ * inertia_)) / 2;
    const auto momentum = static_cast<float>((inertia_ - 1) / next);
    const auto rate = static_cast<float>(1 / problem_.smoothness());
    const int height = x_.height();
    std::vector<double> against(static_cast<std::size_t>(x_.channels() * height)), moved(against), length(against);
    parallel_for(x_.channels() * height, [&](int i) {
      const int b = i / height, j = i % height;
      const auto x = x_.row(b, j), y = y_.row(b, j);
      const auto slope = g.row(b, j), scale = problem_.scale().row(b, j);
      const float cost = static_cast<float>(penalty) * problem_.norm(b);
      float away = 0, change = 0, square = 0;
      for (std::size_t k = 0; k < x.size(); ++k) {
        const float fresh = std::max(0.0F, y[k] - rate * (slope[k] + cost * scale[k]));
        const float move = fresh - x[k];
        away += (y[k] - fresh) * move;
        change += move * move;
        square += fresh * fresh;
        y[k] = fresh + momentum * move;
        x[k] = fresh;
      }
      const auto at = static_cast<std::size_t>(i);
      against[at] = away, moved[at] = change, length[at] = square;
    });
    const auto total = [](const std::vector<double>& all) {
      double sum = 0;
      for (const double v : all) sum += v;
      return sum;
    };
    change_ = std::sqrt(total(moved) / std::max(1e-300, total(length)));
    inertia_ = next;
    if (total(against) > 0) restart();
  }

 private:
  const ScaledProblem& problem_;
  Image x_, y_;
  double inertia_ = 1, residual_ = 0, change_ = 1, rme_ = 1;
};

/// c_b(F) Σ_ξ G_b(ξ − F) p(ξ) / q(ξ).
void update(const GaborDictionary& dictionary, const Image& power, Image& coefficients) {
  const Image ratio = power_ratio(power, dictionary.sum(coefficients));
  const Image factor = dictionary.correlate(ratio);
  for (int b = 0; b < factor.channels(); ++b) {
    for (int y = 0; y < factor.height(); ++y) {
      const auto row = coefficients.row(b, y);
      const auto by = factor.row(b, y);
      for (std::size_t x = 0; x < row.size(); ++x) row[x] *= std::max(0.0F, by[x]);
    }
  }
}

}  // namespace

Image power_ratio(const Image& power, const Image& model) {
  float most = 0;
  for (int y = 0; y < model.height(); ++y) most = std::max(most, *std::ranges::max_element(model.row(0, y)));
  Image ratio(power.extent(), 1);
  for (int y = 0; y < power.height(); ++y) {
    for (int x = 0; x < power.width(); ++x) {
      ratio.at(0, x, y) = power.at(0, x, y) / std::max(model.at(0, x, y), 1e-6F * most);
    }
  }
  return ratio;
}

Image penalized_coefficients(const GaborDictionary& dictionary, const Image& power, const PursuitOptions& options,
                             double penalty, double tolerance) {
  require_power(power);
  const ScaledProblem problem(dictionary, power, options);
  const double lambda = penalty * greatest_penalty(problem);
  Fista fista(problem);
  for (int i = 0; i < options.iterations && fista.change() > tolerance; ++i) fista.step(lambda);
  return problem.coefficients(fista.solution());
}

Pursuit pursue(const GaborDictionary& dictionary, const Image& power, const PursuitOptions& options) {
  require_power(power);
  const ScaledProblem problem(dictionary, power, options);
  const double most = greatest_penalty(problem);
  Fista fista(problem);
  Pursuit found;
  found.reason = "iterations";
  int done = 0;
  for (double penalty = next_penalty * most; done < options.iterations; penalty *= next_penalty) {
    if (penalty < least_penalty * most) {
      found.reason = "no descent";
      break;
    }
    fista.restart();
    do {
      fista.step(penalty);
      found.rme.push_back(fista.rme());
      ++done;
    } while (fista.change() > settled_change && done < options.iterations);
    if (fista.change() <= settled_change && fista.residual() <= options.noise * problem.noise()) {
      found.reason = "tolerance";
      break;
    }
  }
  found.residual = fista.residual() / problem.noise();
  found.coefficients = problem.coefficients(fista.solution());
  for (int i = 0; i < updates; ++i) update(dictionary, power, found.coefficients);
  found.rme.push_back(problem.relative_error(dictionary.sum(found.coefficients)));
  return found;
}

}  // namespace textonbench
