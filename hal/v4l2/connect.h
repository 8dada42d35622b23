#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hal/live/modes.h"
#include "hal/v4l2/video_system.h"

/// Finding a camera by its name and setting it to a mode.
namespace lumibox::hal::v4l2 {

/// What a device says of itself.
struct Identity {
  std::string card;    ///< "HD Pro Webcam C920"
  std::string driver;  ///< "uvcvideo"
  std::string bus;     ///< "usb-0000:00:14.0-1"
};

/// None unless the device is a camera that streams: webcams have nodes for other things, too.
std::optional<Identity> identify(VideoDevice& device);

struct Request {
  std::string name;  ///< a path, a part of the card's name in any case, or "auto": the first
  live::Wish wish;
  std::optional<std::string> card;  ///< no other than this
};

/// A camera that is ready to stream.
struct Connection {
  std::unique_ptr<VideoDevice> device;
  std::string path;
  Identity identity;
  live::Layout layout;
  std::string offer;  ///< "mjpeg, yuyv in 9 sizes up to 1920x1080"

  std::string name() const { return path + " (" + identity.card + ")"; }
};

/// The camera asked for, in the mode nearest to what is wished; or why there is none, in words that
/// begin with what they are about.
std::variant<Connection, std::string> connect(VideoSystem& system, const Request& request);

/// Asks for just the mode of a camera that was connected before.
Request again(const Request& request, const Connection& connection);

}  // namespace lumibox::hal::v4l2
