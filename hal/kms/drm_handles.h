#pragma once

#include <xf86drm.h>
#include <xf86drmMode.h>

#include <memory>

#include "hal/owned.h"

namespace lumibox::hal::kms {

using DrmResources = std::unique_ptr<drmModeRes, Freed<drmModeFreeResources>>;
using DrmConnector = std::unique_ptr<drmModeConnector, Freed<drmModeFreeConnector>>;
using DrmEncoder = std::unique_ptr<drmModeEncoder, Freed<drmModeFreeEncoder>>;
using DrmCrtc = std::unique_ptr<drmModeCrtc, Freed<drmModeFreeCrtc>>;
using DrmPlane = std::unique_ptr<drmModePlane, Freed<drmModeFreePlane>>;
using DrmPlanes = std::unique_ptr<drmModePlaneRes, Freed<drmModeFreePlaneResources>>;
using DrmProperty = std::unique_ptr<drmModePropertyRes, Freed<drmModeFreeProperty>>;
using DrmProperties = std::unique_ptr<drmModeObjectProperties, Freed<drmModeFreeObjectProperties>>;
using DrmRequest = std::unique_ptr<drmModeAtomicReq, Freed<drmModeAtomicFree>>;

}  // namespace lumibox::hal::kms
