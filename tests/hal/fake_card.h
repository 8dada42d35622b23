#pragma once

#include <deque>
#include <set>
#include <vector>

#include "hal/kms/card.h"
#include "hal/kms/scanout.h"
#include "hal/kms/terminal.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox::hal::kms {

inline Mode mode(int width, int height, double refresh_hz, bool preferred = false) {
  Mode mode;
  mode.size = {width, height};
  mode.refresh_hz = refresh_hz;
  mode.preferred = preferred;
  return mode;
}

inline Connector screen(std::uint32_t id, std::vector<Mode> modes) {
  return {id, "HDMI-A-" + std::to_string(id), true, std::move(modes), {100 + id}};
}

/// A card that is not there. Flips happen when somebody waits for them, at the next multiple of
/// `frame_ns` of the virtual clock; as many at once as asked for is an error of the caller.
class FakeCard : public Card {
 public:
  explicit FakeCard(VirtualClock& clock) : clock_(clock) {}

  std::vector<Connector> connectors(Probe probe) override {
    probes += probe == Probe::Yes ? 1 : 0;
    return plugged;
  }

  Outcome set_mode(const Pipe& pipe, const Mode& mode, std::uint32_t framebuffer) override {
    if (!is_master) return Outcome::NotMaster;
    if (refuses || (hangs && pending_)) return Outcome::Refused;
    if (pending_) stray.push_back(end_flip());
    last_pipe = pipe;
    modes_set.push_back(mode);
    shown.push_back(framebuffer);
    return Outcome::Done;
  }

  Outcome flip(const Pipe& /*pipe*/, std::uint32_t framebuffer, std::uint64_t serial) override {
    if (!is_master || pending_) return Outcome::NotMaster;
    if (refuses) return Outcome::Refused;
    pending_ = Pending{framebuffer, serial};
    return Outcome::Done;
  }

  std::optional<std::uint64_t> wait_for_flip(std::int64_t timeout_ns) override {
    if (!stray.empty()) {
      const std::uint64_t serial = stray.front();
      stray.pop_front();
      return serial;
    }
    const std::int64_t now_ns = clock_.now_ns();
    const std::int64_t blank_ns = frame_ns == 0 ? now_ns : (now_ns / frame_ns + 1) * frame_ns;
    if (hangs || !pending_ || blank_ns > now_ns + timeout_ns) {
      clock_.wait_until(now_ns + timeout_ns);
      return std::nullopt;
    }
    clock_.wait_until(blank_ns);
    return end_flip();
  }

  bool take_master() override {
    ++tries;
    is_master = is_master || !taken;
    return is_master;
  }
  void drop_master() override { is_master = false; }

  /// Another program takes the card, and gives it back.
  void take_away() {
    taken = true;
    is_master = false;
  }

  /// The driver shows the picture but forgets to say so.
  void end_flip_in_silence() { end_flip(); }

  std::uint32_t on_screen() const { return shown.empty() ? 0 : shown.back(); }
  std::optional<std::uint32_t> pending() const {
    return pending_ ? std::optional(pending_->framebuffer) : std::nullopt;
  }

  std::vector<Connector> plugged;
  bool is_master = true;
  bool taken = false;
  bool refuses = false;                ///< pictures and modes
  bool hangs = false;                  ///< flips do not end
  std::int64_t frame_ns = 16'666'667;  ///< 0: no vertical blank
  int probes = 0;
  int tries = 0;
  Pipe last_pipe;
  std::vector<Mode> modes_set;
  std::vector<std::uint32_t> shown;
  std::deque<std::uint64_t> stray;  ///< ends of flips that nobody waits for any more

 private:
  struct Pending {
    std::uint32_t framebuffer;
    std::uint64_t serial;
  };

  std::uint64_t end_flip() {
    const Pending ended = *pending_;
    pending_.reset();
    shown.push_back(ended.framebuffer);
    return ended.serial;
  }

  VirtualClock& clock_;
  std::optional<Pending> pending_;
};

/// Four buffers, as GBM has; says what must not be.
class FakeBuffers : public Buffers {
 public:
  std::optional<std::uint32_t> finish() override {
    if (lost) return std::nullopt;
    for (std::uint32_t buffer = first; buffer < first + 4; ++buffer) {
      if (locked.insert(buffer).second) return buffer;
    }
    throw std::logic_error("no free buffer");
  }
  void release(std::uint32_t framebuffer) override {
    if (locked.erase(framebuffer) == 0) throw std::logic_error("released twice");
  }
  void resize(Size new_size) override {
    if (!locked.empty()) throw std::logic_error("resized while pictures are shown");
    size = new_size;
    first += 10;
  }

  std::set<std::uint32_t> locked;
  Size size;
  std::uint32_t first = 1;
  bool lost = false;
};

class FakeTerminal : public Terminal {
 public:
  Request take_request() override { return std::exchange(request, Request::None); }
  void let_go() override { said.push_back("let go"); }
  void take_back() override { said.push_back("take back"); }

  Request request = Request::None;
  std::vector<std::string> said;
};

}  // namespace lumibox::hal::kms
