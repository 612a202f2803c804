// Asymptotic discrete spot noise (ADSN): the Gaussian limit of the sum of many randomly shifted copies of a spot.
//
//   torus:  Y_c = m_c + t_c ⊛ W        on the exemplar's own raster (circular convolution),
//   plane:  Y_c = m_c + t_c * W        on any window of Z²,
//
// with t = (p − m) / sqrt(|Ω|), p the periodic component of the exemplar, and one white Gaussian noise W for all
// channels (Galerne, Gousseau, Morel 2011; Lectures 2022, "Asymptotic discrete spot noise"). On the plane the
// covariance is the aperiodic autocorrelation of t, which tapers long lags to zero: another model than that of the
// torus.
#pragma once

#include "methods/exemplar_spot.h"

namespace textonbench {

struct AdsnOptions {
  SpotSource component = SpotSource::periodic_component;
};

std::unique_ptr<Model> fit_adsn(const Exemplar& exemplar, const AdsnOptions& options);

MethodEntry adsn_entry();

}  // namespace textonbench
