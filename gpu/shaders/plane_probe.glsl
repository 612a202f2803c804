// Shows where the pixels of a frame are: for tests of frames, and the smallest example of a recipe's file.
#if CHANNELS != 8
#error plane_probe has 8 channels
#endif

// The point's coarse and fine coordinates and its footprint; −1 in place of fine ones outside the tile.
void texture_at(PlanePoint point, mat2 footprint, PlaneBox tile, out float values[CHANNELS]) {
  bool is_inside = all(greaterThanEqual(point.coarse, tile.low)) && all(lessThanEqual(point.coarse, tile.high));
  values[0] = float(point.coarse.x);
  values[1] = float(point.coarse.y);
  values[2] = is_inside ? float(point.fine.x) : -1.0;
  values[3] = is_inside ? float(point.fine.y) : -1.0;
  values[4] = footprint[0].x;
  values[5] = footprint[0].y;
  values[6] = footprint[1].x;
  values[7] = footprint[1].y;
}
