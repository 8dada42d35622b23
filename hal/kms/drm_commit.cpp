#include "hal/kms/drm_commit.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <map>
#include <span>
#include <string>

namespace lumibox::hal::kms {
namespace {

/// Identifiers and values of all properties of an object, by name.
class Properties {
 public:
  struct Property {
    std::uint32_t id;
    std::uint64_t value;
  };

  Properties(int card, std::uint32_t object, std::uint32_t type) {
    const DrmProperties found(drmModeObjectGetProperties(card, object, type));
    if (!found) return;
    for (std::uint32_t i = 0; i < found->count_props; ++i) {
      const DrmProperty property(drmModeGetProperty(card, found->props[i]));
      if (property) by_name_[property->name] = {property->prop_id, found->prop_values[i]};
    }
  }

  const Property* find(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : &found->second;
  }

 private:
  std::map<std::string, Property> by_name_;
};

std::uint64_t value_of(int card, std::uint32_t object, std::uint32_t type, const char* name) {
  const Properties properties(card, object, type);
  const Properties::Property* property = properties.find(name);
  return property == nullptr ? 0 : property->value;
}

class LegacyCommit : public DrmCommit {
 public:
  explicit LegacyCommit(int card) : card_(card) {}

  int set_mode(const Pipe& pipe, const drmModeModeInfo& mode, std::uint32_t framebuffer) override {
    std::uint32_t connector = pipe.connector;
    drmModeModeInfo copy = mode;
    return std::abs(drmModeSetCrtc(card_, pipe.crtc, framebuffer, 0, 0, &connector, 1, &copy));
  }

  int flip(const Pipe& pipe, std::uint32_t framebuffer, std::uint64_t serial) override {
    return std::abs(drmModePageFlip(card_, pipe.crtc, framebuffer, DRM_MODE_PAGE_FLIP_EVENT,
                                    reinterpret_cast<void*>(serial)));
  }

 private:
  int card_;
};

/// A set of changes that the kernel makes all together or not at all.
class AtomicRequest {
 public:
  explicit AtomicRequest(int card) : card_(card), request_(drmModeAtomicAlloc()) {}

  void set(std::uint32_t object, const Properties& properties, const char* name,
           std::uint64_t value) {
    const Properties::Property* property = properties.find(name);
    if (property == nullptr ||
        drmModeAtomicAddProperty(request_.get(), object, property->id, value) < 0) {
      complete_ = false;
    }
  }

  int commit(std::uint32_t flags, std::uint64_t serial = 0) {
    if (!complete_) return EINVAL;
    return std::abs(
        drmModeAtomicCommit(card_, request_.get(), flags, reinterpret_cast<void*>(serial)));
  }

 private:
  int card_;
  DrmRequest request_;
  bool complete_ = true;
};

class AtomicCommit : public DrmCommit {
 public:
  explicit AtomicCommit(int card) : card_(card) {}

  int set_mode(const Pipe& pipe, const drmModeModeInfo& mode, std::uint32_t framebuffer) override {
    const auto plane = primary_plane(card_, pipe.crtc);
    if (!plane) return EINVAL;
    plane_ = *plane;
    plane_properties_.emplace(card_, plane_, DRM_MODE_OBJECT_PLANE);
    std::uint32_t blob = 0;
    const int error = std::abs(drmModeCreatePropertyBlob(card_, &mode, sizeof mode, &blob));
    if (error != 0) return error;
    AtomicRequest request(card_);
    take_others_off(request, pipe);
    const Properties connector(card_, pipe.connector, DRM_MODE_OBJECT_CONNECTOR);
    request.set(pipe.connector, connector, "CRTC_ID", pipe.crtc);
    const Properties crtc(card_, pipe.crtc, DRM_MODE_OBJECT_CRTC);
    request.set(pipe.crtc, crtc, "MODE_ID", blob);
    request.set(pipe.crtc, crtc, "ACTIVE", 1);
    fill_plane(request, pipe.crtc, mode, framebuffer);
    const int committed = request.commit(DRM_MODE_ATOMIC_ALLOW_MODESET);
    drmModeDestroyPropertyBlob(card_, blob);
    return committed;
  }

  int flip(const Pipe& /*pipe*/, std::uint32_t framebuffer, std::uint64_t serial) override {
    if (!plane_properties_) return EINVAL;
    AtomicRequest request(card_);
    request.set(plane_, *plane_properties_, "FB_ID", framebuffer);
    return request.commit(DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT, serial);
  }

 private:
  void fill_plane(AtomicRequest& request, std::uint32_t crtc, const drmModeModeInfo& mode,
                  std::uint32_t framebuffer) const {
    constexpr int kFraction = 16;  // bits behind the point of a place in the framebuffer
    const auto set = [&](const char* name, std::uint64_t value) {
      request.set(plane_, *plane_properties_, name, value);
    };
    set("FB_ID", framebuffer);
    set("CRTC_ID", crtc);
    set("SRC_X", 0);
    set("SRC_Y", 0);
    set("SRC_W", std::uint64_t{mode.hdisplay} << kFraction);
    set("SRC_H", std::uint64_t{mode.vdisplay} << kFraction);
    set("CRTC_X", 0);
    set("CRTC_Y", 0);
    set("CRTC_W", mode.hdisplay);
    set("CRTC_H", mode.vdisplay);
  }

  /// A console may show the same on several screens, of which not all need have our mode.
  void take_others_off(AtomicRequest& request, const Pipe& pipe) const {
    const DrmResources resources(drmModeGetResources(card_));
    if (!resources) return;
    const std::span connectors(resources->connectors,
                               static_cast<std::size_t>(resources->count_connectors));
    for (const std::uint32_t id : connectors) {
      if (id == pipe.connector) continue;
      const Properties properties(card_, id, DRM_MODE_OBJECT_CONNECTOR);
      const Properties::Property* driven_by = properties.find("CRTC_ID");
      if (driven_by != nullptr && driven_by->value == pipe.crtc) {
        request.set(id, properties, "CRTC_ID", 0);
      }
    }
  }

  int card_;
  std::uint32_t plane_ = 0;
  std::optional<Properties> plane_properties_;
};

}  // namespace

std::unique_ptr<DrmCommit> open_commit(int card) {
  drmSetClientCap(card, DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1);
  if (drmSetClientCap(card, DRM_CLIENT_CAP_ATOMIC, 1) == 0) {
    return std::make_unique<AtomicCommit>(card);
  }
  return std::make_unique<LegacyCommit>(card);
}

std::optional<std::uint32_t> primary_plane(int card, std::uint32_t crtc) {
  const DrmResources resources(drmModeGetResources(card));
  const DrmPlanes planes(drmModeGetPlaneResources(card));
  if (!resources || !planes) return std::nullopt;
  const std::span crtcs(resources->crtcs, static_cast<std::size_t>(resources->count_crtcs));
  const auto index = std::ranges::find(crtcs, crtc) - crtcs.begin();
  for (const std::uint32_t id : std::span(planes->planes, planes->count_planes)) {
    const DrmPlane plane(drmModeGetPlane(card, id));
    if (plane && (plane->possible_crtcs >> index & 1U) != 0 &&
        value_of(card, id, DRM_MODE_OBJECT_PLANE, "type") == DRM_PLANE_TYPE_PRIMARY) {
      return id;
    }
  }
  return std::nullopt;
}

}  // namespace lumibox::hal::kms
