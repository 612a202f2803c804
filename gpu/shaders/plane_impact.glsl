// Impacts of cells of the plane.
struct PlaneImpact {
  PlanePoint place;
  int kernel;
  float weight;
};

// Cells counted from one of them.
struct CellRange {
  ivec2 low;
  ivec2 high;
};

// Those that hold the points of a box, of cells of that side from a corner on.
CellRange cells_in(PlaneBox box, ivec2 corner, int side) {
  ivec2 low = box.low - corner;
  ivec2 high = box.high - corner;
  return CellRange(ivec2(floor_division(low.x, side), floor_division(low.y, side)),
                   ivec2(floor_division(high.x, side), floor_division(high.y, side)));
}
