#include <algorithm>
#include <type_traits>
#include <variant>

#include "bench/tracking_bench.h"

namespace lumibox::bench {
namespace {

/// A number of the configuration and the values it is tried at.
struct Setting {
  const char* name;
  std::variant<int config::Tracking::*, double config::Tracking::*> member;
  std::vector<double> values;
  Buys buys = Buys::Tracker;
};

const std::vector<Setting> kSettings{
    {"max_measurements", &config::Tracking::max_measurements, {100, 200, 400, 1200}},
    {"max_features_per_keyframe", &config::Tracking::max_features_per_keyframe, {300, 600, 2400}},
    {"pyramid_levels", &config::Tracking::pyramid_levels, {2, 3, 5}},
    {"search_radius_px", &config::Tracking::search_radius_px, {2, 3, 6, 10}},
    {"pose_iterations", &config::Tracking::pose_iterations, {1, 2, 5, 20}},
    {"local_keyframes", &config::Tracking::local_keyframes, {3, 5, 12}, Buys::Mapper},
    {"local_iterations", &config::Tracking::local_iterations, {1, 2, 10}, Buys::Mapper},
    {"global_iterations", &config::Tracking::global_iterations, {1, 2, 5, 10, 50}, Buys::Final},
};

double value_of(const config::Tracking& options, const Setting& setting) {
  return std::visit([&](auto member) { return static_cast<double>(options.*member); },
                    setting.member);
}

void set_value(config::Tracking& options, const Setting& setting, double value) {
  std::visit(
      [&](auto member) {
        options.*member = static_cast<std::remove_reference_t<decltype(options.*member)>>(value);
      },
      setting.member);
}

}  // namespace

std::vector<Variation> tracking_variations(const config::Tracking& options, int width) {
  std::vector<Variation> variations;
  for (const Setting& setting : kSettings) {
    const double chosen = value_of(options, setting);
    std::vector<double> values = setting.values;
    values.push_back(chosen);
    std::ranges::sort(values);
    const auto repeated = std::ranges::unique(values);
    values.erase(repeated.begin(), repeated.end());
    for (const double value : values) {
      Variation variation{setting.name, value, value == chosen, options, setting.buys};
      set_value(variation.options, setting, value);
      variations.push_back(variation);
    }
  }
  for (int halvings = 2; halvings >= 0; --halvings) {
    variations.push_back({"image_width", static_cast<double>(width >> halvings), halvings == 0,
                          options, Buys::Tracker, halvings});
  }
  return variations;
}

}  // namespace lumibox::bench
