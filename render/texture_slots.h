#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace lumibox::render {

/// What each slot of a texture array holds. A new thing takes the slot of one that is no more, or
/// else of the one unused for longest, so the memory is bounded however many there are. Things are
/// told by the object, not by an id.
template <class Thing>
class TextureSlots {
 public:
  std::size_t size() const { return slots_.size(); }

  /// Forgets all; from now on there are `count` slots.
  void reset(std::size_t count) { slots_.assign(count, {}); }

  /// What was handed out before may be overwritten.
  void begin_view() { ++view_; }

  bool holds(const std::shared_ptr<const Thing>& thing) const {
    return std::ranges::any_of(slots_, [&](const Slot& slot) { return slot.is_of(thing); });
  }

  struct Place {
    std::size_t slot = 0;
    bool is_new = false;  ///< it has to be put there
  };

  /// Where a thing is until the next begin_view(). Precondition: there is a slot.
  Place place_of(const std::shared_ptr<const Thing>& thing) {
    auto slot = std::ranges::find_if(slots_, [&](const Slot& s) { return s.is_of(thing); });
    const bool is_new = slot == slots_.end();
    if (is_new) slot = std::ranges::min_element(slots_, {}, &Slot::last_use);
    *slot = {thing, view_};
    return {static_cast<std::size_t>(slot - slots_.begin()), is_new};
  }

  /// Nothing could be put there.
  void forget(std::size_t slot) { slots_[slot] = {}; }

 private:
  struct Slot {
    std::weak_ptr<const Thing> held;
    std::uint64_t last_view = 0;

    /// By the owner, not by lock(), which costs more than the comparison.
    bool is_of(const std::shared_ptr<const Thing>& thing) const {
      return !held.owner_before(thing) && !thing.owner_before(held);
    }
    std::uint64_t last_use() const { return held.expired() ? 0 : last_view; }
  };
  std::vector<Slot> slots_;
  std::uint64_t view_ = 0;
};

}  // namespace lumibox::render
