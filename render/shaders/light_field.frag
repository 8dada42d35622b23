// The light field of thesis 3 in one pass: at each pixel a loop over the layers, nearest first.
// SMALL_APERTURE blends "over" from the front and stops where nothing behind can be seen any more;
// otherwise the layers' weighted mean. DISTORTION where any source has a lens that distorts. SHAPE
// where pictures are projected onto the scene's shape instead of planes.

struct Layer {
  // (source.xyz, before_view) = from_x * x + from_y * y + from_1 at gl_FragCoord. The source is in
  // pixels, or with DISTORTION or SHAPE in normalised coordinates; with SHAPE at infinity, and w is
  // of its depth map: slot, size in pixels of the picture (0 if there is none), largest sample.
  vec4 from_x;
  vec4 from_y;
  vec4 from_1;
  vec4 picture;     // width - 1, height - 1, slot in the texture array, 1 / feather width
  vec4 blend;       // weight or alpha, k3, squared radius of the fold, 1 if a fisheye lens
  vec4 intrinsics;  // fx fy cx cy
  vec4 distortion;  // as pixel_of() has it
  vec4 shift;       // SHAPE: source.xyz moves by this times the inverse depth
};

layout(std140) uniform Layers {
  Layer layers[MAX_LAYERS];
};
uniform int layer_count;
uniform vec2 texel_size;           // 1 / size of the texture array
uniform float least_total_weight;  // smallest divisor of a mean
uniform float stop;                // small aperture: transmittance at which a pixel is done
uniform sampler2DArray pictures;
#ifdef SHAPE
uniform sampler2D inverse_depths;  // at the corners of cells
uniform vec4 cells;                // texture coordinates = gl_FragCoord.xy * cells.xy + cells.zw
uniform sampler2DArray maps;
uniform vec2 map_texel_size;
#endif

out vec4 color;

#ifdef SHAPE
// render::closeness().
float closeness(vec3 ray_of_view, vec3 ray_of_source) {
  float view_length = length(ray_of_view);
  float source_length = length(ray_of_source);
  float angle = distance(ray_of_view / view_length, ray_of_source / source_length);
  float farther = max(0.0, source_length / view_length - 1.0);
  float near = 1.0 / (angle + FARTHER_PENALTY * farther + LEAST_PENALTY);
  return near * near * near;
}

// render::visibility().
float visibility(float seen, float inverse_depth) {
  float hiding = clamp((seen / inverse_depth - BEFORE) / (HIDING - BEFORE), 0.0, 1.0);
  return mix(1.0, HIDDEN, hiding * hiding * (3.0 - 2.0 * hiding));
}

// Of a point of layer i that is at source = normalised coordinates times z.
float visibility_of(int i, vec3 source, float inverse_depth) {
  float size = layers[i].from_y.w;
  if (size <= 0.0 || inverse_depth <= 0.0) return 1.0;
  vec2 pixel = layers[i].intrinsics.xy * (source.xy / source.z) + layers[i].intrinsics.zw;
  vec2 at = (pixel + 0.5) * size * map_texel_size;
  vec2 least = 0.5 * map_texel_size;
  vec2 most = (layers[i].picture.xy + 1.0) * size * map_texel_size - least;
  at = clamp(at, least, most);
  float seen = textureLod(maps, vec3(at, layers[i].from_x.w), 0.0).r * layers[i].from_1.w;
  return visibility(seen, inverse_depth / source.z);
}

float inverse_depth() {
  return textureLod(inverse_depths, gl_FragCoord.xy * cells.xy + cells.zw, 0.0).r;
}
#endif

// Weight of layer i at this pixel after feathering; 0 where it shows nothing. With SHAPE, `near` is
// its closeness there.
float seen(int i, float inverse_depth, out vec2 pixel, out float near) {
  vec4 source = layers[i].from_x * gl_FragCoord.x + layers[i].from_y * gl_FragCoord.y +
                layers[i].from_1;
#ifdef SHAPE
  vec3 ray_of_view = source.xyz;
  source = vec4(source.xyz + inverse_depth * layers[i].shift.xyz, 1.0);
#endif
  bool visible = source.z > 0.0 && source.w > 0.0;
  pixel = source.xy / source.z;
#ifdef DISTORTION
  visible = visible && dot(pixel, pixel) < layers[i].blend.z;
  pixel = pixel_of(pixel, layers[i].intrinsics, layers[i].distortion, layers[i].blend.y,
                   layers[i].blend.w > 0.5);
#elif defined(SHAPE)
  pixel = layers[i].intrinsics.xy * pixel + layers[i].intrinsics.zw;
#endif
  vec2 inside = min(pixel, layers[i].picture.xy - pixel) * layers[i].picture.w;
  vec2 fade = clamp(inside, 0.0, 1.0);
  fade = fade * fade * (3.0 - 2.0 * fade);
#ifdef SHAPE
  near = closeness(ray_of_view, source.xyz) * visibility_of(i, source.xyz, inverse_depth);
#else
  near = 1.0;
#endif
  return visible ? layers[i].blend.x * fade.x * fade.y : 0.0;
}

vec3 picture_at(int i, vec2 pixel) {
  vec2 at = (pixel + 0.5) * texel_size;
  return textureLod(pictures, vec3(at, layers[i].picture.z), 0.0).rgb;
}

void main() {
  vec3 sum = vec3(0.0);
#ifdef SHAPE
  float depth = inverse_depth();
#else
  const float depth = 0.0;
#endif
#ifdef SMALL_APERTURE
  float transmittance = 1.0;
  for (int i = 0; i < layer_count && transmittance > stop; ++i) {
    vec2 pixel;
    float near;
    float alpha = seen(i, depth, pixel, near);
    if (alpha > 0.0) {
      sum += transmittance * alpha * picture_at(i, pixel);
      transmittance *= 1.0 - alpha;
    }
  }
  color = vec4(sum, 1.0);
#else
  float total = 0.0;
  float near_total = 0.0;
  for (int i = 0; i < layer_count; ++i) {
    vec2 pixel;
    float near;
    float weight = seen(i, depth, pixel, near);
    if (weight > 0.0) {
      sum += near * weight * picture_at(i, pixel);
      near_total += near * weight;
      total += weight;
    }
  }
  float covered = total / max(total, least_total_weight);
  color = vec4(near_total > 0.0 ? sum * (covered / near_total) : vec3(0.0), 1.0);
#endif
}
