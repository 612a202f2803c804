// Mixing K textons by an orthogonal matrix, which their cross-spectrum does not notice.
//
// For a real orthogonal K x K matrix R the kernels h'_k = Σ_j R_kj h_j have the cross-spectrum of the h_k. What does
// change is how many impacts a noise needs: an impact is sqrt(K) h_k with probability 1/K, so channel c of the
// normalized noise has the excess kurtosis κ_c / MNI with
//
//   κ_c = |S| K Σ_k Σ_x h_{k,c}(x)⁴ / (Σ_k Σ_x h_{k,c}(x)²)²,
//
// which is about 3 for featureless kernels of equal energy, whatever K (kernel_moments.h: poisson_moments at MNI 1).
#pragma once

#include <span>

namespace textonbench {

/// Mixes kernels, each given as as many numbers, `channels` equal parts of them one after another, in place: first of
/// all to equal energies (to 1e-6 of their mean), then, as far as that leaves a choice, to a least Σ_c κ_c. Plane
/// rotations of pairs, each the minimizer in closed form.
void mix_textons(std::span<double> kernels, int count, int channels);

}  // namespace textonbench
