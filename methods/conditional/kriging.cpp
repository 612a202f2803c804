#include "methods/conditional/kriging.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "methods/base/convolution.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

std::vector<Pixel> checked_pixels(const Mask& conditioning, const Mask& missing) {
  if (conditioning.extent() != missing.extent()) {
    throw std::invalid_argument("masks of missing and of conditioning pixels: expected one size");
  }
  std::vector<Pixel> pixels = pixels_of(conditioning);
  if (pixels.empty()) throw std::invalid_argument("no conditioning pixel: expected at least one");
  for (const Pixel& pixel : pixels) {
    if (missing.at(pixel.x, pixel.y))
      throw std::invalid_argument("a conditioning pixel is missing: expected a known one");
  }
  return pixels;
}

std::vector<Pixel> checked_missing(const Mask& missing) {
  std::vector<Pixel> pixels = pixels_of(missing);
  if (pixels.empty()) throw std::invalid_argument("no pixel is missing: expected at least one");
  return pixels;
}

Rectangle box_of(std::span<const Pixel> a, std::span<const Pixel> b) {
  std::vector<Pixel> both(a.begin(), a.end());
  both.insert(both.end(), b.begin(), b.end());
  return bounding_box(both);
}

/// One channel, in single precision.
Image channel_of(const Planes& planes, int channel) {
  Image image(planes.extent, 1);
  for (int y = 0; y < planes.extent.height; ++y) {
    std::transform(planes.row(channel, y), planes.row(channel, y) + planes.extent.width, image.row(0, y).begin(),
                   [](double value) { return static_cast<float>(value); });
  }
  return image;
}

}  // namespace

KrigingOperator::KrigingOperator(GaussianField field, const Mask& conditioning, const Mask& missing)
    : field_(std::move(field)),
      conditioning_(checked_pixels(conditioning, missing)),
      missing_(checked_missing(missing)),
      picture_(missing.extent()),
      box_(box_of(conditioning_, missing_)),
      covariance_(field_, picture_, box_.size) {}

Planes KrigingOperator::scattered(std::span<const double> values) const {
  Planes fields(box_.size, channels());
  for (int c = 0; c < channels(); ++c) {
    const double* in = values.data() + std::ptrdiff_t{c} * points();
    for (int i = 0; i < points(); ++i) {
      const Pixel& pixel = conditioning_[static_cast<std::size_t>(i)];
      fields.row(c, pixel.y - box_.y)[pixel.x - box_.x] = in[i];
    }
  }
  return fields;
}

std::vector<double> KrigingOperator::gathered(const Planes& fields, std::span<const Pixel> pixels) const {
  std::vector<double> values;
  values.reserve(pixels.size() * static_cast<std::size_t>(channels()));
  for (int c = 0; c < channels(); ++c) {
    for (const Pixel& pixel : pixels) values.push_back(fields.row(c, pixel.y - box_.y)[pixel.x - box_.x]);
  }
  return values;
}

void KrigingOperator::apply(std::span<const double> x, std::span<double> out, Workspace& workspace) const {
  Planes fields = scattered(x);
  covariance_.apply(fields, workspace);
  for (int c = 0; c < channels(); ++c) {
    const std::ptrdiff_t first = std::ptrdiff_t{c} * points();
    for (int i = 0; i < points(); ++i) {
      const Pixel& pixel = conditioning_[static_cast<std::size_t>(i)];
      out[static_cast<std::size_t>(first + i)] = fields.row(c, pixel.y - box_.y)[pixel.x - box_.x] +
                                                 field_.nugget_variance * x[static_cast<std::size_t>(first + i)];
    }
  }
}

std::vector<double> KrigingOperator::extend(std::span<const double> k) const {
  Workspace workspace;
  Planes fields = scattered(k);
  covariance_.apply(fields, workspace);
  return gathered(fields, missing_);
}

void KrigingOperator::fill_matrix(std::span<const int> points, const CovarianceTable& table, double* matrix) const {
  const std::size_t n = points.size();
  const std::size_t side = n * static_cast<std::size_t>(channels());
  for (int d = 0; d < channels(); ++d) {
    for (std::size_t j = 0; j < n; ++j) {
      const Pixel& q = conditioning_[static_cast<std::size_t>(points[j])];
      double* column = matrix + (static_cast<std::size_t>(d) * n + j) * side;
      for (int c = 0; c < channels(); ++c) {
        for (std::size_t i = 0; i < n; ++i) {
          const Pixel& p = conditioning_[static_cast<std::size_t>(points[i])];
          column[static_cast<std::size_t>(c) * n + i] = table.at(c, d, p.x - q.x, p.y - q.y);
        }
      }
      column[static_cast<std::size_t>(d) * n + j] += field_.nugget_variance;
    }
  }
}

/// ADSN of the spot in the box (on a torus: everywhere), in single precision: its rounding is a nugget of 1e-14 of the
/// variance. Channel by channel, because the spectra of a large picture are what takes most memory here.
KrigingOperator::Values KrigingOperator::simulate(Seed seed) const {
  const Stream stream = Stream(seed).child("conditional");
  const Extent spot = field_.spot.extent;
  const Rectangle needed =
      field_.periodic
          ? Rectangle{0, 0, picture_}
          : Rectangle{box_.x, box_.y, {box_.size.width + spot.width - 1, box_.size.height + spot.height - 1}};
  Image noise(needed.size, 1);
  parallel_for(noise.height(), [&](int y) {
    fill_plane_normal(stream.child("noise"), needed.x, std::int64_t{needed.y} + y, noise.row(0, y));
  });
  Planes fields(box_.size, channels());
  for (int c = 0; c < channels(); ++c) {
    const Image kernel = field_.periodic ? wrap(channel_of(field_.spot, c), picture_) : channel_of(field_.spot, c);
    const Image sample =
        field_.periodic ? convolve_circular({&kernel, 1}, {&noise, 1}) : convolve_valid({&kernel, 1}, {&noise, 1});
    const Pixel first = field_.periodic ? Pixel{box_.x, box_.y} : Pixel{0, 0};
    for (int y = 0; y < box_.size.height; ++y) {
      const auto row = sample.row(0, first.y + y).subspan(static_cast<std::size_t>(first.x));
      std::copy_n(row.begin(), box_.size.width, fields.row(c, y));
    }
  }
  if (field_.nugget_variance > 0) {
    const double deviation = std::sqrt(field_.nugget_variance);
    std::vector<float> nugget(static_cast<std::size_t>(box_.size.width));
    for (int c = 0; c < channels(); ++c) {
      const Stream own = stream.child("nugget").child(static_cast<std::uint64_t>(c));
      for (int y = 0; y < box_.size.height; ++y) {
        fill_plane_normal(own, box_.x, std::int64_t{box_.y} + y, nugget);
        for (int x = 0; x < box_.size.width; ++x) {
          fields.row(c, y)[x] += deviation * static_cast<double>(nugget[static_cast<std::size_t>(x)]);
        }
      }
    }
  }
  return {gathered(fields, conditioning_), gathered(fields, missing_)};
}

std::size_t KrigingOperator::bytes() const {
  return covariance_.bytes() + field_.spot.data.size() * sizeof(double) +
         (conditioning_.size() + missing_.size()) * sizeof(Pixel);
}

}  // namespace textonbench
