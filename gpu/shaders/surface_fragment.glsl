// What the pixels of a surface need to be textured, at its place before it is displaced. Rasterizers round corners to parts of a pixel, and with them all that
// they interpolate: what it is at the pixel's center follows from the center and the derivatives.
in vec3 place;
in vec3 rest;
in vec3 bent_normal;
in vec2 coordinate;

uniform vec4 right;
uniform vec4 down;
uniform vec2 middle;
uniform float pixel_step;

layout(location = 0) out vec4 surface_place;       // pixels of the texture; 1 where there is a surface
layout(location = 1) out vec4 surface_normal;
layout(location = 2) out vec4 surface_coordinate;  // pixels of the texture; the second coordinate's derivatives
layout(location = 3) out vec4 surface_right;       // derivatives of the place by a pixel, the first coordinate's last
layout(location = 4) out vec4 surface_down;

void main() {
  vec2 seen = vec2(dot(right.xyz, place), dot(down.xyz, place)) + middle;
  vec2 away = gl_FragCoord.xy - 0.5 - seen;
  vec3 rest_x = dFdx(rest), rest_y = dFdy(rest);
  vec3 normal = bent_normal + dFdx(bent_normal) * away.x + dFdy(bent_normal) * away.y;
  vec2 coordinate_x = dFdx(coordinate), coordinate_y = dFdy(coordinate);
  surface_place = vec4(pixel_step * (rest + rest_x * away.x + rest_y * away.y), 1.0);
  surface_normal = vec4(normalize(normal), 0.0);
  surface_coordinate = vec4(coordinate + coordinate_x * away.x + coordinate_y * away.y, coordinate_x.y, coordinate_y.y);
  surface_right = vec4(pixel_step * rest_x, coordinate_x.x);
  surface_down = vec4(pixel_step * rest_y, coordinate_y.x);
}
