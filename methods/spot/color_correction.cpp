#include "methods/spot/color_correction.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "methods/spot/spline_spectrum.h"
#include "methods/spot/texton_error.h"

namespace textonbench {
namespace {

/// Symmetric square root; negative eigenvalues (rounding) count as zero.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// A^{−1/2}, zero in the directions that carry no color.
Eigen::MatrixXd inverse_root_of(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  const double smallest = 1e-8 * a.trace();
  const Eigen::VectorXd values =
      solver.eigenvalues().unaryExpr([&](double value) { return value < smallest ? 0 : 1 / std::sqrt(value); });
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

ParamSpec color_correction_param() {
  return {.name = "color_correction",
          .default_value = std::string("none"),
          .unit = "",
          .help =
              "linear map of the channels that restores the exemplar's covariance of colors; authors: the papers' "
              "map; transport: the one that changes colors least",
          .choices = {"none", "authors", "transport"}};
}

ColorCorrection color_correction_of(const Params& params) {
  const std::string& name = params.text("color_correction");
  return name == "none"      ? ColorCorrection::none
         : name == "authors" ? ColorCorrection::authors
                             : ColorCorrection::transport;
}

ParamSpec constrainable_color_correction_param() {
  ParamSpec spec = color_correction_param();
  spec.choices.emplace_back("constrained");
  spec.help =
      "give the noise the exemplar's color covariance: by the authors' map or the one that moves colors least "
      "(transport), afterwards, or while the error is minimized (constrained)";
  return spec;
}

Eigen::MatrixXd color_map(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, ColorCorrection correction) {
  if (a.rows() != a.cols() || a.rows() != b.rows() || b.rows() != b.cols()) {
    throw std::invalid_argument(fmt::format("color covariances of {}x{} and {}x{}: expected square ones of one size",
                                            a.rows(), a.cols(), b.rows(), b.cols()));
  }
  if (!a.allFinite() || !b.allFinite() || !(a.trace() > 0)) {
    throw std::invalid_argument(fmt::format(
        "color covariances of trace {} and {}: expected finite ones, the first above 0", a.trace(), b.trace()));
  }
  switch (correction) {
    case ColorCorrection::none:
      return Eigen::MatrixXd::Identity(a.rows(), a.cols());
    case ColorCorrection::authors:
      return root_of(b) * inverse_root_of(a);
    case ColorCorrection::transport:
      return inverse_root_of(a) * root_of(root_of(a) * b * root_of(a)) * inverse_root_of(a);
  }
  throw std::invalid_argument("unknown color correction");
}

Eigen::MatrixXd color_covariance(const Texton& texton, int order) {
  const int channels = texton.channels();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(channels, channels);
  for (const Image& kernel : texton.kernels) {
    const Image overlap = spline_overlap(kernel, order);
    for (int c = 0; c < channels; ++c) {
      for (int d = 0; d < channels; ++d) {
        for (int y = 0; y < kernel.height(); ++y) {
          for (int x = 0; x < kernel.width(); ++x) {
            covariance(c, d) += static_cast<double>(kernel.at(c, x, y)) * static_cast<double>(overlap.at(d, x, y));
          }
        }
      }
    }
  }
  return (covariance + covariance.transpose()) / 2;
}

CorrectedTexton correct_colors(Texton texton, const CrossSpectrum& target, ColorCorrection correction, int order) {
  CorrectedTexton result;
  result.map = color_map(color_covariance(texton, order), color_covariance(target), correction);
  result.rme_before = relative_model_error(texton, target, order);
  const int channels = texton.channels();
  for (Image& kernel : texton.kernels) {
    Eigen::VectorXd color(channels);
    for (int y = 0; y < kernel.height(); ++y) {
      for (int x = 0; x < kernel.width(); ++x) {
        for (int c = 0; c < channels; ++c) {
          color(c) = static_cast<double>(kernel.at(c, x, y));
        }
        const Eigen::VectorXd mapped = result.map * color;
        for (int c = 0; c < channels; ++c) {
          kernel.at(c, x, y) = static_cast<float>(mapped(c));
        }
      }
    }
  }
  result.texton = std::move(texton);
  result.rme_after = relative_model_error(result.texton, target, order);
  return result;
}

}  // namespace textonbench
