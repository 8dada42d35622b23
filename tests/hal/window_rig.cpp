#include <linux/input-event-codes.h>

#include <array>

#include "hal/buttons_rig.h"
#include "hal/sim/virtual_clock.h"
#include "hal/window/window_buttons.h"

namespace lumibox::testing {
namespace {

/// Keys as a window tells of them.
class WindowRig : private hal::VirtualClock, public FingerRig {
 public:
  WindowRig() : FingerRig(static_cast<hal::VirtualClock&>(*this)) {}

  std::int64_t inaccuracy_ns() const override { return 0; }

 protected:
  void prepare() override {}
  std::unique_ptr<hal::Buttons> make() override {
    return std::make_unique<hal::WindowButtons>(keys_, config::Evdev{}, kRigStuckS, clock());
  }
  void move(hal::Button button, bool down) override {
    constexpr std::array<unsigned, 5> kKeys = {KEY_ENTER, KEY_R, KEY_UP, KEY_DOWN, KEY_BACKSPACE};
    keys_->push_back({kKeys.at(index_of(button)), down, clock().now_ns()});
  }

 private:
  std::shared_ptr<hal::KeyEdges> keys_ = std::make_shared<hal::KeyEdges>();
};

const ButtonsBackend kWindow{"Window", [] { return std::make_unique<WindowRig>(); }};

}  // namespace

INSTANTIATE_TEST_SUITE_P(Window, EveryButtons, ::testing::Values(kWindow), backend_name);

}  // namespace lumibox::testing
