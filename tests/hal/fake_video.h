#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hal/clock.h"
#include "hal/fake_pictures.h"
#include "hal/v4l2/video_system.h"

namespace lumibox::testing {

/// A size in a format, with the rates (whole frames per second) that it is offered at.
struct FakeMode {
  std::uint32_t fourcc = V4L2_PIX_FMT_MJPEG;
  int width = 32;
  int height = 24;
  std::vector<std::uint32_t> rates = {10};
};

struct FakeControl {
  std::string name;
  std::uint32_t type = V4L2_CTRL_TYPE_INTEGER;
  std::int32_t least = 0;
  std::int32_t most = 255;
  std::int32_t value = 0;
  std::int32_t usual = 0;               ///< the driver's default
  std::uint32_t ruled_by = 0;           ///< cannot be written while this one has another value than
  std::int32_t ruled_unless = 0;        ///< this; 0, 0: always can
  std::set<std::int32_t> entries = {};  ///< of a menu
  int refusals = 0;                     ///< of so many writes to come
  bool stubborn = false;                ///< takes a value and forgets it
};

/// A camera in memory: what it offers, how it misbehaves, and what was done with it. It makes the
/// pictures picture_of() says (fake_pictures.h), one each period of the clock, as drivers do: into
/// the buffers that it has been given, in turn, and nowhere if it has none.
struct FakeCamera {
  std::string path = "/dev/video0";
  std::string stable_path;
  std::string card = "Fake Webcam";
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<FakeMode> modes = {FakeMode{}};
  std::optional<v4l2_frmsize_stepwise> any_size;  ///< offered in place of the modes' sizes
  std::optional<v4l2_frmival_stepwise> any_rate;  ///< offered in place of the modes' rates
  std::optional<v4l2_fract> other_interval;       ///< what it keeps to, whatever it is asked for
  std::optional<std::pair<int, int>> other_size;  ///< what it gives, whatever it is asked for
  std::map<std::uint32_t, FakeControl> controls;
  std::uint32_t field = V4L2_FIELD_NONE;
  bool endless = false;  ///< never says that there are no more formats, sizes, rates, controls
  bool hasty = false;    ///< a picture is there whenever it is asked for one
  bool limited_range = false;  ///< of luma and chroma, but for JPEG
  std::size_t padding = 0;     ///< bytes at the end of each row, but for JPEG

  bool plugged = true;
  int open_error = 0;
  int busy_error = 0;              ///< of asking for buffers
  int calls_until_unplugged = -1;  ///< ioctls; -1: it stays
  int take_error = 0;              ///< of asking for a filled buffer, until it is opened anew
  bool hung_up = false;            ///< likewise
  Silence silence = Silence::None;
  bool monotonic = true;
  bool start_of_exposure = false;
  std::set<std::uint32_t> faulty, cut, garbled, skipped;  ///< sequence numbers of pictures

  int opened = 0;
  int calls = 0;                                               ///< ioctls
  int open = 0;                                                ///< now
  int streams = 0;                                             ///< begun
  int mapped = 0;                                              ///< buffers, now
  std::vector<std::pair<std::uint32_t, std::int32_t>> writes;  ///< to controls, also refused ones

  /// Out and, if it is out, in again: what was opened before stays dead.
  void unplug();
  void plug();
  int plugs = 0;
};

/// The controls of a common webcam, everything automatic.
std::map<std::uint32_t, FakeControl> webcam_controls();

/// A machine with these cameras.
class FakeVideo : public hal::v4l2::VideoSystem {
 public:
  FakeVideo(const hal::Clock& clock, std::vector<std::shared_ptr<FakeCamera>> cameras);
  ~FakeVideo() override;

  std::vector<hal::v4l2::Node> nodes() override;
  hal::v4l2::Opened open(const std::string& path) override;
  bool changed() override { return std::exchange(changed_, false); }
  int watch_fd() const override { return -1; }

  /// As udev does when something was plugged in.
  void announce() { changed_ = true; }

  /// Wakes who polls a camera: a picture is there.
  void wake();

 private:
  const hal::Clock& clock_;
  std::vector<std::shared_ptr<FakeCamera>> cameras_;
  bool changed_ = false;
  int event_fd_;
};

}  // namespace lumibox::testing
