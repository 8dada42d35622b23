#pragma once

#include <libcamera/camera.h>
#include <libcamera/control_ids.h>
#include <libcamera/controls.h>
#include <libcamera/property_ids.h>
#include <libcamera/version.h>

#include "hal/libcamera/camera_system.h"

/// All in which the versions of libcamera differ, from 0.0.3 (Debian 12) on.
namespace lumibox::hal::libcam::versions {

#define LUMIBOX_LIBCAMERA(major, minor) \
  (LIBCAMERA_VERSION_MAJOR > (major) || \
   (LIBCAMERA_VERSION_MAJOR == (major) && LIBCAMERA_VERSION_MINOR >= (minor)))

inline bool has(const ::libcamera::ControlInfoMap& controls, const ::libcamera::ControlId& id) {
  return controls.count(&id) != 0;
}

/// Pictures upright, however the sensor is built in. Before 0.2 the library did not see to that.
inline void make_upright(::libcamera::CameraConfiguration& configuration,
                         [[maybe_unused]] const ::libcamera::ControlList& properties) {
#if LUMIBOX_LIBCAMERA(0, 2)
  configuration.orientation = ::libcamera::Orientation::Rotate0;
#else
  const auto rotation_deg = properties.get(::libcamera::properties::Rotation);
  configuration.transform =
      rotation_deg == 180 ? ::libcamera::Transform::Rot180 : ::libcamera::Transform::Identity;
#endif
}

/// From 0.5 on exposure time and gain are switched to manual one by one.
inline bool can_hold_exposure(const ::libcamera::ControlInfoMap& controls) {
#if LUMIBOX_LIBCAMERA(0, 5)
  if (has(controls, ::libcamera::controls::ExposureTimeMode)) return true;
#endif
  return has(controls, ::libcamera::controls::AeEnable);
}

inline void switch_exposure(bool automatic, const ::libcamera::ControlInfoMap& controls,
                            ::libcamera::ControlList& list) {
  namespace ids = ::libcamera::controls;
#if LUMIBOX_LIBCAMERA(0, 5)
  const bool has_modes = has(controls, ids::ExposureTimeMode);
  if (has_modes) {
    list.set(ids::ExposureTimeMode,
             automatic ? ids::ExposureTimeModeAuto : ids::ExposureTimeModeManual);
  }
  if (has(controls, ids::AnalogueGainMode)) {
    list.set(ids::AnalogueGainMode,
             automatic ? ids::AnalogueGainModeAuto : ids::AnalogueGainModeManual);
  }
  if (has_modes) return;
#endif
  if (has(controls, ids::AeEnable)) list.set(ids::AeEnable, automatic);
}

}  // namespace lumibox::hal::libcam::versions
