#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "hal/buttons_rig.h"
#include "hal/gpiod/gpiod_buttons.h"
#include "hal/system_clock.h"

// The kernel's simulated lines (Documentation/admin-guide/gpio/gpio-sim.rst): needs the module
// gpio-sim, configfs, and a user who may write there.
namespace lumibox::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kConfigfs = "/sys/kernel/config/gpio-sim";

void write(const fs::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text << std::flush;
  if (!stream) {
    throw std::runtime_error("gpio-sim: cannot write " + file.string());
  }
}

std::string word_in(const fs::path& file) {
  std::string word;
  std::ifstream(file) >> word;
  return word;
}

class GpioSimRig : public FingerRig {
 public:
  GpioSimRig() : FingerRig(clock_) {}
  ~GpioSimRig() override {
    if (fs::exists(device_)) {
      write(device_ / "live", "0");
      fs::remove(device_ / "bank0");
      fs::remove(device_);
    }
  }

  std::string missing() const override {
    return fs::exists(kConfigfs) ? "" : "no gpio-sim: " + kConfigfs.string() + " is missing";
  }
  std::int64_t inaccuracy_ns() const override { return 20'000'000; }

 private:
  void prepare() override {
    const fs::path bank = device_ / "bank0";
    fs::create_directory(device_);
    fs::create_directory(bank);
    write(bank / "num_lines", "5");
    write(bank / "label", "lumibox-test");
    write(device_ / "live", "1");
    chip_ = word_in(bank / "chip_name");
    lines_ = fs::path("/sys/devices/platform") / word_in(device_ / "dev_name") / chip_;
    for (const hal::Button button : hal::kAllButtons) move(button, false);
  }

  std::unique_ptr<hal::Buttons> make() override {
    config::Gpio options;
    options.bias = "as-is";  // the simulated finger moves the pull
    options.main = chip_ + ":0";
    options.review = chip_ + ":1";
    options.plus = chip_ + ":2";
    options.minus = "lumibox-test:3";
    options.wipe = "lumibox-test:4";
    return std::make_unique<hal::GpiodButtons>(options, kRigStuckS, clock_);
  }

  /// A button that is down pulls its line to ground.
  void move(hal::Button button, bool down) override {
    write(lines_ / ("sim_gpio" + std::to_string(index_of(button))) / "pull",
          down ? "pull-down" : "pull-up");
  }

  hal::SystemClock clock_;
  fs::path device_ = kConfigfs / "lumibox-test";
  std::string chip_;
  fs::path lines_;
};

const ButtonsBackend kGpioSim{"GpiodOnGpioSim", [] { return std::make_unique<GpioSimRig>(); }};

}  // namespace

INSTANTIATE_TEST_SUITE_P(GpioSim, EveryButtons, ::testing::Values(kGpioSim), backend_name);
INSTANTIATE_TEST_SUITE_P(GpioSim, HardwareButtons, ::testing::Values(kGpioSim), backend_name);

}  // namespace lumibox::testing
