#include "hal/kms/drm_card.h"

#include <drm_fourcc.h>
#include <fcntl.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <span>

#include "hal/device_files.h"

namespace lumibox::hal::kms {
namespace {

using SteadyClock = std::chrono::steady_clock;  // what poll() counts: how much a signal left of it

Outcome outcome_of(int error) {
  if (error == 0) return Outcome::Done;
  const bool taken = error == EACCES || error == EPERM || error == EBUSY;
  return taken ? Outcome::NotMaster : Outcome::Refused;
}

static_assert(sizeof(drmModeModeInfo) == kTimingBytes);

double refresh_of(const drmModeModeInfo& mode) {
  double hz = 1000.0 * mode.clock / std::max(1.0, 1.0 * mode.htotal * mode.vtotal);
  if ((mode.flags & DRM_MODE_FLAG_INTERLACE) != 0) hz *= 2.0;
  if ((mode.flags & DRM_MODE_FLAG_DBLSCAN) != 0) hz /= 2.0;
  return hz;
}

Mode mode_of(const drmModeModeInfo& info) {
  Mode mode;
  mode.size = {info.hdisplay, info.vdisplay};
  mode.refresh_hz = refresh_of(info);
  mode.preferred = (info.type & DRM_MODE_TYPE_PREFERRED) != 0;
  mode.interlaced = (info.flags & DRM_MODE_FLAG_INTERLACE) != 0;
  std::memcpy(mode.timing.data(), &info, sizeof info);
  return mode;
}

std::string name_of(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type == nullptr ? "screen" : type) + "-" +
         std::to_string(connector.connector_type_id);
}

template <typename Count>
auto list_of(std::uint32_t* first, Count count) {
  return std::span<const std::uint32_t>(first, static_cast<std::size_t>(count));
}

}  // namespace

DrmCard::DrmCard(File file) : file_(std::move(file)), commit_(open_commit(descriptor())) {}

DrmCard::~DrmCard() {
  for (Before& before : before_) {
    if (before.crtc->buffer_id == 0 || before.crtc->mode_valid == 0) continue;
    drmModeSetCrtc(descriptor(), before.crtc->crtc_id, before.crtc->buffer_id, before.crtc->x,
                   before.crtc->y, &before.connector, 1, &before.crtc->mode);
  }
}

std::vector<Connector> DrmCard::connectors(Probe probe) {
  const DrmResources resources(drmModeGetResources(descriptor()));
  if (!resources) return {};
  std::vector<Connector> connectors;
  for (const std::uint32_t id : list_of(resources->connectors, resources->count_connectors)) {
    const DrmConnector found(probe == Probe::Yes ? drmModeGetConnector(descriptor(), id)
                                                 : drmModeGetConnectorCurrent(descriptor(), id));
    if (!found) continue;
    Connector connector{id, name_of(*found), found->connection == DRM_MODE_CONNECTED, {}, {}};
    for (const auto& mode : std::span(found->modes, static_cast<std::size_t>(found->count_modes))) {
      connector.modes.push_back(mode_of(mode));
    }
    connector.crtcs = crtcs_of(*resources, *found);
    connectors.push_back(std::move(connector));
  }
  return connectors;
}

std::vector<std::uint32_t> DrmCard::crtcs_of(const drmModeRes& resources,
                                             const drmModeConnector& connector) const {
  std::vector<std::uint32_t> crtcs;
  const auto add = [&](std::uint32_t crtc) {
    if (crtc != 0 && std::ranges::find(crtcs, crtc) == crtcs.end()) crtcs.push_back(crtc);
  };
  const DrmEncoder current(drmModeGetEncoder(descriptor(), connector.encoder_id));
  if (current) add(current->crtc_id);
  const auto all = list_of(resources.crtcs, resources.count_crtcs);
  for (const std::uint32_t id : list_of(connector.encoders, connector.count_encoders)) {
    const DrmEncoder encoder(drmModeGetEncoder(descriptor(), id));
    if (!encoder) continue;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((encoder->possible_crtcs >> i & 1U) != 0) add(all[i]);
    }
  }
  return crtcs;
}

Outcome DrmCard::set_mode(const Pipe& pipe, const Mode& mode, std::uint32_t framebuffer) {
  remember(pipe);
  drmModeModeInfo info{};
  std::memcpy(&info, mode.timing.data(), sizeof info);
  return outcome_of(commit_->set_mode(pipe, info, framebuffer));
}

void DrmCard::remember(const Pipe& pipe) {
  const bool known = std::ranges::any_of(
      before_, [&](const Before& before) { return before.crtc->crtc_id == pipe.crtc; });
  if (known) return;
  DrmCrtc crtc(drmModeGetCrtc(descriptor(), pipe.crtc));
  if (crtc) before_.push_back({pipe.connector, std::move(crtc)});
}

Outcome DrmCard::flip(const Pipe& pipe, std::uint32_t framebuffer, std::uint64_t serial) {
  return outcome_of(commit_->flip(pipe, framebuffer, serial));
}

std::optional<std::uint64_t> DrmCard::wait_for_flip(std::int64_t timeout_ns) {
  const auto deadline = SteadyClock::now() + std::chrono::nanoseconds(timeout_ns);
  while (ended_flips_.empty()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - SteadyClock::now());
    pollfd waited_for{descriptor(), POLLIN, 0};
    const int ready =
        poll(&waited_for, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return std::nullopt;
    if ((waited_for.revents & POLLIN) == 0) return std::nullopt;  // the card itself is gone
    read_events();
  }
  const std::uint64_t serial = ended_flips_.front();
  ended_flips_.pop_front();
  return serial;
}

void DrmCard::read_events() {
  std::array<std::byte, 1024> bytes{};
  const ssize_t count = read(descriptor(), bytes.data(), bytes.size());
  std::size_t left = count < 0 ? 0 : static_cast<std::size_t>(count);
  for (const std::byte* at = bytes.data(); left >= sizeof(drm_event);) {
    drm_event_vblank event{};
    std::memcpy(&event, at, std::min(left, sizeof event));
    if (event.base.length < sizeof(drm_event) || event.base.length > left) return;
    if (event.base.type == DRM_EVENT_FLIP_COMPLETE) ended_flips_.push_back(event.user_data);
    at += event.base.length;
    left -= event.base.length;
  }
}

bool DrmCard::take_master() {
  return drmIsMaster(descriptor()) != 0 || drmSetMaster(descriptor()) == 0;
}

void DrmCard::drop_master() {
  drmDropMaster(descriptor());
}

std::vector<std::uint32_t> DrmCard::formats(const Pipe& pipe) const {
  const auto id = primary_plane(descriptor(), pipe.crtc);
  const DrmPlane plane(id ? drmModeGetPlane(descriptor(), *id) : nullptr);
  if (!plane) return {DRM_FORMAT_XRGB8888};  // what all had before drivers could tell
  const auto all = list_of(plane->formats, plane->count_formats);
  return {all.begin(), all.end()};
}

OpenCard open_card(const std::string& asked_for, const std::optional<ModeWish>& wish) {
  std::vector<CardFound> found;
  std::vector<std::unique_ptr<DrmCard>> cards;
  const std::vector<std::filesystem::path> asked = {asked_for};
  for (const auto& path : asked_for.empty() ? device_files("/dev/dri", "card") : asked) {
    File file(open(path.c_str(), O_RDWR | O_CLOEXEC));
    CardFound& card = found.emplace_back();
    card.path = path.string();
    card.error = file.descriptor() < 0 ? errno : 0;
    cards.emplace_back();
    if (card.error != 0) continue;
    card.sets_modes = drmIsKMS(file.descriptor()) != 0;
    cards.back() = std::make_unique<DrmCard>(std::move(file));
    card.connectors = cards.back()->connectors(Probe::Yes);
  }
  const std::size_t chosen = choose_card(found, asked_for, wish);
  return {std::move(cards[chosen]), found[chosen].path,
          *choose_output(found[chosen].connectors, wish)};
}

}  // namespace lumibox::hal::kms
