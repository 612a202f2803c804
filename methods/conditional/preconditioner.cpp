#include "methods/conditional/preconditioner.h"

#include <algorithm>
#include <limits>

namespace textonbench {
namespace {

class Circulant final : public Preconditioner {
 public:
  Circulant(const KrigingOperator& op, double shift)
      : op_(op),
        transform_(op.covariance().grid(), op.covariance().box()),
        spot_(spot_spectrum(op.field().spot, op.covariance().grid())),
        shift_(shift * mean_variance(op.field()) + op.field().nugget_variance) {}

  /// (t̂ t̂* + ε I)⁻¹ p = (p − t̂ (t̂* p) / (ε + |t̂|²)) / ε, by Sherman and Morrison.
  void apply(std::span<const double> residual, std::span<double> out) const override {
    const int channels = op_.channels();
    const double scale = 1 / (shift_ * static_cast<double>(transform_.grid().area()));
    Planes fields = op_.scattered(residual);
    BoxTransform::Workspace workspace;
    transform_.map(
        fields,
        [&](const SpectrumColumns& block) {
          for_columns(block, transform_.columns(), [&](int i, std::size_t n) {
            for (int y = 0; y < block.height; ++y) {
              std::complex<double> product = 0;
              double power = 0;
              for (int c = 0; c < channels; ++c) {
                const std::complex<double> t = spot_[static_cast<std::size_t>(c)][n + y];
                product += std::conj(t) * block.column(c, i)[y];
                power += std::norm(t);
              }
              product /= shift_ + power;
              for (int c = 0; c < channels; ++c) {
                std::complex<double>& bin = block.column(c, i)[y];
                bin = scale * (bin - spot_[static_cast<std::size_t>(c)][n + y] * product);
              }
            }
          });
        },
        workspace);
    const std::vector<double> values = op_.gathered(fields, op_.conditioning_pixels());
    std::ranges::copy(values, out.begin());
  }

  std::size_t bytes() const override { return spot_.size() * spot_.front().size() * sizeof(spot_.front().front()); }

 private:
  const KrigingOperator& op_;
  BoxTransform transform_;
  std::vector<Bins> spot_;
  double shift_;
};

}  // namespace

std::unique_ptr<Preconditioner> circulant_preconditioner(const KrigingOperator& op, double shift) {
  return std::make_unique<Circulant>(op, shift);
}

std::string nugget_advice() {
  return "white noise in the model makes it regular: expected a nugget, such as 0.0001 of the variance (nugget=0.0001)";
}

bool singular_pivots(double least_pivot, double largest_variance, std::size_t unknowns) {
  return !(least_pivot > static_cast<double>(unknowns) * std::numeric_limits<double>::epsilon() * largest_variance);
}

}  // namespace textonbench
