// Glyphs: two triangles each, corners in pixels of the screen and of the atlas.
layout(location = 0) in vec2 position;  // pixels from the top left corner
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 tint;

uniform vec2 screen_size;
uniform vec2 atlas_size;

out vec2 at;
out vec4 glyph_color;

void main() {
  at = texel / atlas_size;
  glyph_color = tint;
  vec2 clip = 2.0 * position / screen_size - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}
