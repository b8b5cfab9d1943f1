// The programs that draw display triangles of surfaces and elements of meshes.

import { FINISH } from './shaders_shared.js';

const LIGHT = `
vec3 lit(vec3 base, vec3 n, vec3 v) {
  float key = max(dot(n, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float fill = max(dot(n, normalize(vec3(0.7, -0.15, 0.6))), 0.0);
  float head = max(dot(n, v), 0.0);
  float shine = pow(max(dot(reflect(-normalize(vec3(-0.35, 0.55, 0.75)), n), v), 0.0), 24.0);
  return base * (0.42 + 0.42 * key + 0.16 * fill + 0.22 * head) + 0.09 * shine;
}`;

/** From −1 to 1: blue, pale, red. */
const RAMP = `
vec3 ramp(float x) {
  x = clamp(x, -1.0, 1.0);
  vec3 pale = vec3(0.91, 0.91, 0.89);
  return x < 0.0 ? mix(pale, vec3(0.13, 0.36, 0.72), pow(-x, 0.8)) : mix(pale, vec3(0.78, 0.18, 0.16), pow(x, 0.8));
}
/** From 0 to 1: dark blue, green, yellow. */
vec3 rise(float x) {
  x = clamp(x, 0.0, 1.0);
  return x < 0.5 ? mix(vec3(0.23, 0.25, 0.55), vec3(0.13, 0.61, 0.53), x * 2.0) : mix(vec3(0.13, 0.61, 0.53), vec3(0.98, 0.84, 0.20), x * 2.0 - 1.0);
}`;

export const FACE_VERTEX = `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform mat3 normalMatrix;
uniform bool flatView;
in vec3 position;
in vec3 normal;
in uint face;
in vec2 value; // Gauss and mean curvature
in float moved;
uniform int which;
uniform int mode;
flat out uint vFace;
out vec3 vNormal;
out vec3 vAt;
out float vValue;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vAt = at.xyz;
  vNormal = normalMatrix * normal;
  vFace = face;
  vValue = mode == 5 ? moved : which == 0 ? value.x : value.y;
  gl_Position = projectionMatrix * at;
}`;

export const FACE_FRAGMENT = `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform int mode; // 0 one colour, 1 colour of the face, 2 value both ways, 3 zebra, 4 side, 5 value upwards
uniform sampler2D colors;
uniform bool flatView;
uniform vec2 range;
uniform uint hovered;
uniform uint chosen;
flat in uint vFace;
in vec3 vNormal;
in vec3 vAt;
in float vValue;
${FINISH}${LIGHT}${RAMP}
void main() {
  float d = beside(vAt);
  vec3 v = flatView ? vec3(0.0, 0.0, 1.0) : normalize(-vAt);
  vec3 n = normalize(vNormal);
  if (!gl_FrontFacing) n = -n;
  if (dot(n, v) < 0.0) n = normalize(n - 2.0 * dot(n, v) * v);
  vec3 base = color;
  if (mode == 1) base = texelFetch(colors, ivec2(int(vFace & 1023u), int(vFace >> 10)), 0).rgb;
  if (mode == 2) base = isnan(vValue) ? vec3(0.6) : ramp(vValue / max(range.y, 1e-30));
  if (mode == 5) base = isnan(vValue) ? vec3(0.6) : rise((vValue - range.x) / max(range.y - range.x, 1e-30));
  if (mode == 4) base = gl_FrontFacing ? vec3(0.45, 0.62, 0.80) : vec3(0.90, 0.48, 0.20);
  vec3 c = lit(base, n, v);
  if (mode == 3) {
    vec3 r = reflect(-v, n);
    float s = atan(r.y, length(r.xz)) * 11.0;
    float w = max(fwidth(s), 1e-4);
    c = vec3(0.08 + 0.87 * smoothstep(-w, w, sin(s)));
  } else if (mode == 0 && !gl_FrontFacing) c *= vec3(0.90, 0.88, 0.86);
  finish(c, d, vFace == chosen ? 0.55 : vFace == hovered ? 0.28 : 0.0);
}`;

/** Elements of a mesh: three corners per triangle, numbered by the vertex; a quadrangle is two triangles. */
export const MESH_VERTEX = `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform int triangleCount;
in vec3 position;
flat out int vElement;
out vec3 vAt;
out vec3 vSide;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vAt = at.xyz;
  int t = gl_VertexID / 3;
  int corner = gl_VertexID - 3 * t;
  vSide = vec3(corner == 0, corner == 1, corner == 2);
  vElement = t;
  if (t >= triangleCount) {
    int q = t - triangleCount;
    vElement = triangleCount + q / 2;
    if ((q & 1) == 0) vSide.y = 2.0; else vSide.z = 2.0; // The diagonal is no side of the quadrangle.
  }
  gl_Position = projectionMatrix * at;
}`;

export const MESH_FRAGMENT = `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform int mode; // 0 one colour, 1 colour of the element, 3 zebra (as plain), 4 side
uniform sampler2D colors;
uniform bool flatView;
uniform float sides;
uniform vec3 ink;
uniform int hovered;
uniform int chosen;
flat in int vElement;
in vec3 vAt;
in vec3 vSide;
${FINISH}${LIGHT}
void main() {
  float d = beside(vAt);
  vec3 v = flatView ? vec3(0.0, 0.0, 1.0) : normalize(-vAt);
  vec3 n = normalize(cross(dFdx(vAt), dFdy(vAt)));
  if (dot(n, v) < 0.0) n = -n;
  vec3 base = color;
  if (mode == 1) {
    vec4 own = texelFetch(colors, ivec2(vElement & 2047, vElement >> 11), 0);
    if (own.a < 0.5) discard;
    base = own.rgb;
  }
  if (mode == 4) base = gl_FrontFacing ? vec3(0.45, 0.62, 0.80) : vec3(0.90, 0.48, 0.20);
  vec3 c = lit(base, n, v);
  vec3 w = fwidth(vSide);
  vec3 near = smoothstep(w * 0.2, w * 1.1, vSide);
  float line = 1.0 - min(near.x, min(near.y, near.z));
  float dense = clamp(1.3 - 2.2 * max(w.x, max(w.y, w.z)), 0.0, 1.0);
  c = mix(c, ink, sides * line * max(dense, 0.12));
  finish(c, d, vElement == chosen ? 0.6 : vElement == hovered ? 0.3 : 0.0);
}`;
