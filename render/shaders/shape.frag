// Coverage of the pixel by a stroke or disc whose edge lies `reach` from its centre.
in vec2 from_center;
in float reach;
in vec4 stroke_color;

out vec4 color;

void main() {
  float coverage = clamp(reach + 0.5 - length(from_center), 0.0, 1.0);
  color = vec4(stroke_color.rgb, stroke_color.a * coverage);
}
