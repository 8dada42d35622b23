#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "hal/buttons_rig.h"
#include "hal/evdev/evdev_buttons.h"
#include "hal/system_clock.h"

// The kernel's own keyboard: needs /dev/uinput, and a user who may open it.
namespace lumibox::testing {
namespace {

constexpr std::array<unsigned, 5> kKeys = {KEY_ENTER, KEY_R, KEY_EQUAL, KEY_MINUS, KEY_DELETE};

class UinputRig : public FingerRig {
 public:
  UinputRig() : FingerRig(clock_) {}
  ~UinputRig() override { libevdev_uinput_destroy(keyboard_); }

  std::string missing() const override {
    return access("/dev/uinput", W_OK) == 0 ? "" : "no access to /dev/uinput";
  }
  std::int64_t inaccuracy_ns() const override { return 20'000'000; }

 private:
  void prepare() override {
    libevdev* const description = libevdev_new();
    libevdev_set_name(description, "lumibox test keyboard");
    for (const unsigned key : kKeys) libevdev_enable_event_code(description, EV_KEY, key, nullptr);
    const int error =
        libevdev_uinput_create_from_device(description, LIBEVDEV_UINPUT_OPEN_MANAGED, &keyboard_);
    libevdev_free(description);
    if (error != 0) {
      throw std::runtime_error("no uinput keyboard");
    }
  }

  std::unique_ptr<hal::Buttons> make() override {
    return std::make_unique<hal::EvdevButtons>(libevdev_uinput_get_devnode(keyboard_),
                                               config::Evdev{}, kRigStuckS, clock_);
  }

  void move(hal::Button button, bool down) override {
    libevdev_uinput_write_event(keyboard_, EV_KEY, kKeys.at(index_of(button)), down ? 1 : 0);
    libevdev_uinput_write_event(keyboard_, EV_SYN, SYN_REPORT, 0);
  }

  hal::SystemClock clock_;
  libevdev_uinput* keyboard_ = nullptr;
};

const ButtonsBackend kUinput{"EvdevOnUinput", [] { return std::make_unique<UinputRig>(); }};

}  // namespace

INSTANTIATE_TEST_SUITE_P(Uinput, EveryButtons, ::testing::Values(kUinput), backend_name);
INSTANTIATE_TEST_SUITE_P(Uinput, HardwareButtons, ::testing::Values(kUinput), backend_name);

}  // namespace lumibox::testing
