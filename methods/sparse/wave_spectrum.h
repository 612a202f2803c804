// Second-order law of local random-phase noise in closed form.
#pragma once

#include "methods/base/gaussian_model.h"
#include "methods/sparse/wave_field.h"

namespace textonbench {

/// Mean over a cell of Σ_i v_i(x + d) v_i(x), the windows v_i being those of the field with their scale: a function of
/// the distance d in spacings, zero from 3 spacings on along either axis. By Fourier transform of the windows on a grid
/// of 1/32 spacing; within 2e-5.
class WindowCorrelation {
 public:
  WindowCorrelation(LrpWindow window, bool even_variance);
  double at(double x, double y) const;

 private:
  double node(int x, int y) const;
  std::vector<double> nodes_;
};

/// Cross-spectrum on a grid of the noise's covariance, that of a layer being
///
///   Γ(v) = ½ Σ_j mean over the bins k and colors a of part j of Re(a a* exp(2πi k·v / T)) · correlation(v / Δ),
///
/// lags taken modulo the grid: exact where the grid is at least twice as large as 3 Δ of the widest layer.
CrossSpectrum wave_spectrum(const WaveField& field, Extent grid);

}  // namespace textonbench
