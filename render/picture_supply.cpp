#include "render/picture_supply.h"

#include <algorithm>

#include "render/depth_map.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

/// Uploaded per view, or one picture if that is larger: two of 640x480, a quarter of a millisecond
/// each on a PC, so that a board several times slower stays within one or two.
constexpr std::size_t kUploadBytes = 2U << 20U;

/// So many of a view's nearest are drawn whatever it takes: a picture made of fewer has holes.
constexpr std::size_t kHandful = 4;

/// Pictures around a view that are kept ready for where it goes, over those that it shows.
constexpr std::size_t kReach = 2;

SuppliedView with_weight(std::vector<Layer> layers) {
  const std::size_t planned = layers.size();
  std::erase_if(layers, [](const Layer& layer) { return layer.weight <= 0.0; });
  return {std::move(layers), {}, planned, true};
}

}  // namespace

PictureSupply::PictureSupply(const config::Render& options, ReadAhead* ahead)
    : most_of_view_(static_cast<std::size_t>(options.k)),
      cache_(static_cast<std::size_t>(options.texture_mb) << 20U),
      ahead_(ahead) {}

SuppliedView PictureSupply::supply(const View& view, const std::vector<Perspective>& perspectives,
                                   const Settings& settings) {
  return ahead_ == nullptr ? supply_all(view, perspectives, settings)
                           : supply_some(view, perspectives, settings);
}

void PictureSupply::upload(const Perspective& perspective) {
  const lightfield::Photo& photo = *perspective.photo;
  cache_.begin_view(1, photo.width(), photo.height());
  cache_.slot_of(perspective.photo);
}

/// A picture that turns out to be lost makes room for the next: from then on plan_view() leaves it
/// out.
SuppliedView PictureSupply::supply_all(const View& view,
                                       const std::vector<Perspective>& perspectives,
                                       const Settings& settings) {
  while (true) {
    SuppliedView supplied = with_weight(plan_view(view, perspectives, settings));
    begin_view(supplied.layers, perspectives);
    supplied.slots = slots_of(supplied.layers, perspectives);
    if (supplied.slots.size() == supplied.layers.size()) return supplied;
  }
}

/// Until all are there, the view is planned again of those near it that are.
SuppliedView PictureSupply::supply_some(const View& view,
                                        const std::vector<Perspective>& perspectives,
                                        const Settings& settings) {
  SuppliedView supplied = with_weight(plan_view(view, perspectives, settings));
  begin_view(supplied.layers, perspectives);
  const std::vector<std::size_t> near = within_reach(supplied.layers, view, perspectives, settings);
  bring(near, supplied.layers.size(), perspectives);
  const auto is_there = [&](std::size_t i) { return cache_.holds(perspectives[i].photo); };
  if (!std::ranges::all_of(supplied.layers, is_there, &Layer::perspective)) {
    // Those that cannot be shown keep their index, which the shape's maps go by.
    std::vector<Perspective> there = perspectives;
    for (Perspective& perspective : there) perspective.photo.reset();
    for (const std::size_t i : near) {
      if (is_there(i)) there[i].photo = perspectives[i].photo;
    }
    supplied = with_weight(plan_view(view, there, settings));
    supplied.complete = false;
  }
  supplied.slots = slots_of(supplied.layers, perspectives);
  return supplied;
}

void PictureSupply::begin_view(const std::vector<Layer>& layers,
                               const std::vector<Perspective>& perspectives) {
  int width = 0;
  int height = 0;
  for (const Layer& layer : layers) {
    width = std::max(width, perspectives[layer.perspective].photo->width());
    height = std::max(height, perspectives[layer.perspective].photo->height());
  }
  if (!layers.empty()) cache_.begin_view(layers.size(), width, height);
}

/// Fewer than layers if pictures are lost.
std::vector<int> PictureSupply::slots_of(const std::vector<Layer>& layers,
                                         const std::vector<Perspective>& perspectives) {
  std::vector<int> slots;
  for (const Layer& layer : layers) {
    if (const auto slot = cache_.slot_of(perspectives[layer.perspective].photo)) {
      slots.push_back(*slot);
    }
  }
  return slots;
}

/// The perspectives of a view's layers, and then the nearest others: as many as a view with
/// another aperture shows, or as a moving view shows next, if there are slots for them.
std::vector<std::size_t> PictureSupply::within_reach(const std::vector<Layer>& layers,
                                                     const View& view,
                                                     const std::vector<Perspective>& perspectives,
                                                     const Settings& settings) const {
  std::vector<std::size_t> near;
  for (const Layer& layer : layers) near.push_back(layer.perspective);
  const std::size_t reach =
      std::min(cache_.slots(), std::max(most_of_view_, kReach * layers.size()));
  const Eigen::Vector3d& eye = view.world_from_camera.translation;
  for (const auto& [angle, i] : nearest_by_angle(perspectives, eye, settings.focus)) {
    if (near.size() >= reach) break;
    const lightfield::Photo& photo = *perspectives[i].photo;
    const bool fits = photo.width() <= cache_.width() && photo.height() <= cache_.height();
    if (fits && std::ranges::find(layers, i, &Layer::perspective) == layers.end()) {
      near.push_back(i);
    }
  }
  return near;
}

/// Uploads what is in memory, the nearest first, and asks for the rest; only of the view's own,
/// the first `of_view`, a handful is read here if there is less.
void PictureSupply::bring(const std::vector<std::size_t>& near, std::size_t of_view,
                          const std::vector<Perspective>& perspectives) {
  const auto photo_of = [&](std::size_t rank) { return perspectives[near[rank]].photo; };
  std::size_t uploaded_bytes = 0;
  std::size_t there = 0;
  std::vector<std::size_t> missing;
  for (std::size_t rank = 0; rank < near.size(); ++rank) {
    const auto photo = photo_of(rank);
    const bool is_new = !cache_.holds(photo);
    if (is_new && (uploaded_bytes >= kUploadBytes || !photo->in_memory())) {
      missing.push_back(rank);
      continue;
    }
    cache_.slot_of(photo);  // which also says that it is in use
    if (is_new) uploaded_bytes += PictureCache::bytes_of(photo->width(), photo->height());
    if (rank < of_view) ++there;
  }
  ReadAhead::Pictures wanted;
  for (const std::size_t rank : missing) {
    if (rank < of_view && there < kHandful) {
      if (cache_.slot_of(photo_of(rank))) ++there;
    } else {
      wanted.push_back(photo_of(rank));
    }
  }
  ahead_->want(wanted);
}

}  // namespace lumibox::render
