#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hal/libcamera/camera_system.h"
#include "hal/live/modes.h"

/// Finding a camera by its name and setting it to a mode.
namespace lumibox::hal::libcam {

struct Request {
  std::string name;  ///< a number of the list, an id, a part of id or model in any case, or "auto"
  live::Wish wish;
  std::optional<live::Mode> mode;  ///< none: whichever is nearest to the wish
};

/// A camera that is ready to stream.
struct Connection {
  std::unique_ptr<OpenCamera> camera;
  CameraName identity;
  live::Layout layout;  ///< with the rate that it is told, if it can be told one
  Abilities abilities;
  std::string offer;  ///< "nv12, yuyv in 9 sizes up to 1920x1080"

  std::string name() const;  ///< "imx708 (/base/soc/i2c0mux/i2c@1/imx708@1a)"
};

/// What stands before a message about a camera.
std::string name_of(const CameraName& identity);

/// All it offers. Where it offers sizes in a range, the one nearest to the wish stands for all.
std::vector<live::Mode> list_modes(OpenCamera& camera, const live::Wish& wish);

/// The camera asked for, in the mode nearest to what is wished; or why there is none, in words that
/// begin with what they are about.
std::variant<Connection, std::string> connect(CameraSystem& system, const Request& request);

/// Asks for just the camera and the mode that were found before.
Request again(const Request& request, const Connection& connection);

}  // namespace lumibox::hal::libcam
