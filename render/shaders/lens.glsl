// Pixel of undistorted normalised coordinates: the lenses of geometry::Camera.
// intrinsics = fx fy cx cy; distortion = k1 k2 p1 p2 with k3 in `more`, or of a fisheye lens
// k1 k2 k3 k4.
vec2 pixel_of(vec2 n, vec4 intrinsics, vec4 distortion, float more, bool fisheye) {
  float r2 = dot(n, n);
  if (fisheye) {
    float r = max(sqrt(r2), 1e-6);  // there the factor is 1 in single precision
    float theta = atan(r);
    float t2 = theta * theta;
    float factor = 1.0 + t2 * (distortion.x + t2 * (distortion.y + t2 * (distortion.z + t2 * distortion.w)));
    return intrinsics.xy * n * (factor * theta / r) + intrinsics.zw;
  }
  float radial = 1.0 + r2 * (distortion.x + r2 * (distortion.y + r2 * more));
  vec2 tangential = 2.0 * n.x * n.y * distortion.zw + distortion.wz * (r2 + 2.0 * n * n);
  return intrinsics.xy * (n * radial + tangential) + intrinsics.zw;
}
