#include "hal/buttons_rig.h"
#include "hal/scripted/scripted_buttons.h"
#include "hal/sim/virtual_clock.h"

namespace lumibox::testing {
namespace {

class ScriptedRig : public ButtonsRig {
 public:
  std::unique_ptr<hal::Buttons> open(std::vector<hal::ButtonEvent> plan) override {
    return std::make_unique<hal::ScriptedButtons>(std::move(plan), clock_);
  }
  void advance_to(std::int64_t at_ns) override { clock_.wait_until(at_ns); }
  std::int64_t opened_ns() const override { return 0; }
  std::int64_t inaccuracy_ns() const override { return 0; }

 private:
  hal::VirtualClock clock_;
};

const ButtonsBackend kScripted{"Scripted", [] { return std::make_unique<ScriptedRig>(); }};

}  // namespace

INSTANTIATE_TEST_SUITE_P(Scripted, EveryButtons, ::testing::Values(kScripted), backend_name);

}  // namespace lumibox::testing
