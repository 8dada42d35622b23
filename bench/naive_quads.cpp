#include "bench/naive_quads.h"

#include <Eigen/LU>
#include <cmath>
#include <ranges>

#include "render/blending.h"

namespace lumibox::bench {
namespace {

/// A quad whose corners are the picture's outermost pixel centres. The homography's third
/// coordinate is that of the clip space, so the GL divides by it and textures are in perspective.
const render::gl::ShaderText kVertexShader{"quad.vert", R"(
uniform mat3 clip_from_source;  // (x, y, w), from pixels of the picture
uniform vec2 last_pixel;        // width - 1, height - 1
out vec2 at;
void main() {
  vec2 pixel = vec2(gl_VertexID & 1, gl_VertexID >> 1) * last_pixel;
  at = (pixel + 0.5) / (last_pixel + 1.0);
  vec3 clip = clip_from_source * vec3(pixel, 1.0);
  gl_Position = vec4(clip.xy, 0.0, clip.z);
}
)"};

const render::gl::ShaderText kFragmentShader{"quad.frag", R"(
uniform sampler2D picture;  // alpha: the faded border
uniform float alpha;
uniform bool light;
in vec2 at;
out vec4 color;
void main() {
  color = texture(picture, at) * vec4(1.0, 1.0, 1.0, alpha);
  if (light) {
    color.rgb = mix(color.rgb / 12.92, pow((color.rgb + 0.055) / 1.055, vec3(2.4)),
                    vec3(greaterThan(color.rgb, vec3(0.04045))));
  }
}
)"};

/// Clip coordinates (x, y, w) of a pixel: first centre at 0, rows down.
Eigen::Matrix3d clip_from_pixel(const geometry::Camera& camera) {
  const double width = camera.width();
  const double height = camera.height();
  Eigen::Matrix3d m;
  m << 2.0 / width, 0.0, 1.0 / width - 1.0, 0.0, -2.0 / height, 1.0 - 1.0 / height, 0.0, 0.0, 1.0;
  return m;
}

}  // namespace

NaiveQuads::NaiveQuads(Blending blending)
    : program_(render::gl::make_program(kVertexShader, kFragmentShader)),
      clip_from_source_(render::gl::uniform(program_, "clip_from_source")),
      last_pixel_(render::gl::uniform(program_, "last_pixel")),
      alpha_(render::gl::uniform(program_, "alpha")),
      vertex_array_(render::gl::make_vertex_array()) {
  glUseProgram(program_.name());
  glUniform1i(render::gl::uniform(program_, "picture"), 0);
  glUniform1i(render::gl::uniform(program_, "light"), blending == Blending::Light ? 1 : 0);
}

void NaiveQuads::draw(const render::View& view,
                      const std::vector<lightfield::Perspective>& perspectives,
                      const render::Settings& settings, unsigned framebuffer) {
  render::gl::begin(framebuffer, view.camera.width(), view.camera.height(),
                    render::gl::Blend::Over);
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  glUseProgram(program_.name());
  glBindVertexArray(vertex_array_.name());
  glActiveTexture(GL_TEXTURE0);
  const std::vector<render::Layer> layers = render::plan_view(view, perspectives, settings);
  for (const render::Layer& layer : layers | std::views::reverse) {
    if (layer.weight <= 0.0) continue;
    const lightfield::Perspective& perspective = perspectives[layer.perspective];
    const Eigen::Matrix3d source_from_pixel =
        perspective.camera->pinhole_matrix() * layer.source_from_pixel;
    const Eigen::Matrix3f clip_from_source =
        (clip_from_pixel(view.camera) * source_from_pixel.inverse()).cast<float>();
    glBindTexture(GL_TEXTURE_2D, texture_of(perspective, settings.feather_px).name());
    glUniformMatrix3fv(clip_from_source_, 1, GL_FALSE, clip_from_source.data());
    glUniform2f(last_pixel_, static_cast<float>(perspective.photo->width() - 1),
                static_cast<float>(perspective.photo->height() - 1));
    glUniform1f(alpha_, static_cast<float>(layer.weight));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
}

const render::gl::Texture& NaiveQuads::texture_of(const lightfield::Perspective& perspective,
                                                  double feather_px) {
  const auto [known, is_new] = textures_.try_emplace(perspective.id);
  if (!is_new) return known->second;
  const std::shared_ptr<const hal::Image> pixels = perspective.photo->require_rgb();
  const hal::Image& picture = *pixels;
  const int width = picture.width();
  const int height = picture.height();
  std::vector<std::uint8_t> rgba;
  rgba.reserve(picture.size_bytes() / 3 * 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* rgb = picture.at(x, y);
      const double fade = render::feather(Eigen::Vector2d(x, y), width, height, feather_px);
      rgba.insert(rgba.end(),
                  {rgb[0], rgb[1], rgb[2], static_cast<std::uint8_t>(std::lround(255.0 * fade))});
    }
  }
  known->second = render::gl::make_texture(GL_TEXTURE_2D);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               rgba.data());
  return known->second;
}

}  // namespace lumibox::bench
