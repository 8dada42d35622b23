#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hal/kms/card.h"
#include "hal/kms/drm_handles.h"

namespace lumibox::hal::kms {

/// How the kernel is told what to show. Each returns 0 or an errno.
class DrmCommit {
 public:
  virtual ~DrmCommit() = default;
  virtual int set_mode(const Pipe& pipe, const drmModeModeInfo& mode,
                       std::uint32_t framebuffer) = 0;
  virtual int flip(const Pipe& pipe, std::uint32_t framebuffer, std::uint64_t serial) = 0;
};

/// Atomic where the driver has it, else as it was before (drmModeSetCrtc, drmModePageFlip). `card`
/// is an open card and must stay open.
std::unique_ptr<DrmCommit> open_commit(int card);

/// The plane that covers the whole screen of this scanout engine, if the driver tells.
std::optional<std::uint32_t> primary_plane(int card, std::uint32_t crtc);

}  // namespace lumibox::hal::kms
