#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "appliance/line_socket.h"
#include "hal/image.h"

namespace lumibox::testing {

/// What a command in the guest wrote, its errors among it, and how it ended.
struct CommandResult {
  int status = 0;
  std::string output;
};

/// A machine under QEMU's software emulation: two cores, 2 GiB, a screen of 640x480 (virtio-gpu), a
/// keyboard, and disks. Throws std::runtime_error if it cannot be started or does not answer.
class VirtualMachine {
 public:
  enum class Start {
    Kernel,    ///< QEMU starts the kernel, with a root's shell on a serial line
    Firmware,  ///< UEFI starts what it finds on the disk: nothing but the screen is to be seen of
               ///< it
  };
  struct Settings {
    std::filesystem::path image;    ///< folder that make-image and make-tools have filled
    std::filesystem::path disk;     ///< written to
    std::filesystem::path scratch;  ///< sockets and console.log
    Start start = Start::Kernel;
    std::string more_parameters;  ///< of the kernel
  };

  explicit VirtualMachine(const Settings& settings);
  ~VirtualMachine();  ///< as cut_power()

  /// A shell command in the guest, as root. Not for programs that read their input.
  CommandResult run(const std::string& command);
  /// The output of a command that is expected to succeed; throws std::runtime_error otherwise.
  std::string output(const std::string& command);
  /// Runs the command over and over until it succeeds; false after `patience`.
  bool becomes_true(const std::string& command, std::chrono::seconds patience = kPatience);

  /// What the screen shows. RGB.
  hal::Image screen();
  /// Keys by QEMU's names, pressed together: "ret", "ctrl-alt-f2".
  void type(const std::string& keys);
  /// The power button, and waits for the machine to be off. False if it does not go off.
  bool shut_down();
  /// At once, in mid-sentence: whatever is not on the disk yet is gone.
  void cut_power();

 private:
  std::string ask_qemu(const std::string& command, const std::string& arguments = "{}");
  std::unique_ptr<LineSocket> connect(const char* name);
  void open_shell();
  bool off(int options);

  Settings settings_;
  pid_t process_ = -1;
  std::unique_ptr<LineSocket> qmp_;
  std::unique_ptr<LineSocket> shell_;
  int commands_ = 0;
};

}  // namespace lumibox::testing
