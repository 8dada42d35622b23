#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "hal/image.h"
#include "hal/sim/color.h"
#include "hal/sim/scene_spec.h"

namespace lumibox::hal::sim {

/// What the stages of one picture tell each other.
struct Exposure {
  std::int64_t frame = 0;
  double time_s = 0.0;
  bool locked = false;  ///< the application holds the exposure
  float gain = 1.0f;    ///< of the sensor, so far
};

/// Something that happens to a picture between the lens and the application.
class ImageStage {
 public:
  virtual ~ImageStage() = default;
  virtual std::string name() const = 0;
  virtual void apply(LinearImage& image, Exposure& exposure) = 0;
};

/// Brightness falls with the fourth power of the radius, to `corner` in the corners.
class Vignetting : public ImageStage {
 public:
  Vignetting(const VignettingSpec& spec, const config::CameraProfile& camera);
  std::string name() const override { return "vignetting"; }
  void apply(LinearImage& image, Exposure& exposure) override;

 private:
  std::vector<float> factors_;  ///< per pixel
};

/// The sensor's gain follows the brightness of the pictures, first order in time, or stands still
/// while the exposure is locked.
class AutoExposure : public ImageStage {
 public:
  explicit AutoExposure(const AutoExposureSpec& spec) : spec_(spec) {}
  std::string name() const override { return "auto_exposure"; }
  void apply(LinearImage& image, Exposure& exposure) override;

 private:
  AutoExposureSpec spec_;
  double gain_ = 0.0;  ///< 0 before the first picture
  double last_time_s_ = 0.0;
};

/// Photons arrive at random (variance = electrons) and reading them adds noise; the gain amplifies
/// both. Normal approximation of the Poisson distribution, seeded per frame: any frame can be had
/// alone.
class SensorNoise : public ImageStage {
 public:
  explicit SensorNoise(const SensorNoiseSpec& spec) : spec_(spec) {}
  std::string name() const override { return "sensor_noise"; }
  void apply(LinearImage& image, Exposure& exposure) override;

 private:
  SensorNoiseSpec spec_;
};

/// The stages that a scene's effects call for, in the order light and signal meet them.
std::vector<std::unique_ptr<ImageStage>> make_stages(const SceneSpec& spec);

/// The last stage: linear light to sRGB bytes.
Image tone_mapped(const LinearImage& image, double exposure);

}  // namespace lumibox::hal::sim
