#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <optional>

#include "render/blending.h"
#include "render/depth_grid.h"
#include "render/depth_map.h"
#include "render/gl.h"
#include "render/layer_program.h"
#include "render/layer_uniforms.h"
#include "render/map_cache.h"
#include "render/picture_supply.h"
#include "render/tile_painter.h"
#include "render/tiles.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

/// Whether any picture is to be shown brighter or darker than it is.
bool any_gain(const LayerData& data) {
  return std::ranges::any_of(data.layers,
                             [](const LayerUniforms& u) { return u.from_1[3] != 1.0F; });
}

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

  bool draw(const View& view, const std::vector<Perspective>& perspectives,
            const Settings& settings, unsigned framebuffer, const std::optional<Rows>& rows) {
    const SuppliedView supplied = supply_.supply(view, perspectives, settings);
    const LayerData data = fill_uniforms(supplied, perspectives, view, settings);
    draw_layers(data, supplied, view, settings, framebuffer, rows);
    return supplied.complete;
  }

  void upload(const Perspective& perspective) { supply_.upload(perspective); }

  bool prepare_next(const View& view, const std::shared_ptr<const geometry::Camera>& source,
                    unsigned framebuffer) {
    if (prepared_ == kToPrepare) {
      black_.reset();
      return false;
    }
    if (!black_) {
      black_.emplace();
      black_->camera = source;
      black_->photo = std::make_shared<lightfield::Photo>(
          std::make_shared<const hal::Image>(source->width(), source->height(), 3));
    }
    black_->world_from_camera = view.world_from_camera;
    const Eigen::Vector3d focus = view.world_from_camera * Eigen::Vector3d::UnitZ().eval();
    const Settings settings = settings_to_prepare(view, *black_, focus);
    const SuppliedView supplied = supply_.supply(view, {*black_}, settings);
    LayerData data = fill_uniforms(supplied, {*black_}, view, settings);
    data.kind.horizon = prepared_ % 2 == 1;  // what the place of a view decides
    draw_layers(data, supplied, view, settings, framebuffer, std::nullopt);
    if (data.kind.tiles()) {
      data.layers.front().from_1[3] = 2.0F;  // brighter than it is
      draw_layers(data, supplied, view, settings, framebuffer, std::nullopt);
    }
    ++prepared_;
    return true;
  }

 private:
  /// The small aperture on planes, the wide one, and on a shape: one that is everywhere as far as
  /// the focus. Each without and with a horizon.
  static constexpr int kToPrepare = 6;
  Settings settings_to_prepare(const View& view, const Perspective& perspective,
                               const Eigen::Vector3d& focus) const {
    const bool wide = prepared_ / 2 == 1, shape = prepared_ / 2 == 2;
    Settings settings = settings_from(options_, wide ? Aperture::Wide : Aperture::Small, focus);
    if (!shape) return settings;
    if (const auto map = estimate_depth(perspective, {}, focus)) {
      settings.shape = std::make_shared<Shape>(DepthGrid(view, {}, 1.0),
                                               std::vector{std::make_shared<const DepthMap>(*map)});
    }
    return settings;
  }

  void draw_layers(const LayerData& data, const SuppliedView& supplied, const View& view,
                   const Settings& settings, unsigned framebuffer,
                   const std::optional<Rows>& rows) {
    const Kind& kind = data.kind;
    gl::begin(framebuffer, view.camera.width(), view.camera.height(), gl::Blend::Replace);
    if (rows) {
      glEnable(GL_SCISSOR_TEST);  // gl::begin() disables it
      glScissor(0, rows->first, view.camera.width(), rows->count);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, kLayersBlock, uniforms_.name());
    glActiveTexture(GL_TEXTURE0 + kPicturesUnit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, supply_.cache().texture());
    const LayerProgram& program = use_program(kind, supplied, view, settings);
    if (kind.tiles()) {
      const Tiles tiles = tiles_of(view, data);
      glUniform1i(program.tile_size, tiles.size);
      tile_painter_.draw_mixed(tiles);
      tile_painter_.draw_alone(tiles, middle_of(view).cast<float>(), texel_size(),
                               {kind.distortion, any_gain(data)});
    } else {
      glBindVertexArray(vertex_array_.name());
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
  }

  const LayerProgram& use_program(const Kind& kind, const SuppliedView& supplied, const View& view,
                                  const Settings& settings) {
    const LayerProgram& program = program_for(kind);
    glUseProgram(program.program.name());
    glUniform1i(program.layer_count, static_cast<GLint>(supplied.layers.size()));
    const Eigen::Vector2f middle = middle_of(view).cast<float>();
    glUniform2f(program.middle, middle.x(), middle.y());
    glUniform2f(program.texel_size, texel_size().x(), texel_size().y());
    glUniform1f(program.least_total_weight,
                static_cast<float>(least_total_weight(supplied.planned, kind.shape)));
    glUniform1f(program.stop, static_cast<float>(settings.small_aperture_stop));
    if (kind.shape) bind_shape(view, settings, program);
    return program;
  }

  /// Of the array of pictures.
  Eigen::Vector2f texel_size() const {
    const PictureCache& pictures = supply_.cache();
    return {1.0F / static_cast<float>(std::max(1, pictures.width())),
            1.0F / static_cast<float>(std::max(1, pictures.height()))};
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

  void bind_shape(const View& view, const Settings& settings, const LayerProgram& program) {
    const DepthGrid& shape = settings.shape->grid;
    std::vector<float> scaled = shape.inverse_depths();
    for (float& value : scaled) value *= static_cast<float>(unit_of(view, settings));
    glActiveTexture(GL_TEXTURE0 + kInverseDepthsUnit);
    if (shape_.name() == 0) shape_ = gl::make_texture(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, shape_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R16F, shape.columns(), shape.rows(), 0, GL_RED, GL_FLOAT,
                 scaled.data());
    // Corner i lies at pixel i * cell, in the middle of texel i; fragment rows go up.
    const double cell = shape.cell();
    const double last_row = view.camera.height() - 0.5;
    glUniform4f(program.cells, static_cast<float>(1.0 / (cell * shape.columns())),
                static_cast<float>(-1.0 / (cell * shape.rows())),
                static_cast<float>((0.5 - 0.5 / cell) / shape.columns()),
                static_cast<float>((0.5 + last_row / cell) / shape.rows()));
    glActiveTexture(GL_TEXTURE0 + kMapsUnit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, maps_.texture());
    glUniform2f(program.map_texel_size, 1.0F / static_cast<float>(std::max(1, maps_.width())),
                1.0F / static_cast<float>(std::max(1, maps_.height())));
    glActiveTexture(GL_TEXTURE0 + kPicturesUnit);
  }

  /// Compiled when first needed.
  const LayerProgram& program_for(const Kind& kind) {
    std::optional<LayerProgram>& program = programs_[kind.index()];
    if (!program) program.emplace(kind);
    return *program;
  }

  config::Render options_;
  PictureSupply supply_;
  gl::VertexArray vertex_array_;
  gl::Buffer uniforms_;
  MapCache maps_;
  gl::Texture shape_;  ///< inverse depths of the view drawn last
  TilePainter tile_painter_;
  std::array<std::optional<LayerProgram>, Kind::kCount> programs_;
  int prepared_ = 0;                  ///< of kToPrepare
  std::optional<Perspective> black_;  ///< what they are drawn with
};

Renderer::Renderer(const config::Render& options, ReadAhead* ahead)
    : impl_(std::make_unique<Impl>(options, ahead)) {}
Renderer::~Renderer() = default;

bool Renderer::draw(const View& view, const std::vector<Perspective>& perspectives,
                    const Settings& settings, unsigned framebuffer, std::optional<Rows> rows) {
  return impl_->draw(view, perspectives, settings, framebuffer, rows);
}

bool Renderer::prepare_next(const View& view, const std::shared_ptr<const geometry::Camera>& source,
                            unsigned framebuffer) {
  return impl_->prepare_next(view, source, framebuffer);
}

void Renderer::upload(const Perspective& perspective) {
  impl_->upload(perspective);
}

}  // namespace lumibox::render
