#include <algorithm>
#include <functional>

#include "bench/tracking_bench.h"

namespace lumibox::bench {
namespace {

/// An integer of the configuration and the values it is tried at.
struct Setting {
  const char* name;
  int config::Tracking::*member;
  std::vector<int> values;
};

const std::vector<Setting> kSettings{
    {"max_measurements", &config::Tracking::max_measurements, {100, 200, 400, 1200}},
    {"max_features_per_keyframe", &config::Tracking::max_features_per_keyframe, {300, 600, 2400}},
    {"pyramid_levels", &config::Tracking::pyramid_levels, {2, 3, 5}},
    {"local_keyframes", &config::Tracking::local_keyframes, {3, 5, 12}},
};

}  // namespace

std::vector<Variation> tracking_variations(const config::Tracking& options, int width) {
  std::vector<Variation> variations;
  for (const Setting& setting : kSettings) {
    const int chosen = options.*setting.member;
    std::vector<int> values = setting.values;
    values.push_back(chosen);
    std::ranges::sort(values);
    const auto repeated = std::ranges::unique(values);
    values.erase(repeated.begin(), repeated.end());
    for (const int value : values) {
      Variation variation{setting.name, static_cast<double>(value), value == chosen, options};
      variation.options.*setting.member = value;
      variations.push_back(variation);
    }
  }
  for (int halvings = 2; halvings >= 0; --halvings) {
    variations.push_back(
        {"image_width", static_cast<double>(width >> halvings), halvings == 0, options, halvings});
  }
  return variations;
}

}  // namespace lumibox::bench
