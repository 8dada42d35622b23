#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "render/blending.h"
#include "render/depth_grid.h"
#include "render/depth_map.h"
#include "render/gl.h"
#include "render/layer_uniforms.h"
#include "render/map_cache.h"
#include "render/picture_supply.h"
#include "render/shader_source.h"
#include "render/tiles.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

/// light_field.frag in one of its variants.
struct Variant {
  gl::Program program;
  GLint layer_count = -1;
  GLint middle = -1;
  GLint texel_size = -1;
  GLint least_total_weight = -1;
  GLint stop = -1;
  GLint cells = -1;
  GLint map_texel_size = -1;
  GLint tile_size = -1;
  GLint tiles_across = -1;

  explicit Variant(const Kind& kind) {
    std::string prelude = "#define MAX_LAYERS " + std::to_string(kMaxLayers) + "\n";
    if (kind.small_aperture) prelude += "#define SMALL_APERTURE\n";
    if (kind.distortion) prelude += "#define DISTORTION\n";
    if (kind.horizon) prelude += "#define HORIZON\n";
    if (kind.one_camera) prelude += "#define ONE_CAMERA\n";
    if (kind.tiles()) {
      prelude += "#define TILES\n#define END_OF_LIST " + std::to_string(Tiles::kEnd) + "\n";
    }
    if (kind.shape) {
      prelude += "#define SHAPE\n#define FARTHER_PENALTY " + std::to_string(kFartherPenalty) +
                 "\n#define LEAST_PENALTY " + std::to_string(kLeastPenalty) + "\n#define BEFORE " +
                 std::to_string(kBefore) + "\n#define HIDING " + std::to_string(kHiding) +
                 "\n#define HIDDEN " + std::to_string(kHidden) + "\n";
    }
    prelude += shader_source("lens.glsl");
    prelude += shader_source("light.glsl");
    program = gl::make_program("screen.vert", "light_field.frag", prelude);
    layer_count = gl::uniform(program, "layer_count");
    middle = gl::uniform(program, "middle");
    texel_size = gl::uniform(program, "texel_size");
    least_total_weight = gl::uniform(program, "least_total_weight");
    stop = gl::uniform(program, "stop");
    glUniformBlockBinding(program.name(), glGetUniformBlockIndex(program.name(), "Layers"), 0);
    glUseProgram(program.name());
    glUniform1i(gl::uniform(program, "pictures"), 0);
    if (kind.tiles()) {
      tile_size = gl::uniform(program, "tile_size");
      tiles_across = gl::uniform(program, "tiles_across");
      glUniform1i(gl::uniform(program, "lists"), 3);
    }
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
  Impl(const config::Render& options, ReadAhead* ahead)
      : options_(options),
        supply_(options, ahead),
        vertex_array_(gl::make_vertex_array()),
        uniforms_(gl::make_buffer()) {
    glBindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(LayerUniforms) * kMaxLayers, nullptr, GL_DYNAMIC_DRAW);
  }

  void draw(const View& view, const std::vector<Perspective>& perspectives,
            const Settings& settings, unsigned framebuffer, const std::optional<Rows>& rows) {
    const SuppliedView supplied = supply_.supply(view, perspectives, settings);
    const LayerData data = fill_uniforms(supplied, perspectives, view, settings);
    draw_layers(data, supplied, view, settings, framebuffer, rows);
  }

  void upload(const Perspective& perspective) { supply_.upload(perspective); }

  void prepare(const View& view, const std::shared_ptr<const geometry::Camera>& source,
               unsigned framebuffer) {
    Perspective black;
    black.world_from_camera = view.world_from_camera;
    black.camera = source;
    black.photo = std::make_shared<lightfield::Photo>(
        std::make_shared<const hal::Image>(source->width(), source->height(), 3));
    const Eigen::Vector3d focus = view.world_from_camera * Eigen::Vector3d::UnitZ().eval();
    for (const Settings& settings : all_settings(view, black, focus)) {
      const SuppliedView supplied = supply_.supply(view, {black}, settings);
      LayerData data = fill_uniforms(supplied, {black}, view, settings);
      for (const bool horizon : {false, true}) {
        data.kind.horizon = horizon;  // what the place of a view decides
        draw_layers(data, supplied, view, settings, framebuffer, std::nullopt);
      }
    }
  }

 private:
  /// Of each aperture on planes, and on a shape: one that is everywhere as far as the focus.
  std::vector<Settings> all_settings(const View& view, const Perspective& perspective,
                                     const Eigen::Vector3d& focus) const {
    std::vector<Settings> all = {settings_from(options_, Aperture::Small, focus),
                                 settings_from(options_, Aperture::Wide, focus),
                                 settings_from(options_, Aperture::Small, focus)};
    const auto map = estimate_depth(perspective, {}, focus);
    if (!map) return all;
    all.back().shape = std::make_shared<Shape>(DepthGrid(view, {}, 1.0),
                                               std::vector{std::make_shared<const DepthMap>(*map)});
    return all;
  }

  void draw_layers(const LayerData& data, const SuppliedView& supplied, const View& view,
                   const Settings& settings, unsigned framebuffer,
                   const std::optional<Rows>& rows) {
    const Kind& kind = data.kind;
    const PictureCache& pictures = supply_.cache();
    gl::begin(framebuffer, view.camera.width(), view.camera.height(), gl::Blend::Replace);
    const Variant& variant = variant_for(kind);
    glUseProgram(variant.program.name());
    glUniform1i(variant.layer_count, static_cast<GLint>(supplied.layers.size()));
    const Eigen::Vector2f middle = middle_of(view).cast<float>();
    glUniform2f(variant.middle, middle.x(), middle.y());
    glUniform2f(variant.texel_size, 1.0F / static_cast<float>(std::max(1, pictures.width())),
                1.0F / static_cast<float>(std::max(1, pictures.height())));
    glUniform1f(variant.least_total_weight,
                static_cast<float>(least_total_weight(supplied.planned, kind.shape)));
    glUniform1f(variant.stop, static_cast<float>(settings.small_aperture_stop));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.name());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, pictures.texture());
    if (kind.shape) bind_shape(view, settings, variant);
    if (kind.tiles()) bind_tiles(tiles_of(view, data), variant);
    glBindVertexArray(vertex_array_.name());
    if (rows) {
      glEnable(GL_SCISSOR_TEST);  // gl::begin() disables it
      glScissor(0, rows->first, view.camera.width(), rows->count);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  /// Brings the layers' data to the GPU, with the depth maps that are not there.
  LayerData fill_uniforms(const SuppliedView& supplied,
                          const std::vector<Perspective>& perspectives, const View& view,
                          const Settings& settings) {
    std::vector<LayerSlots> slots;
    if (settings.shape) {
      std::vector<const DepthMap*> maps;
      for (const Layer& layer : supplied.layers) maps.push_back(layer.map.get());
      maps_.begin_view(maps);
    }
    for (std::size_t i = 0; i < supplied.layers.size(); ++i) {
      slots.push_back({supplied.slots[i]});
      const Layer& layer = supplied.layers[i];
      if (!layer.map) continue;
      const MapCache::Slot map = maps_.slot_of(layer.map);
      slots.back().map = map.index;
      if (map.largest > 0.0) slots.back().largest_map = map.largest;
    }
    LayerData data = layer_data(view, perspectives, settings, supplied.layers, slots);
    glBindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    glBufferSubData(GL_UNIFORM_BUFFER, 0,
                    static_cast<GLsizeiptr>(data.layers.size() * sizeof(LayerUniforms)),
                    data.layers.data());
    return data;
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

  void bind_tiles(const Tiles& tiles, const Variant& variant) {
    glActiveTexture(GL_TEXTURE3);
    if (lists_.name() == 0) {
      lists_ = gl::make_texture(GL_TEXTURE_2D);
      // Whole numbers are not filtered.
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    glBindTexture(GL_TEXTURE_2D, lists_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8UI, static_cast<GLsizei>(tiles.row),
                 tiles.across * tiles.down, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                 tiles.lists.data());
    glUniform1i(variant.tile_size, tiles.size);
    glUniform1i(variant.tiles_across, tiles.across);
    glActiveTexture(GL_TEXTURE0);
  }

  /// Compiled when first needed.
  const Variant& variant_for(const Kind& kind) {
    std::optional<Variant>& variant = variants_[kind.index()];
    if (!variant) variant.emplace(kind);
    return *variant;
  }

  config::Render options_;
  PictureSupply supply_;
  gl::VertexArray vertex_array_;
  gl::Buffer uniforms_;
  MapCache maps_;
  gl::Texture shape_;  ///< inverse depths of the view drawn last
  gl::Texture lists_;  ///< of the tiles of the view drawn last
  std::array<std::optional<Variant>, Kind::kCount> variants_;
};

Renderer::Renderer(const config::Render& options, ReadAhead* ahead)
    : impl_(std::make_unique<Impl>(options, ahead)) {}
Renderer::~Renderer() = default;

void Renderer::draw(const View& view, const std::vector<Perspective>& perspectives,
                    const Settings& settings, unsigned framebuffer, std::optional<Rows> rows) {
  impl_->draw(view, perspectives, settings, framebuffer, rows);
}

void Renderer::prepare(const View& view, const std::shared_ptr<const geometry::Camera>& source,
                       unsigned framebuffer) {
  impl_->prepare(view, source, framebuffer);
}

void Renderer::upload(const Perspective& perspective) {
  impl_->upload(perspective);
}

}  // namespace lumibox::render
