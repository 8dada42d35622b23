#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "render/blending.h"
#include "render/depth_grid.h"
#include "render/gl.h"
#include "render/layer_uniforms.h"
#include "render/map_cache.h"
#include "render/picture_cache.h"
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
  Impl() : vertex_array_(gl::make_vertex_array()), uniforms_(gl::make_buffer()) {
    glBindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(LayerUniforms) * kMaxLayers, nullptr, GL_DYNAMIC_DRAW);
  }

  void draw(const View& view, const std::vector<Perspective>& perspectives,
            const Settings& settings, unsigned framebuffer, const std::optional<Rows>& rows) {
    const Plan plan = plan_with_pictures(view, perspectives, settings);
    const std::vector<Layer>& layers = plan.layers;
    const LayerData data = fill_uniforms(plan, perspectives, view, settings);
    const Kind& kind = data.kind;

    gl::begin(framebuffer, view.camera.width(), view.camera.height(), gl::Blend::Replace);
    const Variant& variant = variant_for(kind);
    glUseProgram(variant.program.name());
    glUniform1i(variant.layer_count, static_cast<GLint>(layers.size()));
    const Eigen::Vector2f middle = middle_of(view).cast<float>();
    glUniform2f(variant.middle, middle.x(), middle.y());
    glUniform2f(variant.texel_size, 1.0F / static_cast<float>(std::max(1, cache_.width())),
                1.0F / static_cast<float>(std::max(1, cache_.height())));
    glUniform1f(variant.least_total_weight,
                static_cast<float>(least_total_weight(plan.planned, kind.shape)));
    glUniform1f(variant.stop, static_cast<float>(settings.small_aperture_stop));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.name());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, cache_.texture());
    if (kind.shape) bind_shape(view, settings, variant);
    if (kind.tiles()) bind_tiles(tiles_of(view, data), variant);
    glBindVertexArray(vertex_array_.name());
    if (rows) {
      glEnable(GL_SCISSOR_TEST);  // gl::begin() disables it
      glScissor(0, rows->first, view.camera.width(), rows->count);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  void upload(const Perspective& perspective) {
    const lightfield::Photo& photo = *perspective.photo;
    cache_.begin_view(1, photo.width(), photo.height());
    cache_.slot_of(perspective.photo);
  }

 private:
  /// The layers of a view that have a weight, and where their pictures are.
  struct Plan {
    std::vector<Layer> layers;
    std::vector<int> slots;   ///< of the layers' pictures
    std::size_t planned = 0;  ///< layers, with those without a weight
  };

  /// plan_view() with all pictures on the GPU. One that turns out to be lost makes room for the
  /// next: from then on plan_view() leaves it out.
  Plan plan_with_pictures(const View& view, const std::vector<Perspective>& perspectives,
                          const Settings& settings) {
    while (true) {
      Plan plan{plan_view(view, perspectives, settings), {}, 0};
      plan.planned = plan.layers.size();
      std::erase_if(plan.layers, [](const Layer& layer) { return layer.weight <= 0.0; });
      plan.slots = picture_slots(plan.layers, perspectives);
      if (plan.slots.size() == plan.layers.size()) return plan;
    }
  }

  /// Fewer than layers if pictures are lost.
  std::vector<int> picture_slots(const std::vector<Layer>& layers,
                                 const std::vector<Perspective>& perspectives) {
    int width = 0;
    int height = 0;
    for (const Layer& layer : layers) {
      width = std::max(width, perspectives[layer.perspective].photo->width());
      height = std::max(height, perspectives[layer.perspective].photo->height());
    }
    if (!layers.empty()) cache_.begin_view(layers.size(), width, height);
    std::vector<int> slots;
    for (const Layer& layer : layers) {
      const auto slot = cache_.slot_of(perspectives[layer.perspective].photo);
      if (slot) slots.push_back(*slot);
    }
    return slots;
  }

  /// Brings the layers' data to the GPU, with the depth maps that are not there.
  LayerData fill_uniforms(const Plan& plan, const std::vector<Perspective>& perspectives,
                          const View& view, const Settings& settings) {
    std::vector<LayerSlots> slots;
    if (settings.shape) {
      std::vector<const DepthMap*> maps;
      for (const Layer& layer : plan.layers) maps.push_back(layer.map.get());
      maps_.begin_view(maps);
    }
    for (std::size_t i = 0; i < plan.layers.size(); ++i) {
      slots.push_back({plan.slots[i]});
      const Layer& layer = plan.layers[i];
      if (!layer.map) continue;
      const MapCache::Slot map = maps_.slot_of(layer.map);
      slots.back().map = map.index;
      if (map.largest > 0.0) slots.back().largest_map = map.largest;
    }
    LayerData data = layer_data(view, perspectives, settings, plan.layers, slots);
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

  gl::VertexArray vertex_array_;
  gl::Buffer uniforms_;
  PictureCache cache_;
  MapCache maps_;
  gl::Texture shape_;  ///< inverse depths of the view drawn last
  gl::Texture lists_;  ///< of the tiles of the view drawn last
  std::array<std::optional<Variant>, Kind::kCount> variants_;
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

void Renderer::draw(const View& view, const std::vector<Perspective>& perspectives,
                    const Settings& settings, unsigned framebuffer, std::optional<Rows> rows) {
  impl_->draw(view, perspectives, settings, framebuffer, rows);
}

void Renderer::upload(const Perspective& perspective) {
  impl_->upload(perspective);
}

}  // namespace lumibox::render
