// The plain version of kriging: covariances by their sum, dense matrices.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "methods/base/mask.h"
#include "methods/conditional/gaussian_field.h"
#include "methods/conditional/kriging.h"

namespace textonbench {

/// Γ_cd(v) by the sum that defines it; on a torus of that size when the field is periodic. The nugget is left out.
inline double plain_covariance(const GaussianField& field, Extent torus, int c, int d, int vx, int vy) {
  const auto [width, height] = field.spot.extent;
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int qx = field.periodic ? ((x + vx) % torus.width + torus.width) % torus.width : x + vx;
      const int qy = field.periodic ? ((y + vy) % torus.height + torus.height) % torus.height : y + vy;
      if (qx < 0 || qy < 0 || qx >= width || qy >= height) continue;
      sum += field.spot.row(c, qy)[qx] * field.spot.row(d, y)[x];
    }
  }
  return sum;
}

/// Γ between the values at two lists of pixels, ordered channel by channel, with the nugget where pixels are the same.
inline Eigen::MatrixXd plain_matrix(const GaussianField& field, Extent torus, std::span<const Pixel> a,
                                    std::span<const Pixel> b) {
  const int channels = field.channels();
  Eigen::MatrixXd matrix(std::ssize(a) * channels, std::ssize(b) * channels);
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d < channels; ++d) {
      for (std::ptrdiff_t i = 0; i < std::ssize(a); ++i) {
        for (std::ptrdiff_t j = 0; j < std::ssize(b); ++j) {
          const Pixel& p = a[static_cast<std::size_t>(i)];
          const Pixel& q = b[static_cast<std::size_t>(j)];
          double value = plain_covariance(field, torus, c, d, p.x - q.x, p.y - q.y);
          if (c == d && p == q) value += field.nugget_variance;
          matrix(c * std::ssize(a) + i, d * std::ssize(b) + j) = value;
        }
      }
    }
  }
  return matrix;
}

inline Eigen::VectorXd to_vector(std::span<const double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

/// A mask whose pixels in the rectangle are set.
inline Mask rectangle_mask(Extent extent, const Rectangle& part) {
  Mask mask(extent);
  for (int y = part.y; y < part.y + part.size.height; ++y) {
    for (int x = part.x; x < part.x + part.size.width; ++x) mask.set(x, y, true);
  }
  return mask;
}

}  // namespace textonbench
