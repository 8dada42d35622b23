// The light field of thesis 3: at each pixel a loop over the layers, nearest first.
// SMALL_APERTURE blends "over" from the front and stops where nothing behind can be seen any more;
// otherwise the layers' weighted mean. SHAPE where pictures are projected onto the scene's shape
// instead of planes; DISTORTION where any source has a lens that distorts; HORIZON where something
// that a ray meets may lie behind the view or a source; ONE_CAMERA where all sources have the same
// camera; TILES where each tile of the view has a list of the layers that show something there; NEAR where the
// first of them come interpolated. What is not needed is not loaded: on a software GPU loads take their time.

uniform int layer_count;
uniform vec2 middle;               // of the view, as gl_FragCoord
uniform vec2 texel_size;           // 1 / size of the texture array
uniform float least_total_weight;  // smallest divisor of a mean
uniform float stop;                // small aperture: transmittance at which a pixel is done
uniform sampler2DArray pictures;
#ifdef TILES
flat in int list;  // what comes after the near layers
#endif
#ifdef NEAR
in vec4 near_source[NEAR];           // homogeneous, as layers have it; slot
flat in vec4 near_weight[NEAR / 2];  // weight and gain of two
flat in int near_count;
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

// The pixel that a source lies at, in the picture at hand, and how much of its weight is left there: less towards
// the border, and nothing beyond the lens' fold.
float share_at(vec3 source, out vec2 pixel) {
  pixel = source.xy / source.z;
#ifdef DISTORTION
  bool folded = dot(pixel, pixel) >= lens.y;
  pixel = pixel_of(pixel, intrinsics, distortion, lens.x, lens.z > 0.5);
#elif defined(SHAPE)
  pixel = intrinsics.xy * pixel + intrinsics.zw;
#endif
  vec2 fade = clamp(min(pixel, picture.xy - pixel) * picture.z, 0.0, 1.0);
  fade = fade * fade * (3.0 - 2.0 * fade);
#ifdef DISTORTION
  if (folded) return 0.0;
#endif
  return fade.x * fade.y;
}

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
  float weight = layers[i].from_y.w * share_at(source, pixel);
#ifdef HORIZON
  if (source.z <= 0.0) weight = 0.0;
#ifndef SHAPE
  if (dot(layers[i].beyond.xyz, vec3(place, 1.0)) <= 0.0) weight = 0.0;
#endif
#endif
  return weight;
}

// Light that a picture shows.
vec3 light_at(float slot, vec2 pixel) {
  vec2 at = (pixel + 0.5) * texel_size;
  return light_of(textureLod(pictures, vec3(at, slot), 0.0).rgb);
}

#ifdef SMALL_APERTURE
vec3 sum = vec3(0.0);
float transmittance = 1.0;

// What is hidden may be infinite: nothing is multiplied by its weight of 0.
void put_behind(float weight, vec3 light) {
  if (weight > 0.0) {
    sum += transmittance * weight * light;
    transmittance *= 1.0 - weight;
  }
}
#endif

#ifdef NEAR
void put_near_behind(vec4 source, vec2 weight_and_gain) {
  vec2 pixel;
  float weight = weight_and_gain.x * share_at(source.xyz, pixel);
  put_behind(weight, weight_and_gain.y * light_at(source.w, pixel));
}
#endif

void main() {
  vec2 place = gl_FragCoord.xy - middle;
  float depth = 0.0;
#ifdef SHAPE
  depth = textureLod(inverse_depths, gl_FragCoord.xy * cells.xy + cells.zw, 0.0).r;
#endif
#ifndef SMALL_APERTURE
  vec3 sum = vec3(0.0);
  float total = 0.0;
  float near_total = 0.0;
#endif
  use_camera_of(0);
#ifdef NEAR
  for (int n = 0; n < near_count; n += 4) {
    bool first = n == 0;
    put_near_behind(first ? near_source[0] : near_source[4], first ? near_weight[0].xy : near_weight[2].xy);
    put_near_behind(first ? near_source[1] : near_source[5], first ? near_weight[0].zw : near_weight[2].zw);
    put_near_behind(first ? near_source[2] : near_source[6], first ? near_weight[1].xy : near_weight[3].xy);
    put_near_behind(first ? near_source[3] : near_source[7], first ? near_weight[1].zw : near_weight[3].zw);
    if (transmittance <= stop) break;
  }
#endif
#ifdef TILES
  for (int j = list; transmittance > stop; ++j) {
    int i = entry_of(j);
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
    vec3 light = layers[i].from_1.w * light_at(layers[i].from_x.w, pixel);
#ifdef SMALL_APERTURE
    put_behind(weight, light);
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
#ifdef SMALL_APERTURE
  float covered = 1.0 - transmittance;
#endif
  color = vec4(stored_of(sum), covered);
}
