// Sums of kernels over the impacts of recipe_grid(): adds them to the sums of a point, in the order of cells and of
// impacts in each.
#ifdef COMPUTE
#include "impact_tile.glsl"
#else
void add_impacts(PlanePoint point, mat2 footprint, PlaneBox tile, inout vec4 sums[GROUPS]) {
  KernelFilter kernel = kernel_filter(footprint);
  ImpactGrid grid = recipe_grid();
  CellRange range = cells_of(grid, reaching(tile, kernel.margin));
  for (int y = range.low.y; y <= range.high.y; ++y) {
    for (int x = range.low.x; x <= range.high.x; ++x) {
      ivec2 cell = ivec2(x, y);
      CellWords open = open_cell(grid, cell);
      uint count = impact_count(grid, open);
      for (uint i = 0u; i < count; ++i) {
        add_impact(point, kernel, impact_on_plane(grid, cell, next_impact(grid, open, i)), sums);
      }
    }
  }
}
#endif
