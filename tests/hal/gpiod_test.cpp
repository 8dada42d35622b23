#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/buttons_rig.h"
#include "hal/fake_gpio.h"
#include "hal/gpiod/gpiod_buttons.h"
#include "hal/gpiod/gpiod_led.h"
#include "hal/sim/virtual_clock.h"
#include "support/input_error.h"

// The gpiod backend on a library that is not there: this file is compiled into two programs, one
// for each of the programming interfaces that libgpiod has had.
namespace lumibox::testing {

using hal::Button;
using hal::ButtonAction;
using hal::ButtonEvent;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kStuckS = 60.0;

/// Two chips; lines that no button pulls to ground are high.
void set_up_board() {
  FakeBoard& board = fake_board();
  board = {};
  board.chips = {{"gpiochip0", "soc-pins", {{.name = "ID_SDA"}, {.name = "MAIN", .high = true}}},
                 {"gpiochip1",
                  "expander",
                  {{.name = "", .high = true},
                   {.name = "WIPE", .high = true},
                   {.name = "LAMP", .high = true},
                   {.name = "CS", .user = "spi0 CS0"}}}};
}

/// What is pressed is the button on MAIN or WIPE.
class GpiodRig : public FingerRig {
 public:
  GpiodRig() : FingerRig(clock_) { clock_.wait_until(5000 * kMs); }
  ~GpiodRig() override { fake_board() = {}; }

  std::int64_t inaccuracy_ns() const override { return 0; }

 private:
  void prepare() override {
    FakeChip chip{"gpiochip0", "buttons", {}};
    for (const Button button : hal::kAllButtons) {
      chip.lines.push_back({.name = hal::name_of(button), .high = true});
    }
    fake_board().chips = {chip};
  }

  std::unique_ptr<hal::Buttons> make() override {
    config::Gpio options;
    options.main = "main";
    options.review = "gpiochip0:1";
    options.plus = "buttons:2";
    options.minus = "minus";
    options.wipe = "wipe";
    return std::make_unique<hal::GpiodButtons>(options, kRigStuckS, clock_);
  }

  /// The contact bounces; in the end it is as the finger has it.
  void move(Button button, bool down) override {
    FakeLine& line = fake_board().chips.at(0).lines.at(index_of(button));
    for (const bool closed : {down, !down, down}) {
      fake_board().drive(line, !closed, clock_.now_ns());
      clock_.wait_until(clock_.now_ns() + kMs);
    }
  }

  hal::VirtualClock clock_;
};

const ButtonsBackend kGpiod{kFakeLibgpiod == 1 ? "GpiodOnFakeLibrary1" : "GpiodOnFakeLibrary2",
                            [] { return std::make_unique<GpiodRig>(); }};

class Gpiod : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_up_board(); }
  void TearDown() override { EXPECT_EQ(fake_board().open_objects, 0); }

  std::vector<ButtonEvent> poll_at(hal::Buttons& buttons, std::int64_t at_ms) {
    clock_.wait_until(at_ms * kMs);
    return buttons.poll();
  }

  std::string complaint() const {
    return message_of([&] { hal::GpiodButtons(options_, kStuckS, clock_); });
  }

  /// MAIN changes so many times within less than 5 ms, first to ground.
  void bounce(std::int64_t changes) {
    for (std::int64_t i = 0; i < changes; ++i) {
      fake_board().drive(line("MAIN"), i % 2 == 1, bounce_time_ns(i));
    }
  }
  static std::int64_t bounce_time_ns(std::int64_t change) { return 100 * kMs + change * 30'000; }

  /// WIPE is pressed, then its chip is unplugged.
  void lose_a_line(bool hangs_up) {
    options_.main = "MAIN";
    options_.wipe = "WIPE";
    hal::GpiodButtons buttons(options_, kStuckS, clock_);
    fake_board().drive(line("WIPE"), false, 1 * kMs);
    EXPECT_THAT(poll_at(buttons, 20),
                ElementsAre(ButtonEvent{Button::Wipe, ButtonAction::Pressed, kMs}));
    EXPECT_EQ(buttons.error(), std::nullopt);

    line("WIPE").gone = true;
    line("WIPE").hangs_up = hangs_up;
    EXPECT_THAT(poll_at(buttons, 40),
                ElementsAre(ButtonEvent{Button::Wipe, ButtonAction::Released, 40 * kMs}));
    fake_board().drive(line("MAIN"), false, 50 * kMs);
    EXPECT_THAT(poll_at(buttons, 60),
                ElementsAre(ButtonEvent{Button::Main, ButtonAction::Pressed, 50 * kMs}));
    EXPECT_EQ(buttons.error(), "the line of wipe is gone");
  }

  FakeLine& line(const std::string& name) { return *fake_board().line_named(name); }

  hal::VirtualClock clock_;
  config::Gpio options_;
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(Gpiod, EveryButtons, ::testing::Values(kGpiod), backend_name);
INSTANTIATE_TEST_SUITE_P(Gpiod, HardwareButtons, ::testing::Values(kGpiod), backend_name);
INSTANTIATE_TEST_SUITE_P(Libgpiod, Gpiod, ::testing::Values(kFakeLibgpiod),
                         ::testing::PrintToStringParamName());

TEST_P(Gpiod, TakesLinesByNameAndByChipAndOffset) {
  options_.main = "MAIN";
  options_.wipe = "gpiochip1:1";
  {
    const hal::GpiodButtons buttons(options_, kStuckS, clock_);
    for (const char* name : {"MAIN", "WIPE"}) {
      EXPECT_EQ(line(name).user, "lumibox") << name;
      EXPECT_TRUE(line(name).is_input) << name;
      EXPECT_TRUE(line(name).tells_edges) << name;
      EXPECT_TRUE(line(name).active_low) << name;
      EXPECT_EQ(line(name).bias, "pull-up") << name;
      EXPECT_EQ(line(name).kept_edges, kFakeLibgpiod == 1 ? 16U : 64U) << name;
    }
  }
  EXPECT_EQ(line("MAIN").user, "");
  for (const char* chip : {"expander:1", "/dev/gpiochip1:1", "1:1"}) {
    options_.wipe = chip;
    const hal::GpiodButtons buttons(options_, kStuckS, clock_);
    EXPECT_EQ(line("WIPE").user, "lumibox") << chip;
  }
}

TEST_P(Gpiod, AsksForTheBiasAndTheLevelOfTheConfiguration) {
  options_.main = "MAIN";
  options_.active_low = false;
  for (const char* bias : {"as-is", "pull-up", "pull-down", "disabled"}) {
    set_up_board();
    options_.bias = bias;
    const hal::GpiodButtons buttons(options_, kStuckS, clock_);
    EXPECT_EQ(line("MAIN").bias, bias);
    EXPECT_FALSE(line("MAIN").active_low);
  }
}

TEST_P(Gpiod, SaysWhichLineCannotBeHadAndWhy) {
  EXPECT_THAT(complaint(), AllOf(HasSubstr("no button has a line"), HasSubstr("gpio.main")));

  options_.main = "GPIO99";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("gpio.main"), HasSubstr("\"GPIO99\""),
                                 HasSubstr("not on any chip"), HasSubstr("gpioinfo")));
  options_.main = "gpiochip7:1";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("\"gpiochip7:1\""), HasSubstr("no such chip"),
                                 HasSubstr("gpiodetect")));
  options_.main = "gpiochip0:2";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("gpio.main: line \"gpiochip0:2\""),
                                 HasSubstr("chip \"gpiochip0\" has 2 lines")));

  options_.main = "CS";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("\"CS\""), HasSubstr("in use by \"spi0 CS0\""),
                                 HasSubstr("expected a free line")));
  options_.main = "MAIN";
  options_.plus = "gpiochip0:1";
  EXPECT_THAT(complaint(), AllOf(HasSubstr("gpio.plus"), HasSubstr("in use by \"lumibox\"")));
  options_.plus = "";
  line("MAIN").gone = true;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("\"MAIN\""), HasSubstr("refused by the kernel")));
  line("MAIN").gone = false;
  for (FakeChip& chip : fake_board().chips) chip.is_denied = true;
  EXPECT_THAT(complaint(), AllOf(HasSubstr("gpio.main"), HasSubstr("no permission")));
  options_.main = "gpiochip0:1";
  EXPECT_THAT(complaint(), HasSubstr("no permission"));
}

// Twice as many edges as the kernel keeps, of which it drops the last or the first. Either way the
// level is read again.
TEST_P(Gpiod, ABurstThatTheKernelCannotKeepIsOnePress) {
  options_.main = "MAIN";
  hal::GpiodButtons buttons(options_, kStuckS, clock_);
  const auto kept = static_cast<std::int64_t>(line("MAIN").kept_edges);
  bounce(2 * kept + 1);
  std::vector<ButtonEvent> told = poll_at(buttons, 120);
  for (const ButtonEvent& event : poll_at(buttons, 140)) told.push_back(event);
  const std::int64_t first = kFakeLibgpiod == 1 ? 0 : kept + 1;
  EXPECT_THAT(told,
              ElementsAre(ButtonEvent{Button::Main, ButtonAction::Pressed, bounce_time_ns(first)}));
  EXPECT_THAT(poll_at(buttons, 300), IsEmpty());
}

TEST_P(Gpiod, ABurstThatEndsWhereItBeganIsNone) {
  options_.main = "MAIN";
  hal::GpiodButtons buttons(options_, kStuckS, clock_);
  bounce(2 * static_cast<std::int64_t>(line("MAIN").kept_edges));
  EXPECT_THAT(poll_at(buttons, 105), IsEmpty());
  EXPECT_THAT(poll_at(buttons, 300), IsEmpty());
}

TEST_P(Gpiod, AButtonIsReleasedWhenItsLineGoesAndTheOthersGoOn) {
  lose_a_line(/*hangs_up=*/false);
}

TEST_P(Gpiod, AButtonIsReleasedWhenItsLineHangsUp) {
  lose_a_line(/*hangs_up=*/true);
}

TEST_P(Gpiod, TheQuietTimeIsThatOfTheConfiguration) {
  options_.main = "MAIN";
  options_.debounce_ms = 30.0;
  hal::GpiodButtons buttons(options_, kStuckS, clock_);
  fake_board().drive(line("MAIN"), false, 100 * kMs);
  EXPECT_THAT(poll_at(buttons, 129), IsEmpty());
  EXPECT_EQ(poll_at(buttons, 130).size(), 1U);
}

TEST_P(Gpiod, ALampIsDarkUntilItIsLitAndWhenItGoes) {
  for (const bool active_low : {false, true}) {
    set_up_board();
    line("LAMP").high = !active_low;
    {
      hal::GpiodLed lamp("LAMP", active_low);
      EXPECT_FALSE(line("LAMP").is_input);
      EXPECT_EQ(line("LAMP").high, active_low);
      lamp.light(true);
      EXPECT_EQ(line("LAMP").high, !active_low);
      lamp.light(false);
      EXPECT_EQ(line("LAMP").high, active_low);
      lamp.light(true);
    }
    EXPECT_EQ(line("LAMP").high, active_low);
    EXPECT_EQ(line("LAMP").user, "");
  }
  EXPECT_THAT(message_of([] { hal::GpiodLed("CS", false); }),
              AllOf(HasSubstr("devices.status_led"), HasSubstr("in use by \"spi0 CS0\"")));
}

}  // namespace lumibox::testing
