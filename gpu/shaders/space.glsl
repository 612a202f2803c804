// Points of space as PlanePoint has those of the plane, relative to the origin, with the frame of a surface there: its
// columns are u1, u2 and the normal (methods/base/surface_view.h).
struct SpacePoint {
  ivec3 coarse;
  ivec3 fine;
  mat3 frame;
};

mat3 surface_frame(vec3 normal) {
  vec3 east = vec3(-normal.y, normal.x, 0.0);
  float east_length = length(east);
  east = east_length > 1e-9 ? east / east_length : vec3(1.0, 0.0, 0.0);
  return mat3(east, cross(normal, east), normal);
}

SpacePoint space_point(vec3 place, vec3 normal) {
  vec3 units = place * 1024.0;
  vec3 whole = floor(units);
  return SpacePoint(ivec3(whole), ivec3((units - whole) * 4096.0), surface_frame(normal));
}
