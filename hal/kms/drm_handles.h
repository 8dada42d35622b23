#pragma once

#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <memory>
#include <utility>

namespace lumibox::hal::kms {

/// Frees what libdrm hands out.
template <auto free>
struct Free {
  template <typename T>
  void operator()(T* pointer) const {
    free(pointer);
  }
};

using DrmResources = std::unique_ptr<drmModeRes, Free<drmModeFreeResources>>;
using DrmConnector = std::unique_ptr<drmModeConnector, Free<drmModeFreeConnector>>;
using DrmEncoder = std::unique_ptr<drmModeEncoder, Free<drmModeFreeEncoder>>;
using DrmCrtc = std::unique_ptr<drmModeCrtc, Free<drmModeFreeCrtc>>;
using DrmPlane = std::unique_ptr<drmModePlane, Free<drmModeFreePlane>>;
using DrmPlanes = std::unique_ptr<drmModePlaneRes, Free<drmModeFreePlaneResources>>;
using DrmProperty = std::unique_ptr<drmModePropertyRes, Free<drmModeFreeProperty>>;
using DrmProperties = std::unique_ptr<drmModeObjectProperties, Free<drmModeFreeObjectProperties>>;
using DrmRequest = std::unique_ptr<drmModeAtomicReq, Free<drmModeAtomicFree>>;

/// Owns an open file.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace lumibox::hal::kms
