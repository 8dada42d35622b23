// One block of tiles of the view in each instance. ALONE: where its corners lie in the picture of its one layer. NEAR:
// where they lie in those of the first layers of its list.
layout(location = 0) in ivec4 tiles;  // column, row, columns, rows
layout(location = 1) in int shows;    // a layer, or where a list begins
uniform int tile_size;
uniform vec2 middle;  // of the view, pixels
#ifdef ALONE
out vec3 source;  // homogeneous; in pixels, or with DISTORTION in normalised coordinates
flat out float slot;
flat out float gain;
#ifdef DISTORTION
flat out vec4 intrinsics;
flat out vec4 distortion;
flat out vec4 lens;
#endif
#else
flat out int list;
#endif
#ifdef NEAR
out vec4 near_source[NEAR];           // as source above; slot
flat out vec4 near_weight[NEAR / 2];  // weight and gain of two
flat out int near_count;
#endif

void main() {
  vec2 place = vec2((tiles.xy + tiles.zw * ivec2(gl_VertexID & 1, gl_VertexID >> 1)) * tile_size) - middle;
  gl_Position = vec4(place / middle, 0.0, 1.0);
#ifdef ALONE
  Layer layer = layers[shows];
  source = layer.from_x.xyz * place.x + layer.from_y.xyz * place.y + layer.from_1.xyz;
  slot = layer.from_x.w;
  gain = layer.from_1.w;
#ifdef DISTORTION
  intrinsics = layer.intrinsics;
  distortion = layer.distortion;
  lens = layer.lens;
#endif
#else
  list = shows;
#endif
#ifdef NEAR
  near_count = 0;
  for (int n = 0; n < NEAR; ++n) {
    int i = entry_of(list);
    vec2 weight = vec2(0.0);
    near_source[n] = vec4(0.0, 0.0, 1.0, 0.0);
    if (i != END_OF_LIST) {
      Layer layer = layers[i];
      near_source[n] = vec4(layer.from_x.xyz * place.x + layer.from_y.xyz * place.y + layer.from_1.xyz,
                            layer.from_x.w);
      weight = vec2(layer.from_y.w, layer.from_1.w);
      ++near_count;
      ++list;
    }
    if (n % 2 == 0) {
      near_weight[n / 2].xy = weight;
    } else {
      near_weight[n / 2].zw = weight;
    }
  }
#endif
}
