#include "app/lamp.h"

namespace lumibox::app {
namespace {

/// Long enough to be seen.
constexpr std::int64_t kBlinkNs = 100'000'000;

}  // namespace

bool Lamp::is_lit(bool recording, bool recorded, std::int64_t now_ns) {
  if (recorded) {
    dark_until_ns_ = now_ns + kBlinkNs;
  }
  return recording && now_ns >= dark_until_ns_;
}

}  // namespace lumibox::app
