#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace lumibox::hal {

/// A switch's line changed; active means that the contact is closed.
struct LineEdge {
  bool active = false;
  std::int64_t timestamp_ns = 0;  ///< Clock time

  bool operator==(const LineEdge&) const = default;
};

/// What a line did since it was last read.
struct LineReading {
  /// Oldest first. They need not alternate: when a switch bounces, the kernel may miss half of it.
  std::vector<LineEdge> edges;
  bool active = false;  ///< the level now, read after the edges
  bool lost = false;    ///< after those there were more, which the kernel did not keep
};

/// Makes one edge of each burst in which a switch bounces. A burst is over when the line has been
/// quiet for a while, and is told then: if it left the line at another level than before, as one
/// edge with the time of the burst's first; otherwise it was a disturbance, and is not told.
///
/// So an edge is told by the first update() at least `quiet_ns` after the last bounce. Where edges
/// were lost, the level that was read says how the line ended up: there are never too many edges,
/// or one that is not true.
class Debouncer {
 public:
  Debouncer(std::int64_t quiet_ns, bool active_at_start);

  /// The edges that `reading` and the time `now_ns`, which is not before any of it, make certain.
  std::vector<LineEdge> update(const LineReading& reading, std::int64_t now_ns);

  bool active() const { return settled_; }  ///< by what has been told

 private:
  struct Burst {
    std::int64_t first_ns = 0;
    std::int64_t last_ns = 0;
  };

  void take(const LineEdge& edge);
  void settle(std::int64_t now_ns, std::vector<LineEdge>& told);

  std::int64_t quiet_ns_;
  bool settled_;  ///< level that has been told
  bool level_;    ///< of the last edge
  std::optional<Burst> burst_;
};

}  // namespace lumibox::hal
