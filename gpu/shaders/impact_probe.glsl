// Shows impact number probe_impact of the cell that each pixel lies in: the number of impacts of the cell, x and y in
// 2^−24 cell sides, and twice the kernel, plus one for an impact of negative weight. Zeros where there is no such
// impact, beside the number.
#include "plane.glsl"
#include "recipe_grid.glsl"

uniform int probe_impact;

void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  for (int c = 0; c < CHANNELS; ++c) values[c] = 0.0;
  ImpactGrid grid = recipe_grid();
  CellWords open = open_cell(grid, cells_of(grid, PlaneBox(point.coarse, point.coarse)).low);
  uint count = impact_count(grid, open);
  values[0] = float(count);
  uint i = uint(probe_impact);
  if (i >= count) return;
  skip_to_impact(grid, open, i);
  CellImpact impact = next_impact(grid, open, i);
  values[1] = float(impact.place.x);
  values[2] = float(impact.place.y);
  values[3] = float(2 * impact.kernel + (impact.weight < 0.0 ? 1 : 0));
}
