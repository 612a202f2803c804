// Shows kernel number probe_impact of the cell of band probe_band that each pixel lies in: its place from the base, coarse
// and fine, entry, phase in two halves, and weight. Zeros where there is no such kernel.
#include "gabor_kernels.glsl"

#if CHANNELS != 8
#error gabor_probe has 8 channels
#endif

uniform int probe_band;
uniform int probe_impact;

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  for (int c = 0; c < CHANNELS; ++c) values[c] = 0.0;
  GaborBand band = band_at(uint(probe_band));
  ivec2 cell = cells_of(band.grid, PlaneBox(point.coarse, point.coarse)).low;
  CellWords open = open_cell(band.grid, cell);
  uint i = uint(probe_impact);
  if (i >= impact_count(band.grid, open)) return;
  skip_to_impact(band.grid, open, i);
  PlaneImpact impact = impact_on_plane(band.grid, cell, next_impact(band.grid, open, i));
  GaborKernel kernel = kernel_of(band, impact);
  values[0] = float(impact.place.coarse.x);
  values[1] = float(impact.place.coarse.y);
  values[2] = float(impact.place.fine.x);
  values[3] = float(impact.place.fine.y);
  values[4] = float(kernel.entry);
  values[5] = float(kernel.phase >> 16);
  values[6] = float(kernel.phase & 65535u);
  values[7] = kernel.weight;
}
