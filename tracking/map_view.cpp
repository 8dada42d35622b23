#include "tracking/map_view.h"

#include <algorithm>

namespace lumibox::tracking {

const MapView::Point* find_point(const MapView& map, PointId id) {
  const auto place = std::ranges::lower_bound(map.points, id, {}, &MapView::Point::id);
  return place != map.points.end() && place->id == id ? &*place : nullptr;
}

}  // namespace lumibox::tracking
