#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/buttons_rig.h"
#include "hal/evdev/evdev_buttons.h"
#include "hal/fake_evdev.h"
#include "hal/sim/virtual_clock.h"
#include "support/input_error.h"
#include "support/temp_dir.h"

// The evdev backend and the real libevdev on devices that are not there.
namespace lumibox::testing {

using hal::Button;
using hal::ButtonAction;
using hal::ButtonEvent;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kStuckS = 60.0;

const std::set<unsigned> kKeyboard = {KEY_ENTER, KEY_R,     KEY_EQUAL,  KEY_MINUS,
                                      KEY_A,     KEY_SPACE, KEY_DELETE, KEY_BACKSPACE};

class EvdevRig : public FingerRig {
 public:
  EvdevRig() : FingerRig(clock_) { clock_.wait_until(5000 * kMs); }

  std::int64_t inaccuracy_ns() const override { return 0; }

 private:
  void prepare() override {
    keyboard_.emplace(folder_ / "event0", "A keyboard", kKeyboard, clock_);
  }

  std::unique_ptr<hal::Buttons> make() override {
    return std::make_unique<hal::EvdevButtons>("any", config::Evdev{}, kRigStuckS, clock_,
                                               folder_.path());
  }

  void move(Button button, bool down) override {
    constexpr std::array<unsigned, 5> kKeys = {KEY_ENTER, KEY_R, KEY_EQUAL, KEY_MINUS, KEY_DELETE};
    keyboard_->key(kKeys.at(index_of(button)), down ? 1 : 0);
  }

  TempDir folder_;
  hal::VirtualClock clock_;
  std::optional<FakeEvdev> keyboard_;
};

const ButtonsBackend kEvdev{"EvdevOnFakeKernel", [] { return std::make_unique<EvdevRig>(); }};

/// Root may do everything; nobody may not.
class Nobody {
 public:
  Nobody() { change(65534); }
  ~Nobody() { change(0); }
  Nobody(const Nobody&) = delete;
  Nobody& operator=(const Nobody&) = delete;

 private:
  void change(uid_t user) {
    if (getuid() == 0) {
      EXPECT_EQ(seteuid(user), 0);
    }
  }
};

class Evdev : public ::testing::Test {
 protected:
  std::unique_ptr<hal::EvdevButtons> open(const std::string& wanted) {
    return std::make_unique<hal::EvdevButtons>(wanted, options_, kStuckS, clock_, folder_.path());
  }

  std::string complaint(const std::string& wanted) {
    return message_of([&] { open(wanted); });
  }

  std::unique_ptr<FakeEvdev> plug_in(const std::string& file, const std::string& name,
                                     const std::set<unsigned>& keys = kKeyboard) {
    return std::make_unique<FakeEvdev>(folder_ / file, name, keys, clock_);
  }

  ButtonEvent pressed(Button button) const {
    return {button, ButtonAction::Pressed, clock_.now_ns()};
  }
  ButtonEvent released(Button button) const {
    return {button, ButtonAction::Released, clock_.now_ns()};
  }

  void wait_ms(std::int64_t ms) { clock_.wait_until(clock_.now_ns() + ms * kMs); }

  TempDir folder_;
  hal::VirtualClock clock_;
  config::Evdev options_;
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(Evdev, EveryButtons, ::testing::Values(kEvdev), backend_name);
INSTANTIATE_TEST_SUITE_P(Evdev, HardwareButtons, ::testing::Values(kEvdev), backend_name);

TEST_F(Evdev, TakesAllDevicesThatHaveAKeyAndHearsNoOtherKey) {
  const auto keyboard = plug_in("event0", "A keyboard");
  const auto remote = plug_in("event1", "A remote", {KEY_VOLUMEUP, KEY_POWER});
  const auto lid = plug_in("event2", "A lid", {KEY_POWER});
  const auto mouse = folder_.write("mouse0", "");
  const auto buttons = open("any");
  wait_ms(20);
  keyboard->key(KEY_A, 1);
  remote->key(KEY_POWER, 1);
  lid->key(KEY_POWER, 1);
  EXPECT_THAT(buttons->poll(), IsEmpty());
  keyboard->key(KEY_R, 1);
  remote->key(KEY_VOLUMEUP, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Review), pressed(Button::Plus)));
}

TEST_F(Evdev, TakesADeviceByPathOrByName) {
  const auto one = plug_in("event0", "A keyboard");
  const auto other = plug_in("event1", "Acme, a remote");
  for (const std::string& wanted : {(folder_ / "event1").string(), std::string("Acme, a remote")}) {
    const auto buttons = open(wanted);
    one->key(KEY_ENTER, 1);
    one->key(KEY_ENTER, 0);
    EXPECT_THAT(buttons->poll(), IsEmpty()) << wanted;
    other->key(KEY_ENTER, 1);
    other->key(KEY_ENTER, 0);
    EXPECT_EQ(buttons->poll().size(), 2U) << wanted;
  }
}

TEST_F(Evdev, AKeyThatTheKernelRepeatsIsHeldOnce) {
  const auto keyboard = plug_in("event0", "A keyboard");
  const auto buttons = open("any");
  keyboard->key(KEY_ENTER, 1);
  keyboard->key(KEY_ENTER, 2);
  keyboard->key(KEY_ENTER, 2);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Main)));
}

TEST_F(Evdev, TwoKeysOfAButtonAreOneButton) {
  const auto keyboard = plug_in("event0", "A keyboard");
  const auto other = plug_in("event1", "Another");
  const auto buttons = open("any");
  keyboard->key(KEY_ENTER, 1);
  keyboard->key(KEY_SPACE, 1);
  keyboard->key(KEY_ENTER, 0);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Main)));
  other->key(KEY_ENTER, 1);
  wait_ms(1);
  keyboard->key(KEY_SPACE, 0);
  EXPECT_THAT(buttons->poll(), IsEmpty());
  other->key(KEY_ENTER, 0);
  EXPECT_THAT(buttons->poll(), ElementsAre(released(Button::Main)));
}

TEST_F(Evdev, WhatTheKernelDroppedIsFoundOut) {
  const auto keyboard = plug_in("event0", "A keyboard");
  const auto buttons = open("any");
  keyboard->key(KEY_ENTER, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Main)));

  wait_ms(5000);
  keyboard->change_silently(KEY_ENTER, false);
  keyboard->change_silently(KEY_DELETE, true);
  keyboard->drop();
  wait_ms(30);  // nobody knows when it happened: not before it is known
  const std::vector<ButtonEvent> told = buttons->poll();
  EXPECT_THAT(told, ::testing::UnorderedElementsAre(released(Button::Main), pressed(Button::Wipe)));

  wait_ms(10);
  keyboard->key(KEY_DELETE, 0);
  EXPECT_THAT(buttons->poll(), ElementsAre(released(Button::Wipe)));
}

TEST_F(Evdev, AButtonIsReleasedWhenItsDeviceGoesAndHeardAgainWhenItIsBack) {
  const auto keyboard = plug_in("event0", "A keyboard");
  const auto buttons = open("A keyboard");
  keyboard->key(KEY_R, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Review)));
  EXPECT_EQ(buttons->error(), std::nullopt);

  wait_ms(100);
  keyboard->unplug();
  EXPECT_THAT(buttons->poll(), ElementsAre(released(Button::Review)));
  EXPECT_THAT(buttons->error(), Optional(HasSubstr("A keyboard is not there")));

  const auto again = plug_in("event0", "A keyboard");
  wait_ms(1100);
  EXPECT_THAT(buttons->poll(), IsEmpty());
  EXPECT_EQ(buttons->error(), std::nullopt);
  again->key(KEY_R, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Review)));
}

TEST_F(Evdev, WhatIsPluggedInLaterIsTaken) {
  const auto buttons = open("any");
  EXPECT_THAT(buttons->poll(), IsEmpty());
  EXPECT_EQ(buttons->error(), std::nullopt);
  const auto keyboard = plug_in("event7", "A keyboard");
  keyboard->key(KEY_ENTER, 1);
  wait_ms(1100);
  EXPECT_THAT(buttons->poll(), IsEmpty());  // it was down before anybody looked
  keyboard->key(KEY_ENTER, 0);
  keyboard->key(KEY_ENTER, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Main)));
}

TEST_F(Evdev, ANamedDeviceMayComeLaterAndTheScreenSaysThatItIsMissing) {
  const std::filesystem::path path = folder_ / "event3";
  ::testing::internal::CaptureStdout();
  const auto buttons = open(path.string());
  EXPECT_THAT(buttons->error(), Optional(HasSubstr(path.string() + " is not there")));
  for (int i = 0; i < 5; ++i) {
    wait_ms(1100);
    buttons->poll();
  }
  const auto keyboard = plug_in("event3", "A keyboard");
  wait_ms(1100);
  buttons->poll();
  EXPECT_EQ(buttons->error(), std::nullopt);
  const std::string said = ::testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("buttons: " + path.string() + " is not there; waiting for it"));
  EXPECT_EQ(said.find("is not there"), said.rfind("is not there")) << "once";
  EXPECT_THAT(said, HasSubstr("buttons: A keyboard (" + path.string() + ")"));
}

TEST_F(Evdev, IsForTheBoxAloneIfSoConfigured) {
  const auto keyboard = plug_in("event0", "A keyboard");
  {
    const auto buttons = open("any");
    EXPECT_FALSE(keyboard->is_grabbed());
  }
  options_.grab = true;
  const auto buttons = open("any");
  EXPECT_TRUE(keyboard->is_grabbed());
}

TEST_F(Evdev, SaysWhichDeviceCannotBeHadAndWhy) {
  const std::string path = (folder_ / "event0").string();
  const auto lid = plug_in("event0", "A lid", {KEY_POWER});
  EXPECT_THAT(complaint(path), AllOf(HasSubstr("devices.buttons: evdev:" + path),
                                     HasSubstr("has none of the keys")));
  EXPECT_EQ(complaint("any"), "");
  EXPECT_EQ(complaint("A lid"), "");

  folder_.write("event1", "no device at all");
  EXPECT_THAT(complaint("any"), AllOf(HasSubstr("event1"), HasSubstr("expected an input device")));

  const auto keyboard = plug_in("event2", "A keyboard");
  EXPECT_EQ(complaint("any"), "");  // one is enough
  options_.grab = true;
  keyboard->grab_by_another();
  EXPECT_THAT(complaint((folder_ / "event2").string()), HasSubstr("another program"));
}

TEST_F(Evdev, SaysThatItHasNoPermission) {
  const auto keyboard = plug_in("event0", "A keyboard");
  const std::filesystem::path path = folder_ / "event0";
  chmod(folder_.path().c_str(), 0755);
  chmod(path.c_str(), 0);
  const Nobody nobody;
  EXPECT_THAT(complaint("any"), AllOf(HasSubstr("evdev:any"), HasSubstr(path.string()),
                                      HasSubstr("no permission"), HasSubstr("group input")));
}

// udev makes a new device's file first, and who may open it a moment later.
TEST_F(Evdev, TriesAgainWhatItHadNoPermissionFor) {
  chmod(folder_.path().c_str(), 0755);
  const auto buttons = open("any");
  const auto keyboard = plug_in("event0", "A keyboard");
  chmod((folder_ / "event0").c_str(), 0);
  {
    const Nobody nobody;
    wait_ms(1100);
    buttons->poll();
  }
  chmod((folder_ / "event0").c_str(), 0600);
  wait_ms(1100);
  buttons->poll();
  keyboard->key(KEY_ENTER, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Main)));
}

TEST_F(Evdev, KeysThatMakeNoSenseAreRefused) {
  options_.wipe = "KEY_DELETE KEY_NONSENSE";
  EXPECT_THAT(complaint("any"), AllOf(HasSubstr("evdev.wipe"), HasSubstr("\"KEY_NONSENSE\""),
                                      HasSubstr("KEY_ENTER")));
  options_.wipe = "KEY_ENTER";
  EXPECT_THAT(complaint("any"), AllOf(HasSubstr("evdev.wipe"), HasSubstr("already evdev.main")));
  options_ = {.main = "", .review = "", .plus = "", .minus = "", .wipe = " "};
  EXPECT_THAT(complaint("any"), HasSubstr("no button has a key"));
}

TEST_F(Evdev, KeysAreThoseOfTheConfiguration) {
  options_.main = "KEY_A KEY_A";
  options_.wipe = "";
  const auto keyboard = plug_in("event0", "A keyboard");
  const auto buttons = open("any");
  keyboard->key(KEY_ENTER, 1);
  keyboard->key(KEY_DELETE, 1);
  keyboard->key(KEY_A, 1);
  EXPECT_THAT(buttons->poll(), ElementsAre(pressed(Button::Main)));
}

}  // namespace lumibox::testing
