// Lines and discs: triangles in pixels, each corner knowing where it lies across its stroke.
layout(location = 0) in vec2 position;  // pixels from the top left corner
layout(location = 1) in vec2 across;    // pixels from the centre line, or from the disc's centre
layout(location = 2) in float half_width;
layout(location = 3) in vec4 tint;

uniform vec2 screen_size;

out vec2 from_center;
out float reach;
out vec4 stroke_color;

void main() {
  from_center = across;
  reach = half_width;
  stroke_color = tint;
  vec2 clip = 2.0 * (position + 0.5) / screen_size - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}
