#pragma once

#include <cstddef>
#include <vector>

#include "config/config.h"
#include "lightfield/perspective.h"
#include "render/picture_cache.h"
#include "render/read_ahead.h"
#include "render/view.h"

namespace lumibox::render {

/// The layers of a view that have a weight, and where their pictures are on the GPU.
struct SuppliedView {
  std::vector<Layer> layers;
  std::vector<int> slots;   ///< of the layers' pictures
  std::size_t planned = 0;  ///< layers, with those without a weight
  bool complete = true;     ///< none of its pictures is still to come
};

/// Brings the pictures of views to the GPU: all at once; or, with somebody who reads ahead, as
/// they come, so that no view waits for files and what it uploads is bounded. Then a view is made
/// of those near it that are there, and asks for the others.
class PictureSupply {
 public:
  /// `ahead` must outlive this; null: all at once.
  PictureSupply(const config::Render& options, ReadAhead* ahead);

  /// Pictures that are lost are left out: the next nearest take their place.
  SuppliedView supply(const View& view, const std::vector<lightfield::Perspective>& perspectives,
                      const Settings& settings);

  /// Uploads a picture ahead of its first view.
  void upload(const lightfield::Perspective& perspective);

  const PictureCache& cache() const { return cache_; }

 private:
  SuppliedView supply_all(const View& view,
                          const std::vector<lightfield::Perspective>& perspectives,
                          const Settings& settings);
  SuppliedView supply_some(const View& view,
                           const std::vector<lightfield::Perspective>& perspectives,
                           const Settings& settings);
  void begin_view(const std::vector<Layer>& layers,
                  const std::vector<lightfield::Perspective>& perspectives);
  std::vector<int> slots_of(const std::vector<Layer>& layers,
                            const std::vector<lightfield::Perspective>& perspectives);
  std::vector<std::size_t> within_reach(const std::vector<Layer>& layers, const View& view,
                                        const std::vector<lightfield::Perspective>& perspectives,
                                        const Settings& settings) const;
  void bring(const std::vector<std::size_t>& near, std::size_t of_view,
             const std::vector<lightfield::Perspective>& perspectives);

  std::size_t most_of_view_;  ///< pictures in any view
  PictureCache cache_;
  ReadAhead* ahead_;
};

}  // namespace lumibox::render
