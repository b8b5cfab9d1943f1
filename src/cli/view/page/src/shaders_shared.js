// What the programs of the graphics card share. Colours are taken and given as they stand on the screen.
// `cut` is the section plane in the camera's frame: what lies on its negative side is not drawn.

export const FINISH = `
uniform vec4 cut;
uniform vec3 color;
uniform vec3 accent;
uniform vec3 cutColor;
uniform float glow;
uniform float stale;
uniform float opacity;
out vec4 result;
float beside(vec3 at) {
  float d = dot(cut.xyz, at) + cut.w;
  if (d < 0.0) discard;
  return d;
}
void finish(vec3 c, float d, float marked) {
  c = mix(c, accent, max(marked, glow));
  c = mix(c, vec3(dot(c, vec3(0.3, 0.59, 0.11))) * 0.6 + 0.22, stale);
  if (dot(cut.xyz, cut.xyz) > 0.5) c = mix(c, cutColor, 1.0 - smoothstep(1.2, 2.2, d / max(fwidth(d), 1e-20)));
  result = vec4(c, opacity);
}`;
