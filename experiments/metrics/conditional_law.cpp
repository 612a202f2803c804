#include "experiments/metrics/conditional_law.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "methods/conditional/inpainting.h"

namespace textonbench {
namespace {

const Inpainting* as_inpainting(const Model& model) { return dynamic_cast<const Inpainting*>(&model); }

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

/// Γ_cd(v) on the plane by its sum.
double summed_covariance(const Planes& t, int c, int d, const Pixel& v) {
  double sum = 0;
  for (int y = std::max(0, -v.y); y < t.extent.height - std::max(0, v.y); ++y) {
    for (int x = std::max(0, -v.x); x < t.extent.width - std::max(0, v.x); ++x) {
      sum += t.row(c, y + v.y)[x + v.x] * t.row(d, y)[x];
    }
  }
  return sum;
}

/// Covariances of values at two lists of pixels, ordered channel by channel.
template <class Covariance>
Eigen::MatrixXd matrix_of(int channels, std::span<const Pixel> a, std::span<const Pixel> b,
                          const Covariance& covariance) {
  Eigen::MatrixXd matrix(std::ssize(a) * channels, std::ssize(b) * channels);
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d < channels; ++d) {
      for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
          matrix(c * std::ssize(a) + static_cast<Eigen::Index>(i), d * std::ssize(b) + static_cast<Eigen::Index>(j)) =
              covariance(c, d, Pixel{a[i].x - b[j].x, a[i].y - b[j].y});
        }
      }
    }
  }
  return matrix;
}

/// The standard normal number that a χ² of n degrees of freedom is nearly.
double wilson_hilferty(double chi_square, double n) {
  return (std::cbrt(chi_square / n) - (1 - 2 / (9 * n))) / std::sqrt(2 / (9 * n));
}

/// The problem of 16 x 16 pixels.
class SmallProblem {
 public:
  static constexpr int samples = 2000;
  static constexpr int border = 2;

  explicit SmallProblem(const Image& exemplar)
      : picture_(crop(exemplar, 0, 0, {std::min(16, exemplar.width()), std::min(16, exemplar.height())})),
        model_(picture_, hole(picture_.extent()), nullptr, {.border = border, .nugget = 1e-3}) {
    const KrigingOperator& op = model_.kriging_operator();
    const auto covariance = [&](int c, int d, const Pixel& v) {
      return summed_covariance(op.field().spot, c, d, v) + (c == d && v == Pixel{} ? op.field().nugget_variance : 0);
    };
    const auto c = op.conditioning_pixels();
    const auto m = op.missing_pixels();
    const Eigen::LLT<Eigen::MatrixXd> factor(matrix_of(op.channels(), c, c, covariance));
    const Eigen::MatrixXd mc = matrix_of(op.channels(), m, c, covariance);
    mean_ = mc * factor.solve(as_vector(model_.right_side()));
    for (Eigen::Index i = 0; i < mean_.size(); ++i)
      mean_[i] += op.field().mean[static_cast<std::size_t>(i / std::ssize(m))];
    covariance_.compute(matrix_of(op.channels(), m, m, covariance) - mc * factor.solve(mc.transpose()));
    if (factor.info() != Eigen::Success || covariance_.info() != Eigen::Success) {
      throw std::runtime_error("the covariance of the small problem is singular: expected an exemplar with texture");
    }
  }

  const Inpainting& model() const { return model_; }
  Eigen::Index size() const { return mean_.size(); }

  /// (L⁻¹)(v − conditional mean) of a sample v, L Lᵀ the conditional covariance.
  Eigen::VectorXd whitened(std::uint64_t seed) const {
    const Image sample = model_.sample(Seed{seed}).image;
    return covariance_.matrixL().solve(missing_values(sample) - mean_);
  }

  Eigen::VectorXd missing_values(const Image& image) const {
    const auto pixels = model_.kriging_operator().missing_pixels();
    Eigen::VectorXd values(size());
    Eigen::Index i = 0;
    for (int c = 0; c < image.channels(); ++c) {
      for (const Pixel& p : pixels) values[i++] = static_cast<double>(image.at(c, p.x, p.y));
    }
    return values;
  }

 private:
  static Mask hole(Extent size) {
    Mask mask(size);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 5; ++x) mask.set(size.width / 2 - 2 + x, size.height / 2 - 2 + y, true);
    }
    return mask;
  }

  Image picture_;
  Inpainting model_;
  Eigen::VectorXd mean_;
  Eigen::LLT<Eigen::MatrixXd> covariance_;
};

/// The kriging system of the model's field and picture with another border.
struct OtherBorder {
  OtherBorder(const Inpainting& law, int width)
      : op(law.kriging_operator().field(),
           difference(dilate(law.missing(), width, law.kriging_operator().field().periodic), law.missing()),
           law.missing()),
        system(op, {}) {}

  std::vector<double> kriging(const Image& u) const {
    std::vector<double> right_side;
    right_side.reserve(op.unknowns());
    for (int c = 0; c < op.channels(); ++c) {
      for (const Pixel& p : op.conditioning_pixels()) {
        right_side.push_back(static_cast<double>(u.at(c, p.x, p.y)) - op.field().mean[static_cast<std::size_t>(c)]);
      }
    }
    return op.extend(system.solve(right_side).k);
  }

  KrigingOperator op;
  KrigingSystem system;
};

constexpr int wide_border = 20;
/// Of what dense algebra can hold.
constexpr int dense_border = 10;

/// Mean conditional variance over some of the missing pixels.
std::optional<double> conditional_variance(const KrigingOperator& op) {
  constexpr std::size_t most_unknowns = 5000;
  constexpr std::size_t wanted = 50;
  if (op.unknowns() > most_unknowns) return std::nullopt;
  const CovarianceTable table = op.covariance().table(op.box().size);
  const auto covariance = [&](int c, int d, const Pixel& v) {
    return table.at(c, d, v.x, v.y) + (c == d && v == Pixel{} ? op.field().nugget_variance : 0);
  };
  std::vector<Pixel> some;
  const auto missing = op.missing_pixels();
  const std::size_t step = std::max<std::size_t>(1, missing.size() / wanted);
  for (std::size_t i = step / 2; i < missing.size(); i += step) some.push_back(missing[i]);
  const auto c = op.conditioning_pixels();
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix_of(op.channels(), c, c, covariance));
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd half = factor.matrixL().solve(matrix_of(op.channels(), c, some, covariance));
  double sum = 0;
  for (int channel = 0; channel < op.channels(); ++channel) sum += covariance(channel, channel, {});
  const auto values = static_cast<double>(some.size()) * op.channels();
  return sum / op.channels() - half.squaredNorm() / values;
}

/// Mean over pairs of a missing pixel x and a known pixel x + v of (v_c(x) − m_c)(u_c(x + v) − m_c), for every v.
std::vector<double> covariance_across(const Image& filled, const Mask& missing, const std::vector<double>& mean) {
  constexpr int far = 32, near = 8;
  std::vector<double> result;
  const Extent size = filled.extent();
  const std::vector<Pixel> pixels = pixels_of(missing);
  for (int vy = -far; vy <= far; ++vy) {
    for (int vx = -far; vx <= far; ++vx) {
      if (std::max(std::abs(vx), std::abs(vy)) < near) continue;
      double sum = 0;
      std::int64_t pairs = 0;
      for (const Pixel& p : pixels) {
        const Pixel q{p.x + vx, p.y + vy};
        if (q.x < 0 || q.y < 0 || q.x >= size.width || q.y >= size.height || missing.at(q.x, q.y)) continue;
        for (int c = 0; c < filled.channels(); ++c) {
          const double m = mean[static_cast<std::size_t>(c)];
          sum += (static_cast<double>(filled.at(c, p.x, p.y)) - m) * (static_cast<double>(filled.at(c, q.x, q.y)) - m);
        }
        ++pairs;
      }
      result.push_back(pairs > 0 ? sum / static_cast<double>(pairs) : 0);
    }
  }
  return result;
}

}  // namespace

std::optional<double> conditional_mean_deviation(const Model& model, const Target& target, const Domain&) {
  if (as_inpainting(model) == nullptr) return std::nullopt;
  const SmallProblem problem(target.exemplar.pixels);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(problem.size());
  for (int s = 0; s < SmallProblem::samples; ++s) {
    mean += problem.whitened(static_cast<std::uint64_t>(s)) / SmallProblem::samples;
  }
  return wilson_hilferty(SmallProblem::samples * mean.squaredNorm(), static_cast<double>(problem.size()));
}

std::optional<double> conditional_covariance_deviation(const Model& model, const Target& target, const Domain&) {
  if (as_inpainting(model) == nullptr) return std::nullopt;
  const SmallProblem problem(target.exemplar.pixels);
  double sum = 0;
  for (int s = 0; s < SmallProblem::samples; ++s) sum += problem.whitened(static_cast<std::uint64_t>(s)).squaredNorm();
  return wilson_hilferty(sum, static_cast<double>(problem.size()) * SmallProblem::samples);
}

std::optional<double> kriging_innovation_correlation(const Model& model, const Target& target, const Domain&) {
  if (as_inpainting(model) == nullptr) return std::nullopt;
  const SmallProblem problem(target.exemplar.pixels);
  const Eigen::Index n = problem.size();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd of_estimate = Eigen::VectorXd::Zero(n), of_innovation = Eigen::VectorXd::Zero(n);
  for (int s = 0; s < SmallProblem::samples; ++s) {
    const Seed seed{static_cast<std::uint64_t>(s)};
    const Eigen::VectorXd innovation = problem.missing_values(problem.model().innovation(seed));
    const Eigen::VectorXd estimate = as_vector(problem.model().kriging_operator().simulate(seed).missing) - innovation;
    products += estimate * innovation.transpose();
    of_estimate += estimate.cwiseAbs2();
    of_innovation += innovation.cwiseAbs2();
  }
  const Eigen::MatrixXd scale = (of_estimate * of_innovation.transpose()).cwiseSqrt();
  return std::sqrt(static_cast<double>(SmallProblem::samples)) * products.cwiseQuotient(scale).cwiseAbs().maxCoeff();
}

std::optional<double> kriging_border_distance(const Model& model, const Target& target, const Domain&) {
  const Inpainting* law = as_inpainting(model);
  if (law == nullptr) return std::nullopt;
  const KrigingOperator& op = law->kriging_operator();
  const Image& u = target.exemplar.pixels;
  const Eigen::VectorXd wide = as_vector(OtherBorder(*law, wide_border).kriging(u));
  const Eigen::VectorXd own = as_vector(op.extend(law->kriging_solution().k));
  return std::sqrt((own - wide).squaredNorm() / static_cast<double>(own.size()) / mean_variance(op.field()));
}

std::optional<double> kriging_variance_ratio(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = as_inpainting(model);
  if (law == nullptr) return std::nullopt;
  const KrigingOperator& op = law->kriging_operator();
  const KrigingOperator wide(op.field(),
                             difference(dilate(law->missing(), dense_border, op.field().periodic), law->missing()),
                             law->missing());
  const std::optional<double> own = conditional_variance(op);
  const std::optional<double> least = conditional_variance(wide);
  return own && least ? std::optional(*own / *least) : std::nullopt;
}

std::optional<double> hole_covariance_ratio(const Model& model, const Target& target, const Domain&) {
  const Inpainting* law = as_inpainting(model);
  if (law == nullptr) return std::nullopt;
  constexpr std::uint64_t samples = 8;
  const std::vector<double>& mean = law->kriging_operator().field().mean;
  const Eigen::VectorXd own = as_vector(covariance_across(target.exemplar.pixels, law->missing(), mean));
  Eigen::VectorXd inpainted = Eigen::VectorXd::Zero(own.size()), free = inpainted;
  for (std::uint64_t s = 0; s < samples; ++s) {
    inpainted += as_vector(covariance_across(law->sample(Seed{s}).image, law->missing(), mean)) / samples;
    free += as_vector(covariance_across(law->unconditional(Seed{s}), law->missing(), mean)) / samples;
  }
  return (inpainted - own).norm() / (free - own).norm();
}

std::optional<double> estimate_bias(const Model& model, const Target& target, const Domain&) {
  const Inpainting* law = as_inpainting(model);
  if (law == nullptr) return std::nullopt;
  constexpr int reach = 9;
  const Image& u = target.exemplar.pixels;
  const auto table = [&](const Mask& missing) {
    const Extent box{std::min(reach, u.width()), std::min(reach, u.height())};
    return BoxCovariance(estimate_field(u, missing), u.extent(), box).table(box);
  };
  const CovarianceTable whole = table(Mask(u.extent()));
  const CovarianceTable masked = table(law->missing());
  double difference_square = 0, square = 0;
  for (int c = 0; c < u.channels(); ++c) {
    for (int d = 0; d < u.channels(); ++d) {
      for (int vy = 1 - whole.reach().height; vy < whole.reach().height; ++vy) {
        for (int vx = 1 - whole.reach().width; vx < whole.reach().width; ++vx) {
          const double value = whole.at(c, d, vx, vy);
          const double error = masked.at(c, d, vx, vy) - value;
          difference_square += error * error;
          square += value * value;
        }
      }
    }
  }
  return std::sqrt(difference_square / square);
}

}  // namespace textonbench
