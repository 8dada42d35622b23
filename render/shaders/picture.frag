// A camera's picture without the distortion of its lens, seen through the pinhole of a view.
uniform vec4 ray_from_fragment;  // ray.xy = fragment.xy * xy + zw
uniform vec4 intrinsics;         // fx fy cx cy
uniform vec4 distortion;         // as pixel_of() has it
uniform vec3 k3_fold_opacity;    // k3, squared radius of the fold, opacity
uniform bool fisheye;
uniform sampler2D picture;

out vec4 color;

void main() {
  vec2 ray = gl_FragCoord.xy * ray_from_fragment.xy + ray_from_fragment.zw;
  vec2 pixel = pixel_of(ray, intrinsics, distortion, k3_fold_opacity.x, fisheye);
  vec2 size = vec2(textureSize(picture, 0));
  bool inside = dot(ray, ray) < k3_fold_opacity.y && all(greaterThan(pixel, vec2(-0.5))) &&
                all(lessThan(pixel, size - 0.5));
  vec3 seen = textureLod(picture, (pixel + 0.5) / size, 0.0).rgb;
  color = vec4(inside ? seen : vec3(0.0), k3_fold_opacity.z);
}
