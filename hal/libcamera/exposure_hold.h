#pragma once

#include <deque>
#include <optional>
#include <string>

#include "hal/libcamera/camera_system.h"

namespace lumibox::hal::libcam {

/// Holds focus, exposure and white balance as they are. What a camera is told shows some pictures
/// later in what it says of them: it is compared, and told again a few times if it is not so.
/// Knows only what was seen and what is to be said.
class ExposureHold {
 public:
  /// A stream begins: what the camera is to be told with it. What was held before is held just so.
  Orders begin();

  /// Of a picture that came.
  void saw(const Adjustments& adjustments);

  /// Whether the camera is to be held. Takes effect with the first picture seen.
  void want(bool hold);

  /// What goes with the next request, if anything; said once. The camera is told to stop adjusting
  /// itself one request before the values are certain to count: some take them for their own.
  std::optional<Orders> take_orders();

  /// How it went, if that is known since this was last asked: "held: exposure 10000 us, gain 2",
  /// or what does not keep to it.
  std::optional<std::string> take_news();
  bool is_fault() const { return is_fault_; }  ///< of the last news

  /// Nothing is held any more; the next stream begins as the camera likes.
  void forget();

 private:
  void order();
  void check();

  std::optional<Adjustments> latest_;  ///< of this stream
  std::optional<Adjustments> held_;
  std::deque<Orders> orders_;  ///< one for each request
  int tries_ = 0;
  int pictures_ = 0;  ///< since the last try
  bool checking_ = false;
  std::optional<std::string> news_;
  bool is_fault_ = false;
};

}  // namespace lumibox::hal::libcam
