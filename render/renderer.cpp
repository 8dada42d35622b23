#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>

#include "render/blending.h"
#include "render/depth_grid.h"
#include "render/gl.h"
#include "render/map_cache.h"
#include "render/picture_cache.h"
#include "render/shader_source.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

/// `Layer` of light_field.frag, std140.
struct LayerUniforms {
  std::array<float, 4> from_x, from_y, from_1;
  std::array<float, 4> picture;
  std::array<float, 4> blend;
  std::array<float, 4> intrinsics;
  std::array<float, 4> distortion;
  std::array<float, 4> shift;
};
static_assert(sizeof(LayerUniforms) * kMaxLayers <= 16384, "the least that ES 3 promises");

std::array<float, 4> vec4(double x, double y, double z, double w) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
          static_cast<float>(w)};
}

/// Pixel of the view (first centre at 0, rows down) from gl_FragCoord (at 0.5, rows up).
Eigen::Matrix3d pixel_from_fragment(int height) {
  Eigen::Matrix3d m;
  m << 1.0, 0.0, -0.5, 0.0, -1.0, height - 0.5, 0.0, 0.0, 1.0;
  return m;
}

/// What the fragment shader is compiled for.
struct Kind {
  bool small_aperture = false;
  bool distortion = false;
  bool shape = false;

  std::size_t index() const {
    return (small_aperture ? 4U : 0U) + (distortion ? 2U : 0U) + (shape ? 1U : 0U);
  }
};

/// Length in which the shader has inverse depths, so that half precision serves.
double unit_of(const View& view, const Settings& settings) {
  const double distance = (settings.focus - view.world_from_camera.translation).norm();
  return distance > 0.0 ? distance : 1.0;
}

/// Where a layer's pictures are on the GPU.
struct Slots {
  int picture = 0;
  std::optional<MapCache::Slot> map;
};

LayerUniforms uniforms_of(const Layer& layer, const Perspective& perspective, const View& view,
                          const Kind& kind, const Slots& slots, const Settings& settings) {
  const config::CameraProfile& c = perspective.camera->profile();
  Eigen::Matrix<double, 4, 3> m;
  m.topRows<3>() = layer.source_from_pixel;
  if (!kind.distortion && !kind.shape) {
    m.topRows<3>() = perspective.camera->pinhole_matrix() * layer.source_from_pixel;
  }
  m.row(3) = layer.before_view.transpose();
  m = m * pixel_from_fragment(view.camera.height());

  const int width = perspective.color->width();
  const int height = perspective.color->height();
  const double fold = std::min(perspective.camera->fold_radius2(),
                               static_cast<double>(std::numeric_limits<float>::max()));
  LayerUniforms u;
  u.from_x = vec4(m(0, 0), m(1, 0), m(2, 0), m(3, 0));
  u.from_y = vec4(m(0, 1), m(1, 1), m(2, 1), m(3, 1));
  u.from_1 = vec4(m(0, 2), m(1, 2), m(2, 2), m(3, 2));
  u.picture = vec4(width - 1, height - 1, slots.picture,
                   1.0 / feather_width(width, height, settings.feather_px));
  const bool fisheye = c.model == config::LensModel::Fisheye;
  u.blend = vec4(layer.weight, c.k3, fold, fisheye ? 1.0 : 0.0);
  u.intrinsics = vec4(c.fx, c.fy, c.cx, c.cy);
  const Eigen::Vector3d shift = layer.shift / unit_of(view, settings);
  u.shift = vec4(shift.x(), shift.y(), shift.z(), 0.0);
  if (kind.shape) {
    const double size = slots.map ? layer.map->camera.profile().fx / c.fx : 0.0;
    const double largest = slots.map ? slots.map->largest * unit_of(view, settings) : 0.0;
    u.from_x[3] = slots.map ? static_cast<float>(slots.map->index) : 0.0F;
    u.from_y[3] = static_cast<float>(size);
    u.from_1[3] = static_cast<float>(largest);
  }
  u.distortion = fisheye ? vec4(c.k1, c.k2, c.k3, c.k4) : vec4(c.k1, c.k2, c.p1, c.p2);
  return u;
}

/// light_field.frag in one of its variants.
struct Variant {
  gl::Program program;
  GLint layer_count = -1;
  GLint texel_size = -1;
  GLint least_total_weight = -1;
  GLint stop = -1;
  GLint cells = -1;
  GLint map_texel_size = -1;

  explicit Variant(const Kind& kind) {
    std::string prelude = "#define MAX_LAYERS " + std::to_string(kMaxLayers) + "\n";
    if (kind.small_aperture) prelude += "#define SMALL_APERTURE\n";
    if (kind.distortion) prelude += "#define DISTORTION\n";
    if (kind.shape) {
      prelude += "#define SHAPE\n#define FARTHER_PENALTY " + std::to_string(kFartherPenalty) +
                 "\n#define LEAST_PENALTY " + std::to_string(kLeastPenalty) + "\n#define BEFORE " +
                 std::to_string(kBefore) + "\n#define HIDING " + std::to_string(kHiding) +
                 "\n#define HIDDEN " + std::to_string(kHidden) + "\n";
    }
    prelude += shader_source("lens.glsl");
    program = gl::make_program("screen.vert", "light_field.frag", prelude);
    layer_count = gl::uniform(program, "layer_count");
    texel_size = gl::uniform(program, "texel_size");
    least_total_weight = gl::uniform(program, "least_total_weight");
    stop = gl::uniform(program, "stop");
    glUniformBlockBinding(program.name(), glGetUniformBlockIndex(program.name(), "Layers"), 0);
    glUseProgram(program.name());
    glUniform1i(gl::uniform(program, "pictures"), 0);
    if (kind.shape) {
      cells = gl::uniform(program, "cells");
      map_texel_size = gl::uniform(program, "map_texel_size");
      glUniform1i(gl::uniform(program, "inverse_depths"), 1);
      glUniform1i(gl::uniform(program, "maps"), 2);
    }
  }
};

}  // namespace

class Renderer::Impl {
 public:
  Impl() : vertex_array_(gl::make_vertex_array()), uniforms_(gl::make_buffer()) {
    glBindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(LayerUniforms) * kMaxLayers, nullptr, GL_DYNAMIC_DRAW);
  }

  void draw(const View& view, const std::vector<Perspective>& perspectives,
            const Settings& settings, unsigned framebuffer) {
    std::vector<Layer> layers = plan_view(view, perspectives, settings);
    const std::size_t planned = layers.size();
    std::erase_if(layers, [](const Layer& layer) { return layer.weight <= 0.0; });
    Kind kind;
    kind.shape = settings.shape != nullptr;
    kind.small_aperture = settings.aperture == Aperture::Small && !kind.shape;
    kind.distortion = std::any_of(layers.begin(), layers.end(), [&](const Layer& layer) {
      return perspectives[layer.perspective].camera->has_distortion();
    });
    fill_uniforms(layers, perspectives, view, kind, settings);

    gl::begin(framebuffer, view.camera.width(), view.camera.height(), gl::Blend::Replace);
    const Variant& variant = variant_for(kind);
    glUseProgram(variant.program.name());
    glUniform1i(variant.layer_count, static_cast<GLint>(layers.size()));
    glUniform2f(variant.texel_size, 1.0F / static_cast<float>(std::max(1, cache_.width())),
                1.0F / static_cast<float>(std::max(1, cache_.height())));
    glUniform1f(variant.least_total_weight,
                static_cast<float>(least_total_weight(planned, kind.shape)));
    glUniform1f(variant.stop, static_cast<float>(settings.small_aperture_stop));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.name());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, cache_.texture());
    if (kind.shape) bind_shape(view, settings, variant);
    glBindVertexArray(vertex_array_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  void upload(const Perspective& perspective) {
    const hal::Image& picture = *perspective.color;
    cache_.begin_view(1, picture.width(), picture.height());
    cache_.slot_of(perspective.color);
  }

 private:
  void fill_uniforms(const std::vector<Layer>& layers, const std::vector<Perspective>& perspectives,
                     const View& view, const Kind& kind, const Settings& settings) {
    if (layers.empty()) return;
    int width = 0;
    int height = 0;
    for (const Layer& layer : layers) {
      width = std::max(width, perspectives[layer.perspective].color->width());
      height = std::max(height, perspectives[layer.perspective].color->height());
    }
    cache_.begin_view(layers.size(), width, height);
    std::vector<const DepthMap*> maps;
    for (const Layer& layer : layers) maps.push_back(layer.map.get());
    if (kind.shape) maps_.begin_view(maps);

    std::vector<LayerUniforms> data;
    for (const Layer& layer : layers) {
      const Perspective& perspective = perspectives[layer.perspective];
      Slots slots{cache_.slot_of(perspective.color), std::nullopt};
      if (layer.map) slots.map = maps_.slot_of(layer.map);
      data.push_back(uniforms_of(layer, perspective, view, kind, slots, settings));
    }
    glBindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    glBufferSubData(GL_UNIFORM_BUFFER, 0,
                    static_cast<GLsizeiptr>(data.size() * sizeof(LayerUniforms)), data.data());
  }

  void bind_shape(const View& view, const Settings& settings, const Variant& variant) {
    const DepthGrid& shape = settings.shape->grid;
    std::vector<float> scaled = shape.inverse_depths();
    for (float& value : scaled) value *= static_cast<float>(unit_of(view, settings));
    glActiveTexture(GL_TEXTURE1);
    if (shape_.name() == 0) shape_ = gl::make_texture(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, shape_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R16F, shape.columns(), shape.rows(), 0, GL_RED, GL_FLOAT,
                 scaled.data());
    // Corner i lies at pixel i * cell, in the middle of texel i; fragment rows go up.
    const double cell = shape.cell();
    const double last_row = view.camera.height() - 0.5;
    glUniform4f(variant.cells, static_cast<float>(1.0 / (cell * shape.columns())),
                static_cast<float>(-1.0 / (cell * shape.rows())),
                static_cast<float>((0.5 - 0.5 / cell) / shape.columns()),
                static_cast<float>((0.5 + last_row / cell) / shape.rows()));
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D_ARRAY, maps_.texture());
    glUniform2f(variant.map_texel_size, 1.0F / static_cast<float>(std::max(1, maps_.width())),
                1.0F / static_cast<float>(std::max(1, maps_.height())));
    glActiveTexture(GL_TEXTURE0);
  }

  /// Compiled when first needed.
  const Variant& variant_for(const Kind& kind) {
    std::optional<Variant>& variant = variants_[kind.index()];
    if (!variant) variant.emplace(kind);
    return *variant;
  }

  gl::VertexArray vertex_array_;
  gl::Buffer uniforms_;
  PictureCache cache_;
  MapCache maps_;
  gl::Texture shape_;  ///< inverse depths of the view drawn last
  std::array<std::optional<Variant>, 8> variants_;
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

void Renderer::draw(const View& view, const std::vector<Perspective>& perspectives,
                    const Settings& settings, unsigned framebuffer) {
  impl_->draw(view, perspectives, settings, framebuffer);
}

void Renderer::upload(const Perspective& perspective) {
  impl_->upload(perspective);
}

}  // namespace lumibox::render
