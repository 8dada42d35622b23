// The atlas holds how much of each texel the glyph covers.
in vec2 at;
in vec4 glyph_color;

uniform sampler2D atlas;

out vec4 color;

void main() {
  color = vec4(glyph_color.rgb, glyph_color.a * textureLod(atlas, at, 0.0).r);
}
