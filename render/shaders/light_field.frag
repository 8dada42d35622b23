// The light field of thesis 3 in one pass: at each pixel a loop over the layers, nearest first.
// SMALL_APERTURE blends "over" from the front and stops where nothing behind can be seen any more;
// otherwise the layers' weighted mean. SHAPE where pictures are projected onto the scene's shape
// instead of planes; DISTORTION where any source has a lens that distorts; HORIZON where something
// that a ray meets may lie behind the view or a source; ONE_CAMERA where all sources have the same
// camera; TILES where each tile of the view has a list of the layers that show something there.
// What is not needed is not loaded: on a software GPU loads are a third of the time.

struct Layer {
  // Source = (from_x * x + from_y * y + from_1).xyz at a fragment's place from the middle of the
  // view: homogeneous, in pixels, or with DISTORTION or SHAPE in normalised coordinates, with SHAPE
  // at infinity. Beside them in w: slot of the picture; weight or alpha; gain.
  vec4 from_x;
  vec4 from_y;
  vec4 from_1;
  // A plane lies before the view where dot(beyond, (x, y, 1)) > 0. SHAPE: the source moves by this
  // times the inverse depth; w is the slot of its depth map, below 0 if it has none.
  vec4 beyond;
  vec4 picture;     // width - 1, height - 1, 1 / feather width, samples of its map per pixel
  vec4 intrinsics;  // fx fy cx cy
  vec4 distortion;  // as pixel_of() has it
  vec4 lens;        // k3, squared radius of the fold, 1 if a fisheye lens
};

layout(std140) uniform Layers {
  Layer layers[MAX_LAYERS];
};
uniform int layer_count;
uniform vec2 middle;               // of the view, as gl_FragCoord
uniform vec2 texel_size;           // 1 / size of the texture array
uniform float least_total_weight;  // smallest divisor of a mean
uniform float stop;                // small aperture: transmittance at which a pixel is done
uniform sampler2DArray pictures;
#ifdef TILES
uniform highp usampler2D lists;  // one in each row, ended by END_OF_LIST
uniform int tile_size;
uniform int tiles_across;
#endif
#ifdef SHAPE
uniform sampler2D inverse_depths;  // at the corners of cells
uniform vec4 cells;                // texture coordinates = gl_FragCoord.xy * cells.xy + cells.zw
uniform sampler2DArray maps;
uniform vec2 map_texel_size;
#endif

out vec4 color;

// Camera of the layer at hand.
vec4 picture;
vec4 intrinsics;
vec4 distortion;
vec4 lens;

void use_camera_of(int i) {
  picture = layers[i].picture;
  intrinsics = layers[i].intrinsics;
  distortion = layers[i].distortion;
  lens = layers[i].lens;
}

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

// Of a point that is at source = normalised coordinates times z, by a depth map. The lengths of
// source are such that 1 is the largest sample of the map.
float visibility_by(float map, vec3 source, float inverse_depth) {
  vec2 pixel = intrinsics.xy * (source.xy / source.z) + intrinsics.zw;
  vec2 at = (pixel + 0.5) * picture.w * map_texel_size;
  vec2 least = 0.5 * map_texel_size;
  vec2 most = (picture.xy + 1.0) * picture.w * map_texel_size - least;
  float seen = textureLod(maps, vec3(clamp(at, least, most), map), 0.0).r;
  return map < 0.0 || inverse_depth <= 0.0 ? 1.0 : visibility(seen, inverse_depth / source.z);
}
#endif

// Weight of layer i after feathering at a place from the middle of the view; 0 where it shows
// nothing. With SHAPE, `near` is its closeness there.
float seen(int i, vec2 place, float inverse_depth, out vec2 pixel, out float near) {
  vec3 source = layers[i].from_x.xyz * place.x + layers[i].from_y.xyz * place.y +
                layers[i].from_1.xyz;
  near = 1.0;
#ifdef SHAPE
  vec3 ray_of_view = source;
  source += inverse_depth * layers[i].beyond.xyz;
  near = closeness(ray_of_view, source) * visibility_by(layers[i].beyond.w, source, inverse_depth);
#endif
  pixel = source.xy / source.z;
#ifdef DISTORTION
  bool folded = dot(pixel, pixel) >= lens.y;
  pixel = pixel_of(pixel, intrinsics, distortion, lens.x, lens.z > 0.5);
#elif defined(SHAPE)
  pixel = intrinsics.xy * pixel + intrinsics.zw;
#endif
  vec2 fade = clamp(min(pixel, picture.xy - pixel) * picture.z, 0.0, 1.0);
  fade = fade * fade * (3.0 - 2.0 * fade);
  float weight = layers[i].from_y.w * fade.x * fade.y;
#ifdef DISTORTION
  if (folded) weight = 0.0;
#endif
#ifdef HORIZON
  if (source.z <= 0.0) weight = 0.0;
#ifndef SHAPE
  if (dot(layers[i].beyond.xyz, vec3(place, 1.0)) <= 0.0) weight = 0.0;
#endif
#endif
  return weight;
}

// Light that a layer shows.
vec3 light_at(int i, vec2 pixel) {
  vec2 at = (pixel + 0.5) * texel_size;
  return layers[i].from_1.w * light_of(textureLod(pictures, vec3(at, layers[i].from_x.w), 0.0).rgb);
}

void main() {
  vec2 place = gl_FragCoord.xy - middle;
  vec3 sum = vec3(0.0);
  float depth = 0.0;
#ifdef SHAPE
  depth = textureLod(inverse_depths, gl_FragCoord.xy * cells.xy + cells.zw, 0.0).r;
#endif
#ifdef SMALL_APERTURE
  float transmittance = 1.0;
#else
  float total = 0.0;
  float near_total = 0.0;
#endif
  use_camera_of(0);
#ifdef TILES
  ivec2 tile = ivec2(gl_FragCoord.xy) / tile_size;
  for (int j = 0;; ++j) {
    int i = int(texelFetch(lists, ivec2(j, tile.y * tiles_across + tile.x), 0).r);
    if (i == END_OF_LIST) break;
#else
  for (int i = 0; i < layer_count; ++i) {
#endif
#ifndef ONE_CAMERA
    use_camera_of(i);
#endif
    vec2 pixel;
    float near;
    float weight = seen(i, place, depth, pixel, near);
    vec3 light = light_at(i, pixel);
    // What is hidden may be infinite: nothing is multiplied by its weight of 0.
#ifdef SMALL_APERTURE
    if (weight > 0.0) {
      sum += transmittance * weight * light;
      transmittance *= 1.0 - weight;
    }
    if (transmittance <= stop) break;
#else
    if (weight > 0.0) {
      sum += near * weight * light;
      near_total += near * weight;
      total += weight;
    }
#endif
  }
#ifndef SMALL_APERTURE
  float covered = total / max(total, least_total_weight);
  sum = near_total > 0.0 ? sum * (covered / near_total) : vec3(0.0);
#endif
  color = vec4(stored_of(sum), 1.0);
}
