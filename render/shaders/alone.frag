// Where one layer alone shows, opaque: the picture as it is, with GAINS its light times the layer's gain.
uniform sampler2DArray pictures;
uniform vec2 texel_size;  // 1 / size of the texture array
in vec3 source;           // homogeneous; in pixels, or with DISTORTION in normalised coordinates
flat in float slot;
flat in float gain;
#ifdef DISTORTION
flat in vec4 intrinsics;
flat in vec4 distortion;
flat in vec4 lens;
#endif
out vec4 color;

void main() {
  vec2 pixel = source.xy / source.z;
#ifdef DISTORTION
  pixel = pixel_of(pixel, intrinsics, distortion, lens.x, lens.z > 0.5);
#endif
  vec2 at = (pixel + 0.5) * texel_size;
  vec3 stored = textureLod(pictures, vec3(at, slot), 0.0).rgb;
#ifdef GAINS
  stored = stored_of(gain * light_of(stored));
#endif
  color = vec4(stored, 1.0);
}
