#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/kms/mode.h"

namespace lumibox::hal::kms {

/// A socket of a graphics card, and what is plugged into it.
struct Connector {
  std::uint32_t id = 0;
  std::string name;  ///< "HDMI-A-1"
  bool connected = false;
  std::vector<Mode> modes;           ///< of the screen; empty if nothing is connected
  std::vector<std::uint32_t> crtcs;  ///< scanout engines that can drive it, the one that does first
};

/// A scanout engine (CRTC) and the connector that it drives.
struct Pipe {
  std::uint32_t crtc = 0;
  std::uint32_t connector = 0;
};

/// What the card says to being told something.
enum class Outcome {
  Done,
  NotMaster,  ///< another program has the card now, or a flip is still under way
  Refused     ///< the screen is not what it was, or the mode not possible
};

enum class Probe {
  No,  ///< what the kernel knows anyway
  Yes  ///< asks each screen, which takes some tens of milliseconds
};

/// A graphics card as the kernel's mode setting has it: a thin layer over libdrm, and in tests one
/// that is not there.
class Card {
 public:
  virtual ~Card() = default;

  virtual std::vector<Connector> connectors(Probe probe) = 0;

  /// Switches the screen on, showing a framebuffer of the mode's size; returns when it does.
  virtual Outcome set_mode(const Pipe& pipe, const Mode& mode, std::uint32_t framebuffer) = 0;

  /// Has another framebuffer shown from the next vertical blank on; returns at once.
  virtual Outcome flip(const Pipe& pipe, std::uint32_t framebuffer, std::uint64_t serial) = 0;

  /// Waits until a flip has happened, but not longer than this; its serial.
  virtual std::optional<std::uint64_t> wait_for_flip(std::int64_t timeout_ns) = 0;

  /// Only the master of a card may set modes and flip. False if another program is.
  virtual bool take_master() = 0;
  virtual void drop_master() = 0;
};

}  // namespace lumibox::hal::kms
