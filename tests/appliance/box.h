#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "appliance/virtual_machine.h"

namespace lumibox::testing {

/// Folder that scripts/appliance has filled, from LUMIBOX_APPLIANCE. Throws if that is not set.
std::filesystem::path image_folder();

enum class Line { Main, Review, Plus, Minus, Wipe, Lamp };

/// The box in a virtual machine: its image with a webcam and buttons, driven as a person does, and
/// looked at from outside.
class Box {
 public:
  /// Starts on a copy of the image, on a larger disk. `name` is for the files that it leaves
  /// behind.
  explicit Box(const std::string& name, VirtualMachine::Start start = VirtualMachine::Start::Kernel,
               const std::string& more_parameters = "");
  ~Box();  ///< the disk stays only if a test has failed
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  /// The webcam and the buttons come, and settings that name them. The box is started anew.
  void get_devices();

  VirtualMachine& machine() { return *machine_; }
  std::filesystem::path disk() const { return disk_; }
  /// Power comes back after a cut, and with it the devices.
  void power_up();

  /// A film is played into webcam 0 or 1.
  void play(int webcam);
  void press(Line button, double seconds = 0.2);
  bool lamp_is_lit();

  /// Until the service manager has been told that a picture is on the screen.
  void wait_until_ready();
  /// What is at the top of the screen.
  std::string status();
  /// Until status() contains `words`; a failure of the test otherwise.
  void expect_status(const std::string& words);
  /// Perspectives in the newest capture on the disk, as its transforms.json has it.
  int views();
  /// Until there are so many; a failure of the test otherwise.
  void expect_views(int at_least);

  /// Until the screen shows what `is_it` says yes to; false if it does not come to.
  bool comes_to_show(const std::function<bool(const hal::Image&)>& is_it);
  /// A picture of the screen, kept as screens/NAME.png.
  hal::Image look(const std::string& name);

 private:
  std::filesystem::path disk_;
  VirtualMachine::Settings settings_;
  std::optional<VirtualMachine> machine_;
};

/// Bytes of the partition for settings and captures.
std::int64_t data_partition_bytes(const std::filesystem::path& disk);

/// Takes the captures off the data partition of a disk that no machine uses, as e2fsck has mended
/// it, into `folder`. Returns the folders of the captures, in order.
std::vector<std::filesystem::path> captures_on(const std::filesystem::path& disk,
                                               const std::filesystem::path& folder);

/// How like the screen is to the film: the PSNR in dB of the picture of it that is likest, of what
/// no writing covers, and how much that stands out: the median of all pictures' (dB).
struct Likeness {
  double best = 0.0;
  double median = 0.0;
};
Likeness likeness_to_film(const hal::Image& screen);

/// Appends a line to figures.txt, which a run leaves for the reader, and prints it.
void note_figure(const std::string& line);

}  // namespace lumibox::testing
