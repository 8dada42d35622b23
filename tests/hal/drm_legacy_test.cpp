// A driver that has no atomic mode setting, as older and simpler ones: the calls of libdrm that
// DrmCard makes of it are answered here, and do what the library's own header says.

#include <drm_fourcc.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "config/log.h"
#include "hal/fake_card.h"
#include "hal/kms/drm_card.h"

namespace {

constexpr std::uint32_t kConnector = 41;
constexpr std::uint32_t kEncoder = 51;
constexpr std::uint32_t kIdleCrtc = 61;
constexpr std::uint32_t kCrtc = 62;  ///< which shows the console

drmModeModeInfo timing(std::uint16_t width, std::uint16_t height) {
  drmModeModeInfo info{};
  info.hdisplay = width;
  info.vdisplay = height;
  info.htotal = 800;
  info.vtotal = 525;
  info.clock = 25'200;  // kHz: 60 Hz
  info.type = DRM_MODE_TYPE_PREFERRED;
  return info;
}

struct SetCrtc {
  std::uint32_t crtc, framebuffer, connector;
  int width, height;
  bool operator==(const SetCrtc&) const = default;
};

struct Flip {
  std::uint32_t crtc, framebuffer, flags;
  std::uint64_t serial;
  bool operator==(const Flip&) const = default;
};

/// The driver, and what it was told.
struct Driver {
  std::array<drmModeModeInfo, 1> modes = {timing(640, 480)};
  std::array<std::uint32_t, 1> encoders = {kEncoder};
  std::array<std::uint32_t, 1> connectors = {kConnector};
  std::array<std::uint32_t, 2> crtcs = {kIdleCrtc, kCrtc};
  int error = 0;  ///< of setting modes and flipping
  bool is_master = true;
  std::vector<SetCrtc> set;
  std::vector<Flip> flips;
};

Driver driver;

}  // namespace

extern "C" {

int drmSetClientCap(int /*fd*/, std::uint64_t capability, std::uint64_t /*value*/) {
  return capability == DRM_CLIENT_CAP_ATOMIC ? -EOPNOTSUPP : 0;
}

drmModeResPtr drmModeGetResources(int /*fd*/) {
  auto* const resources = new drmModeRes{};
  resources->count_connectors = static_cast<int>(driver.connectors.size());
  resources->connectors = driver.connectors.data();
  resources->count_crtcs = static_cast<int>(driver.crtcs.size());
  resources->crtcs = driver.crtcs.data();
  return resources;
}
void drmModeFreeResources(drmModeResPtr resources) {
  delete resources;
}

drmModeConnectorPtr drmModeGetConnector(int /*fd*/, std::uint32_t id) {
  auto* const connector = new drmModeConnector{};
  connector->connector_id = id;
  connector->connector_type = DRM_MODE_CONNECTOR_HDMIA;
  connector->connector_type_id = 1;
  connector->connection = DRM_MODE_CONNECTED;
  connector->encoder_id = kEncoder;
  connector->count_modes = static_cast<int>(driver.modes.size());
  connector->modes = driver.modes.data();
  connector->count_encoders = static_cast<int>(driver.encoders.size());
  connector->encoders = driver.encoders.data();
  return connector;
}
drmModeConnectorPtr drmModeGetConnectorCurrent(int fd, std::uint32_t id) {
  return drmModeGetConnector(fd, id);
}
void drmModeFreeConnector(drmModeConnectorPtr connector) {
  delete connector;
}

drmModeEncoderPtr drmModeGetEncoder(int /*fd*/, std::uint32_t id) {
  return new drmModeEncoder{id, 0, kCrtc, /*possible_crtcs=*/3, 0};
}
void drmModeFreeEncoder(drmModeEncoderPtr encoder) {
  delete encoder;
}

drmModeCrtcPtr drmModeGetCrtc(int /*fd*/, std::uint32_t id) {
  auto* const crtc = new drmModeCrtc{};
  crtc->crtc_id = id;
  crtc->buffer_id = id == kCrtc ? 7 : 0;
  crtc->mode_valid = id == kCrtc ? 1 : 0;
  crtc->mode = timing(1280, 720);
  return crtc;
}
void drmModeFreeCrtc(drmModeCrtcPtr crtc) {
  delete crtc;
}

drmModePlaneResPtr drmModeGetPlaneResources(int /*fd*/) {
  return nullptr;
}

int drmModeSetCrtc(int /*fd*/, std::uint32_t crtc, std::uint32_t framebuffer, std::uint32_t /*x*/,
                   std::uint32_t /*y*/, std::uint32_t* connectors, int count,
                   drmModeModeInfoPtr mode) {
  EXPECT_EQ(count, 1);
  if (driver.error != 0) return -driver.error;
  driver.set.push_back({crtc, framebuffer, *connectors, mode->hdisplay, mode->vdisplay});
  return 0;
}

int drmModePageFlip(int /*fd*/, std::uint32_t crtc, std::uint32_t framebuffer, std::uint32_t flags,
                    void* user_data) {
  if (driver.error != 0) return -driver.error;
  driver.flips.push_back({crtc, framebuffer, flags, reinterpret_cast<std::uint64_t>(user_data)});
  return 0;
}

int drmIsMaster(int /*fd*/) {
  return driver.is_master ? 1 : 0;
}
int drmSetMaster(int /*fd*/) {
  return driver.is_master ? 0 : -EACCES;
}

}  // extern "C"

namespace lumibox::hal::kms {
namespace {

using ::testing::ElementsAre;
using ::testing::Optional;

class LegacyDriver : public ::testing::Test {
 protected:
  LegacyDriver() {
    driver = Driver();
    EXPECT_EQ(pipe(ends_.data()), 0);
    card_.emplace(File(ends_[0]));
    output_ = *choose_output(card_->connectors(Probe::Yes), std::nullopt);
  }
  ~LegacyDriver() override { close(ends_[1]); }

  /// The kernel tells of something that has happened.
  void tell(std::uint32_t type, std::uint64_t serial) const {
    drm_event_vblank event{};
    event.base = {type, sizeof event};
    event.user_data = serial;
    EXPECT_EQ(write(ends_[1], &event, sizeof event), static_cast<ssize_t>(sizeof event));
  }

  std::array<int, 2> ends_{};  ///< of a pipe, which the card is read from
  std::optional<DrmCard> card_;
  Output output_;
};

TEST_F(LegacyDriver, ItsScreenIsDrivenByTheEngineThatAlreadyDoes) {
  EXPECT_EQ(output_.name, "HDMI-A-1");
  EXPECT_EQ(name_of(output_.mode), "640x480@60");
  EXPECT_EQ(output_.pipe.connector, kConnector);
  EXPECT_EQ(output_.pipe.crtc, kCrtc);
  EXPECT_THAT(card_->formats(output_.pipe), ElementsAre(DRM_FORMAT_XRGB8888)) << "it has no planes";
}

TEST_F(LegacyDriver, SetsAModeAndFlips) {
  EXPECT_EQ(card_->set_mode(output_.pipe, output_.mode, 1), Outcome::Done);
  EXPECT_THAT(driver.set, ElementsAre(SetCrtc{kCrtc, 1, kConnector, 640, 480}));
  EXPECT_EQ(card_->flip(output_.pipe, 2, 33), Outcome::Done);
  EXPECT_THAT(driver.flips, ElementsAre(Flip{kCrtc, 2, DRM_MODE_PAGE_FLIP_EVENT, 33}));
  EXPECT_EQ(card_->wait_for_flip(0), std::nullopt);
  tell(DRM_EVENT_VBLANK, 32);
  tell(DRM_EVENT_FLIP_COMPLETE, 33);
  tell(DRM_EVENT_FLIP_COMPLETE, 34);
  EXPECT_THAT(card_->wait_for_flip(0), Optional(33U));
  EXPECT_THAT(card_->wait_for_flip(0), Optional(34U));
  EXPECT_EQ(card_->wait_for_flip(0), std::nullopt);
}

TEST_F(LegacyDriver, SaysWhetherTheCardIsTakenOrTheModeImpossible) {
  for (const auto& [error, outcome] :
       {std::pair(EACCES, Outcome::NotMaster), std::pair(EPERM, Outcome::NotMaster),
        std::pair(EBUSY, Outcome::NotMaster), std::pair(EINVAL, Outcome::Refused),
        std::pair(ENOSPC, Outcome::Refused)}) {
    driver.error = error;
    EXPECT_EQ(card_->set_mode(output_.pipe, output_.mode, 1), outcome) << error;
    EXPECT_EQ(card_->flip(output_.pipe, 2, 1), outcome) << error;
  }
  EXPECT_TRUE(card_->take_master());
  driver.is_master = false;
  EXPECT_FALSE(card_->take_master());
}

TEST_F(LegacyDriver, TheConsoleIsShownAgainInTheEndAndNoOtherScreenSwitchedOn) {
  card_->set_mode(output_.pipe, output_.mode, 1);
  card_->set_mode({kIdleCrtc, kConnector}, output_.mode, 2);
  driver.set.clear();
  card_.reset();
  EXPECT_THAT(driver.set, ElementsAre(SetCrtc{kCrtc, 7, kConnector, 1280, 720}));
}

// The way of pictures as it is on every card, with this driver below.
TEST_F(LegacyDriver, PicturesComeOnTheScreenOneFlipAtATime) {
  config::set_log_level("off");
  VirtualClock clock;
  FakeBuffers buffers;
  Scanout scanout(*card_, nullptr, buffers, clock, std::nullopt, output_);
  scanout.present();
  ASSERT_EQ(driver.set.size(), 1U);
  for (std::uint64_t serial = 1; serial <= 5; ++serial) {
    scanout.present();
    ASSERT_EQ(driver.flips.size(), serial);
    tell(DRM_EVENT_FLIP_COMPLETE, driver.flips.back().serial);
  }
  EXPECT_EQ(scanout.presented(), 5) << "the last is under way";
  EXPECT_TRUE(scanout.showing());
  driver.error = EACCES;
  scanout.present();
  EXPECT_FALSE(scanout.showing());
}

}  // namespace
}  // namespace lumibox::hal::kms
