// Blending is of light, not of stored values (sRGB, IEC 61966-2-1). A polynomial within 0.7 of a level of it
// is several times cheaper than its power; stored_of() is the inverse of that polynomial to
// a hundredth of a level, so that what is not blended comes out as it was.
vec3 light_of(vec3 stored) {
  return stored * (0.06022986 + stored * (0.34755999 + stored * (0.95054849 - 0.36420253 * stored)));
}

vec3 stored_of(vec3 light) {
  light = max(light, 0.0);
  vec3 near = mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055,
                  vec3(greaterThan(light, vec3(0.0031308))));
  // One step of Newton's method.
  vec3 slope = 0.06022986 + near * (0.69511998 + near * (2.85164547 - 1.45681012 * near));
  return near - (light_of(near) - light) / slope;
}
