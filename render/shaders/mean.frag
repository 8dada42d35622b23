// Weighted mean, of light, of the first layers of a texture array, pixel by pixel. Alpha says how
// much of a layer's pixel is covered; its light is that much less. The mean is of what is covered,
// but where that is less than least_cover it fades to black.
uniform sampler2DArray pictures;
uniform int count;
uniform float weights[MOST];
uniform float least_cover;

out vec4 color;

void main() {
  vec3 sum = vec3(0.0);
  float covered = 0.0;
  for (int i = 0; i < count; ++i) {
    vec4 stored = texelFetch(pictures, ivec3(ivec2(gl_FragCoord.xy), i), 0);
    sum += weights[i] * light_of(stored.rgb);
    covered += weights[i] * stored.a;
  }
  color = vec4(stored_of(sum / max(covered, least_cover)), covered);
}
