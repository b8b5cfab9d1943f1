// The programs that draw lines, points, and the cap of a section.

import { FINISH } from './shaders_shared.js';

/** The depth of a point moved towards the eye by a small share, so that a line on a surface is before it. */
const NEARER = `
float depthNearer(vec3 at, float w, float share) {
  vec3 moved = projectionMatrix[3][3] == 0.0 ? at * (1.0 - share) : at + vec3(0.0, 0.0, share * 2.0 / projectionMatrix[1][1]);
  vec4 p = projectionMatrix * vec4(moved, 1.0);
  return p.z / p.w * w;
}`;

/** Lines some pixels wide: each segment is a rectangle on the screen. */
export const LINE_VERTEX = `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 screen;
uniform float width;
uniform float nearer;
uniform int mode; // 0 one colour, 1 colour of the edge
uniform sampler2D colors;
uniform vec3 color;
uniform uint hovered;
uniform uint chosen;
uniform float nearPlane;
in vec2 corner;
in vec3 from;
in vec3 to;
in uint edge;
${NEARER}
out vec3 vAt;
out vec3 vColor;
flat out float vMarked;
out float vAcross;
flat out float vHalf;
void main() {
  vMarked = edge == chosen ? 1.0 : edge == hovered ? 0.7 : 0.0;
  vColor = color;
  float wide = width;
  if (mode == 1) {
    vec4 own = texelFetch(colors, ivec2(int(edge & 1023u), int(edge >> 10)), 0);
    vColor = own.rgb;
    wide *= 0.5 + own.a * 2.0;
  }
  if (vMarked > 0.0) wide = max(wide + 1.6, 3.0);
  vec4 a = modelViewMatrix * vec4(from, 1.0);
  vec4 b = modelViewMatrix * vec4(to, 1.0);
  if (projectionMatrix[3][3] == 0.0) { // In perspective a segment may begin behind the eye.
    float limit = -nearPlane;
    if (a.z > limit && b.z > limit || edge == 0xffffffffu) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    if (a.z > limit) a = mix(b, a, (b.z - limit) / (b.z - a.z));
    if (b.z > limit) b = mix(a, b, (a.z - limit) / (a.z - b.z));
  } else if (edge == 0xffffffffu) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
  vec4 pa = projectionMatrix * a;
  vec4 pb = projectionMatrix * b;
  vec2 along = (pb.xy / pb.w - pa.xy / pa.w) * screen;
  float size = length(along);
  along = size > 1e-6 ? along / size : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  float halfWidth = 0.5 * wide + 0.6;
  vec4 p = corner.x < 0.5 ? pa : pb;
  vAt = corner.x < 0.5 ? a.xyz : b.xyz;
  vec2 shift = (across * corner.y + along * (corner.x < 0.5 ? -0.35 : 0.35)) * halfWidth;
  p.xy += shift * 2.0 / screen * p.w;
  p.z = depthNearer(vAt, p.w, nearer * (vMarked > 0.0 ? 2.0 : 1.0));
  vAcross = corner.y * halfWidth;
  vHalf = halfWidth - 0.6;
  gl_Position = p;
}`;

export const LINE_FRAGMENT = `
precision highp float;
precision highp int;
in vec3 vAt;
in vec3 vColor;
flat in float vMarked;
in float vAcross;
flat in float vHalf;
${FINISH}
void main() {
  beside(vAt);
  finish(vColor, 1e9, vMarked);
  result.a *= 1.0 - smoothstep(vHalf - 0.4, vHalf + 0.6, abs(vAcross));
  if (result.a < 0.02) discard;
}`;

export const POINT_VERTEX = `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float width;
uniform float nearer;
uniform int hovered;
uniform int chosen;
in vec3 position;
${NEARER}
out vec3 vAt;
flat out float vMarked;
flat out float vSize;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vAt = at.xyz;
  vMarked = gl_VertexID == chosen ? 1.0 : gl_VertexID == hovered ? 0.7 : 0.0;
  vSize = width * (vMarked > 0.0 ? 1.5 : 1.0);
  gl_Position = projectionMatrix * at;
  gl_Position.z = depthNearer(vAt, gl_Position.w, nearer);
  gl_PointSize = vSize;
}`;

export const POINT_FRAGMENT = `
precision highp float;
precision highp int;
uniform vec3 rim;
in vec3 vAt;
flat in float vMarked;
flat in float vSize;
${FINISH}
void main() {
  beside(vAt);
  float r = length(gl_PointCoord - 0.5) * vSize;
  float edge = vSize * 0.5;
  finish(mix(color, rim, smoothstep(edge - 2.6, edge - 1.8, r)), 1e9, vMarked);
  result.a *= 1.0 - smoothstep(edge - 1.0, edge, r);
  if (result.a < 0.05) discard;
}`;

/** What marks the inside of closed bodies in the stencil buffer: only the section plane matters. */
export const STENCIL_VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
out vec3 vAt;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  vAt = at.xyz;
  gl_Position = projectionMatrix * at;
}`;

export const STENCIL_FRAGMENT = `
precision highp float;
uniform vec4 cut;
in vec3 vAt;
out vec4 result;
void main() {
  if (dot(cut.xyz, vAt) + cut.w < 0.0) discard;
  result = vec4(1.0);
}`;

/** The cap: hatched with lines at a fixed distance on the screen. */
export const CAP_FRAGMENT = `
precision highp float;
uniform vec3 color;
in vec3 vAt;
out vec4 result;
void main() {
  float stripe = abs(fract((gl_FragCoord.x + gl_FragCoord.y) / 11.0) - 0.5) * 11.0;
  result = vec4(mix(color * 0.72, color, smoothstep(0.5, 1.5, stripe)), 1.0);
}`;
