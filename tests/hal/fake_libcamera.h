#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hal/clock.h"
#include "hal/fake_pictures.h"
#include "hal/libcamera/camera_system.h"

namespace lumibox::testing {

hal::libcam::Offer offer(hal::live::PixelFormat format, std::uint32_t width, std::uint32_t height);

/// A camera in memory as libcamera shows one: what it offers, how it misbehaves, and what was done
/// with it. It makes the pictures picture_of() says, one each frame duration of the clock, into the
/// requests that it has.
struct FakeSensor {
  std::string id = "/base/i2c@1/fake@1a";
  std::string model = "fake";
  std::vector<hal::libcam::Offer> offers = {offer(hal::live::PixelFormat::Nv12, 32, 24)};
  hal::libcam::Abilities abilities{true, true, true,
                                   std::pair<std::int64_t, std::int64_t>{10'000, 100'000}};
  std::optional<hal::libcam::Configured> gives;  ///< whatever it is asked for
  bool limited_range = false;
  std::size_t padding = 0;    ///< bytes at the end of each row
  bool in_one_piece = false;  ///< all planes
  std::size_t spare = 0;      ///< bytes at the end of each plane, as of rows that no picture has
  bool says_exposure_begin = true;

  /// What it does by itself now, and says of its pictures.
  hal::libcam::Adjustments own{10'000, 2.0F, {{1.5F, 1.8F}}, 1.0F};
  int latency = 3;  ///< pictures until an order shows
  int deaf = 0;     ///< to so many orders to come
  bool freezes =
      false;  ///< what it does when it is told to stop adjusting, whatever values it is told
  hal::libcam::Adjustments now;  ///< of the picture that was made last

  bool plugged = true;
  bool cancels = true;  ///< its requests, when it is unplugged
  int plugs = 0;
  int calls_until_unplugged = -1;  ///< -1: it stays
  int open_error = 0;
  int start_error = 0;
  int queue_error = 0;  ///< until it is opened anew
  Silence silence = Silence::None;
  std::set<std::uint32_t> faulty, cancelled, cut, skipped;  ///< sequence numbers of pictures

  int opened = 0;
  int open = 0;                             ///< now
  int streams = 0;                          ///< begun
  std::vector<hal::libcam::Orders> orders;  ///< all that it was told

  void unplug();
};

/// A machine with these cameras.
class FakeLibcamera : public hal::libcam::CameraSystem {
 public:
  FakeLibcamera(const hal::Clock& clock, std::vector<std::shared_ptr<FakeSensor>> sensors);
  ~FakeLibcamera() override;

  std::vector<hal::libcam::CameraName> cameras() override;
  hal::libcam::Opened open(const std::string& id) override;
  bool changed() override { return std::exchange(changed_, false); }
  int watch_fd() const override { return -1; }

  void announce() { changed_ = true; }

  /// Wakes who polls a camera: a picture is there.
  void wake();

 private:
  const hal::Clock& clock_;
  std::vector<std::shared_ptr<FakeSensor>> sensors_;
  bool changed_ = false;
  int event_fd_;
};

}  // namespace lumibox::testing
