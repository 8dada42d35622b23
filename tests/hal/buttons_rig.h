#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "hal/buttons.h"
#include "hal/clock.h"

// How the tests of buttons_contract_test.cpp press the buttons of one backend. A new backend writes
// a rig, and adds it to EveryButtons and, if a finger presses it, to HardwareButtons; a rig that
// this machine cannot have says why, and its tests are skipped.
namespace lumibox::testing {

/// Held for longer than this, a button of a rig is stuck.
inline constexpr double kRigStuckS = 1.0;

/// Buttons, and what presses them.
class ButtonsRig {
 public:
  virtual ~ButtonsRig() = default;

  /// Why this machine cannot have such buttons; empty if it can.
  virtual std::string missing() const { return {}; }

  /// Buttons that are going to be pressed as `plan` says, whose times count from now; those before
  /// zero have been pressed already.
  virtual std::unique_ptr<hal::Buttons> open(std::vector<hal::ButtonEvent> plan) = 0;

  /// The plan is followed until so long after open(), and the clock says so.
  virtual void advance_to(std::int64_t at_ns) = 0;

  virtual std::int64_t opened_ns() const = 0;      ///< clock time of open()
  virtual std::int64_t inaccuracy_ns() const = 0;  ///< of a finger
};

/// A rig whose buttons are moved at their time, on its clock.
class FingerRig : public ButtonsRig {
 public:
  explicit FingerRig(hal::Clock& clock) : clock_(clock) {}

  std::unique_ptr<hal::Buttons> open(std::vector<hal::ButtonEvent> plan) final {
    plan_ = std::move(plan);
    prepare();
    opened_ns_ = clock_.now_ns();
    move_until(-1);
    std::unique_ptr<hal::Buttons> buttons = make();
    opened_ns_ = clock_.now_ns();
    return buttons;
  }

  void advance_to(std::int64_t at_ns) final {
    move_until(at_ns);
    clock_.wait_until(opened_ns_ + at_ns);
  }

  std::int64_t opened_ns() const final { return opened_ns_; }

 protected:
  virtual void prepare() = 0;  ///< the device
  virtual std::unique_ptr<hal::Buttons> make() = 0;
  virtual void move(hal::Button button, bool down) = 0;
  hal::Clock& clock() { return clock_; }

 private:
  void move_until(std::int64_t at_ns) {
    for (; next_ < plan_.size() && plan_[next_].timestamp_ns <= at_ns; ++next_) {
      clock_.wait_until(opened_ns_ + plan_[next_].timestamp_ns);
      move(plan_[next_].button, plan_[next_].action == hal::ButtonAction::Pressed);
    }
  }

  hal::Clock& clock_;
  std::vector<hal::ButtonEvent> plan_;
  std::size_t next_ = 0;
  std::int64_t opened_ns_ = 0;
};

struct ButtonsBackend {
  const char* name;
  std::function<std::unique_ptr<ButtonsRig>()> make_rig;
};

/// gtest names the tests by the backend, and says which it was.
inline void PrintTo(const ButtonsBackend& backend, std::ostream* out) {
  *out << backend.name;
}

inline std::string backend_name(const ::testing::TestParamInfo<ButtonsBackend>& info) {
  return info.param.name;
}

class ButtonsTest : public ::testing::TestWithParam<ButtonsBackend> {
 protected:
  void SetUp() override {
    if (const std::string missing = rig_->missing(); !missing.empty()) {
      GTEST_SKIP() << missing;
    }
  }

  /// Opens the buttons, and polls them in the beat of a loop until so long after that.
  std::vector<hal::ButtonEvent> play(std::vector<hal::ButtonEvent> plan, std::int64_t until_ns,
                                     std::int64_t beat_ns = 20'000'000) {
    buttons_ = rig_->open(std::move(plan));
    return go_on(0, until_ns, beat_ns);
  }

  /// Times count from open(), as those of the plan do.
  std::vector<hal::ButtonEvent> go_on(std::int64_t from_ns, std::int64_t until_ns,
                                      std::int64_t beat_ns = 20'000'000) {
    std::vector<hal::ButtonEvent> all;
    for (std::int64_t at_ns = from_ns; at_ns <= until_ns; at_ns += beat_ns) {
      rig_->advance_to(at_ns);
      for (hal::ButtonEvent event : buttons_->poll()) {
        event.timestamp_ns -= rig_->opened_ns();
        all.push_back(event);
      }
    }
    return all;
  }

  /// The same edges, each at its time.
  void expect_told(const std::vector<hal::ButtonEvent>& told,
                   const std::vector<hal::ButtonEvent>& meant) {
    ASSERT_EQ(told.size(), meant.size());
    for (std::size_t i = 0; i < told.size(); ++i) {
      EXPECT_EQ(told[i].button, meant[i].button) << i;
      EXPECT_EQ(told[i].action, meant[i].action) << i;
      EXPECT_GE(told[i].timestamp_ns, meant[i].timestamp_ns) << i;
      EXPECT_LE(told[i].timestamp_ns, meant[i].timestamp_ns + rig_->inaccuracy_ns()) << i;
    }
  }

  std::unique_ptr<ButtonsRig> rig_ = GetParam().make_rig();
  std::unique_ptr<hal::Buttons> buttons_;
};

/// All backends.
class EveryButtons : public ButtonsTest {};

/// Those that a finger presses.
class HardwareButtons : public ButtonsTest {};

}  // namespace lumibox::testing
