#include "hal/debouncer.h"

#include <algorithm>

namespace lumibox::hal {

Debouncer::Debouncer(std::int64_t quiet_ns, bool active_at_start)
    : quiet_ns_(quiet_ns), settled_(active_at_start), level_(active_at_start) {}

std::vector<LineEdge> Debouncer::update(const LineReading& reading, std::int64_t now_ns) {
  std::vector<LineEdge> told;
  for (const LineEdge& edge : reading.edges) {
    settle(edge.timestamp_ns, told);
    take(edge);
  }
  if (reading.active != level_) {
    // Nobody said so. Either it changed this instant, or that edge was lost: then it belongs to the
    // burst that was too long for the kernel.
    if (!reading.lost) {
      settle(now_ns, told);
    }
    take({reading.active, now_ns});
  }
  settle(now_ns, told);
  return told;
}

/// An edge may be older than the last one: that of a level that was read just before.
void Debouncer::take(const LineEdge& edge) {
  if (!burst_) {
    burst_ = Burst{edge.timestamp_ns, edge.timestamp_ns};
  }
  burst_->first_ns = std::min(burst_->first_ns, edge.timestamp_ns);
  burst_->last_ns = std::max(burst_->last_ns, edge.timestamp_ns);
  level_ = edge.active;
}

void Debouncer::settle(std::int64_t now_ns, std::vector<LineEdge>& told) {
  if (!burst_ || now_ns - burst_->last_ns < quiet_ns_) {
    return;
  }
  if (level_ != settled_) {
    settled_ = level_;
    told.push_back({settled_, burst_->first_ns});
  }
  burst_.reset();
}

}  // namespace lumibox::hal
