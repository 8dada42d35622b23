#include "hal/sim/image_stages.h"

#include <cmath>

#include "hal/sim/random.h"

namespace lumibox::hal::sim {

Vignetting::Vignetting(const VignettingSpec& spec, const config::CameraProfile& camera) {
  const auto radius2 = [&](double x, double y) {
    return (x - camera.cx) * (x - camera.cx) + (y - camera.cy) * (y - camera.cy);
  };
  const double right = camera.width - 1;
  const double bottom = camera.height - 1;
  const double farthest =
      std::max({radius2(0, 0), radius2(right, 0), radius2(0, bottom), radius2(right, bottom)});
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double r2 = radius2(x, y) / farthest;
      factors_.push_back(static_cast<float>(1.0 - (1.0 - spec.corner) * r2 * r2));
    }
  }
}

void Vignetting::apply(LinearImage& image, Exposure&) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] *= factors_[i];
}

void AutoExposure::apply(LinearImage& image, Exposure& exposure) {
  double sum = 0.0;
  for (const Color& pixel : image.pixels) sum += static_cast<double>(luminance(pixel));
  const double mean = std::max(sum / static_cast<double>(image.pixels.size()), 1e-9);
  const double wanted = std::clamp(spec_.target / mean, spec_.min_gain, spec_.max_gain);
  if (gain_ <= 0.0) {
    gain_ = std::clamp(1.0, spec_.min_gain, spec_.max_gain);
  } else if (!exposure.locked) {
    const double elapsed_s = exposure.time_s - last_time_s_;
    const double step = spec_.lag_s > 0.0 ? 1.0 - std::exp(-elapsed_s / spec_.lag_s) : 1.0;
    gain_ += step * (wanted - gain_);
  }
  last_time_s_ = exposure.time_s;
  exposure.gain = static_cast<float>(gain_);
  for (Color& pixel : image.pixels) pixel *= exposure.gain;
}

void SensorNoise::apply(LinearImage& image, Exposure& exposure) {
  Random random(spec_.seed ^ scramble(static_cast<std::uint64_t>(exposure.frame)));
  // A value of 1 is `electrons` electrons: with gain, fewer make a full signal.
  const double electrons = spec_.full_well / static_cast<double>(exposure.gain);
  for (Color& pixel : image.pixels) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double signal = std::max(0.0, static_cast<double>(pixel[c])) * electrons;
      const double sigma = std::sqrt(signal + spec_.read * spec_.read);
      pixel[c] = static_cast<float>((signal + sigma * random.normal()) / electrons);
    }
  }
}

std::vector<std::unique_ptr<ImageStage>> make_stages(const SceneSpec& spec) {
  const EffectSpecs& effects = spec.effects;
  std::vector<std::unique_ptr<ImageStage>> stages;
  if (effects.vignetting) {
    stages.push_back(std::make_unique<Vignetting>(*effects.vignetting, spec.camera));
  }
  if (effects.auto_exposure) {
    stages.push_back(std::make_unique<AutoExposure>(*effects.auto_exposure));
  }
  if (effects.sensor_noise) {
    stages.push_back(std::make_unique<SensorNoise>(*effects.sensor_noise));
  }
  return stages;
}

Image tone_mapped(const LinearImage& image, double exposure) {
  Image result(image.width, image.height, 3);
  const auto factor = static_cast<float>(exposure);
  const SrgbBytes& srgb_byte = SrgbBytes::table();
  std::uint8_t* byte = result.data();
  for (const Color& pixel : image.pixels) {
    for (Eigen::Index c = 0; c < 3; ++c) *byte++ = srgb_byte(factor * pixel[c]);
  }
  return result;
}

}  // namespace lumibox::hal::sim
