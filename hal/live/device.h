#pragma once

#include <optional>
#include <string>
#include <variant>

#include "hal/live/filled.h"
#include "hal/live/modes.h"

namespace lumibox::hal::live {

/// One camera, whether it is there or not: it may be opened and closed, and its stream begun and
/// ended, any number of times. What backends implement and Streamer drives, from one thread at a
/// time. Nothing here waits for a picture; what goes wrong is told in words.
class Device {
 public:
  virtual ~Device() = default;

  /// Opens the camera, the same as ever, in its mode. The reason, beginning with the camera's name,
  /// if it is not there or not the same.
  virtual std::optional<std::string> open() = 0;
  virtual bool is_open() const = 0;
  /// Lets go of the camera, and of a stream.
  virtual void close() = 0;

  virtual std::string name() const = 0;  ///< "/dev/video0 (HD Pro Webcam C920)"
  virtual const Layout& layout() const = 0;

  /// Begins a stream, in place of one that there may be. Where nothing is held, what a camera does
  /// by itself is switched on: who had it before may have ended while it held that, as this program
  /// does in a crash.
  virtual std::optional<std::string> begin() = 0;
  virtual bool is_streaming() const = 0;
  virtual void end() = 0;

  /// The next filled buffer; nothing; or why the stream is broken.
  using Taken = std::variant<std::monostate, Filled, std::string>;
  virtual Taken take() = 0;
  virtual std::optional<std::string> give_back(const Filled& filled) = 0;

  /// Why there will be no more buffers, if the camera has said so otherwise than by take().
  virtual std::optional<std::string> loss() = 0;

  /// Readable when take() has something; -1 without a stream.
  virtual int poll_fd() const = 0;

  /// Whether some camera has come or gone since this was last asked. Never where nobody tells.
  virtual bool changed() = 0;
  /// Readable when changed() will be true; -1 where nobody tells.
  virtual int watch_fd() const = 0;

  /// Holds focus, exposure and white balance as they are, or lets the camera adjust them; whatever
  /// is not yet so. What was held is held just so after the camera was opened anew.
  virtual void update_hold(bool wanted) = 0;
  /// Before the end of a stream that is not begun anew by itself: nothing is held any more.
  virtual void forget_hold() = 0;
};

}  // namespace lumibox::hal::live
