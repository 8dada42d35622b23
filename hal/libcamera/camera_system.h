#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hal/live/modes.h"

/// What is asked of libcamera, and nothing more, in words that are the same for all its versions:
/// tests put cameras in memory in its place. (libcam: the library's own namespace is libcamera.)
namespace lumibox::hal::libcam {

struct CameraName {
  std::string id;     ///< stays the same as long as the camera is where it is
  std::string model;  ///< "imx708"; the id if it does not say
};

/// Sizes that a camera offers in a format: all from `least` to `most` in steps.
struct Offer {
  live::PixelFormat format = live::PixelFormat::Nv12;
  struct Size {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
  } least, most, step;
};

/// What the camera made of a mode that it was set to.
struct Configured {
  std::optional<live::PixelFormat> format;  ///< none: one that is not read here
  int width = 0;
  int height = 0;
  std::size_t stride = 0;  ///< bytes from one row (of luma) to the next
  bool limited_range = false;
};

/// What can be told of, or told to, a camera about a picture; none: nothing, or as it is.
struct Adjustments {
  std::optional<std::int32_t> exposure_us;
  std::optional<float> gain;                        ///< of the sensor: 1 is none
  std::optional<std::array<float, 2>> white_gains;  ///< of red and of blue
  std::optional<float> lens_dioptres;               ///< 0: infinity
};

/// What a camera is told, beginning with some picture to come.
struct Orders {
  std::optional<bool> automatic;  ///< whether the camera adjusts itself; none: as before
  Adjustments values;             ///< of a camera that does not
  std::optional<std::int64_t> frame_duration_us;
};

/// What a camera can be told.
struct Abilities {
  bool exposure = false;  ///< exposure time and gain
  bool white_balance = false;
  bool focus = false;
  std::optional<std::pair<std::int64_t, std::int64_t>> frame_duration_us;  ///< least and most
};

/// A request that the camera is done with.
struct Completed {
  enum class Status {
    Success,
    Error,      ///< the picture is damaged
    Cancelled,  ///< there is no picture
  };

  std::uint32_t request = 0;  ///< which
  Status status = Status::Success;
  std::vector<std::span<const std::uint8_t>> planes;  ///< valid until the request is queued again
  std::uint32_t sequence = 0;
  std::optional<std::int64_t> exposure_begin_ns;  ///< of the first row
  std::int64_t timestamp_ns = 0;                  ///< when the picture came from the sensor
  Adjustments adjustments;                        ///< that it was taken with
};

/// A camera that nobody else can use meanwhile. Functions that can fail give 0 or the errno.
class OpenCamera {
 public:
  virtual ~OpenCamera() = default;

  /// Of its viewfinder, in formats that are read here.
  virtual std::vector<Offer> offers() = 0;

  /// Sets the viewfinder to the mode nearest to this one; or the errno.
  virtual std::variant<Configured, int> configure(const live::Mode& mode) = 0;

  /// In the mode that it was set to.
  virtual Abilities abilities() const = 0;

  /// Begins a stream with requests enough for it.
  virtual int start(const Orders& orders) = 0;
  /// Ends it; all requests are the camera's again.
  virtual void stop() = 0;

  /// The next request that is done, if there is one.
  virtual std::optional<Completed> take() = 0;
  virtual int queue(std::uint32_t request, const std::optional<Orders>& orders) = 0;

  /// Whether it was unplugged; CameraSystem::changed() is true then, too.
  virtual bool is_removed() const = 0;

  /// Readable when take() has something.
  virtual int poll_fd() const = 0;
};

/// A camera or the errno.
struct Opened {
  std::unique_ptr<OpenCamera> camera;
  int error = 0;
};

/// Outlives the cameras that it opened.
class CameraSystem {
 public:
  virtual ~CameraSystem() = default;

  virtual std::vector<CameraName> cameras() = 0;
  virtual Opened open(const std::string& id) = 0;

  /// Whether a camera has come or gone since this was last asked.
  virtual bool changed() = 0;
  /// Readable when changed() will be true.
  virtual int watch_fd() const = 0;
};

/// The cameras of this machine, by the library. There can be one at a time in a process. Throws
/// config::Unavailable if the library does not start.
std::unique_ptr<CameraSystem> real_camera_system();

}  // namespace lumibox::hal::libcam
