// Pixel of undistorted normalised coordinates: the OPENCV model of geometry::Camera.
// intrinsics = fx fy cx cy, distortion = k1 k2 p1 p2.
vec2 pixel_of(vec2 n, vec4 intrinsics, vec4 distortion, float k3) {
  float r2 = dot(n, n);
  float radial = 1.0 + r2 * (distortion.x + r2 * (distortion.y + r2 * k3));
  vec2 tangential = 2.0 * n.x * n.y * distortion.zw + distortion.wz * (r2 + 2.0 * n * n);
  return intrinsics.xy * (n * radial + tangential) + intrinsics.zw;
}
