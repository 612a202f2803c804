// The height of a texture: the mean of its first channels, at most three.
const int relief_channels = CHANNELS < 3 ? CHANNELS : 3;

float height_of(float values[CHANNELS]) {
  float sum = 0.0;
  for (int c = 0; c < relief_channels; ++c) sum += values[c];
  return sum / float(relief_channels);
}

#if IN_SPACE
float height_in_space(SpacePoint point, mat2 footprint) {
  float values[CHANNELS];
  texture_in_space(point, footprint, values);
  return height_of(values);
}
#else
float height_at(PlanePoint point, mat2 footprint) {
  float values[CHANNELS];
  texture_at(point, footprint, PlaneBox(point.coarse, point.coarse), values);
  return height_of(values);
}
#endif
