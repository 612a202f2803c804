// Random points of Z² where a spot noise puts its kernels. All are whole-plane processes that a window cuts out: an
// impact depends on the stream and on its own cell, at absolute coordinates, so any window of any sample costs what
// the window holds, and windows agree where they overlap.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/random.h"

namespace textonbench {

/// Rectangle of Z²; corners within 2^53 of the origin.
struct PlaneWindow {
  std::int64_t x = 0;
  std::int64_t y = 0;
  Extent size;
};

/// `weight` times kernel number `kernel`, at a pixel of the window (whose corner is (0, 0)).
struct Impact {
  std::int32_t x, y;
  std::int32_t kernel;
  float weight;
};

/// Impacts of one row of cells, in the rows [first_row, end_row) of the window.
struct ImpactStrip {
  int first_row = 0;
  int end_row = 0;
  std::vector<Impact> impacts;
};

/// In an order, from strip to strip and within each, that is the same for the impacts shared by two windows.
struct ImpactSet {
  std::vector<ImpactStrip> strips;
  double mean_weight = 0;  ///< expected sum of the weights of one kernel at a pixel

  std::int64_t size() const;
};

/// From this intensity on Poisson impacts are not drawn one by one: each pixel gets a Poisson number for each kernel.
constexpr double dense_intensity = 4;

/// Poisson process of `intensity` impacts a pixel, in [1e-12, 1e12], each of which takes one of `kernels` kernels with
/// equal probability. Exact: every pixel and kernel has an independent Poisson number of mean intensity / kernels, the
/// sum of its weights (below dense_intensity impacts of weight 1; above, one of the number minus its mean).
ImpactSet draw_poisson(const Stream& stream, double intensity, int kernels, const PlaneWindow& window);

/// Square cells of 2^shift pixels a side, the first from 0 on, in which Poisson impacts below dense_intensity are
/// drawn, `mean` in each on average. They hold 8 to 32 impacts, which spreads the cost of a cell's stream, and are at
/// most 2^15 wide, so that the two halves of a random word make a position.
struct PoissonCells {
  int shift = 1;
  double mean = 0;
};
PoissonCells poisson_cells(double intensity);

/// Cells of side numerator / denominator along one axis, the first from 0 on.
struct CellAxis {
  std::int64_t numerator = 1;
  std::int64_t denominator = 1;

  double side() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// Cells that hold one impact each.
struct CellLattice {
  CellAxis x;
  CellAxis y;

  double intensity() const { return 1 / (x.side() * y.side()); }
};

/// Square cells of side 1 / sqrt(intensity), rounded to 1/1024 pixel so that the cells far from the origin are exact.
CellLattice plane_lattice(double intensity);

/// The whole number of cells along each side of the torus that comes nearest.
CellLattice torus_lattice(double intensity, Extent torus);

/// One impact in each cell, of weight ±1 with equal probability, uniform in the cell. Its pixel is the integer part of
/// its position, so over all cells each pixel expects the number of impacts that its own unit square does: `intensity`,
/// wherever the cells' borders run. That, with the independent signs, makes the covariance of a sum of kernels exactly
/// that of a Poisson process of the same intensity. Intensity in [1e-12, 64].
ImpactSet draw_stratified(const Stream& stream, const CellLattice& lattice, int kernels, const PlaneWindow& window);

}  // namespace textonbench
