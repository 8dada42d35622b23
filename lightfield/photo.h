#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "geometry/camera.h"
#include "hal/image.h"

namespace lumibox::lightfield {

/// A picture that need not be in memory: it holds its pixels until they are complete in a file, and
/// from then on they are decoded again for whoever wants them. Those are then the file's own, with
/// the losses of a JPEG.
///
/// A file can go (a card is pulled out), be damaged, or become a picture of another size. The first
/// time that it cannot be read the photo is lost, and stays so while the program runs: trying again
/// with every view would cost more than a view. Nobody is stopped by that; views leave out what is
/// lost. Another picture of the same size is taken for the photo: what is in the folder is the
/// capture, and nobody but its writer has the right to change it (CaptureLock).
///
/// Photos are told by the object, not by what they show. All functions are thread safe.
class Photo {
 public:
  /// In memory only. Precondition: three channels, not empty.
  explicit Photo(std::shared_ptr<const hal::Image> pixels);

  /// In a file, which is read once to be sure of it; nothing of it is kept. Throws
  /// config::InputError if it is missing, damaged or not of the camera's size.
  Photo(std::filesystem::path file, const geometry::Camera& camera);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Three channels of width() x height(). The pixels in memory if anybody still holds them, else
  /// those of the file, in some milliseconds. Who asks while another reads does not wait for that,
  /// but reads too; all who hold pixels share the first that were read. Null if it is lost.
  std::shared_ptr<const hal::Image> rgb() const;

  /// The pixels if anybody holds them now; nothing is read.
  std::shared_ptr<const hal::Image> in_memory() const;

  /// The same as rgb() for those who cannot go on without: throws config::InputError that says
  /// fault().
  std::shared_ptr<const hal::Image> require_rgb() const;

  /// Why it is lost, as a sentence with the path; none as long as nobody asked for it in vain.
  std::optional<std::string> fault() const;

  /// To be told when it is complete in a file and on the disk: the pixels are let go of.
  void stored_in(std::filesystem::path file);

  /// Of pixels that stay because of this photo.
  std::size_t bytes_held() const;

 private:
  std::shared_ptr<const hal::Image> read() const;
  std::filesystem::path file() const;

  int width_;
  int height_;
  mutable std::mutex mutex_;                        ///< guards all below, for moments only
  std::shared_ptr<const hal::Image> held_;          ///< until it is stored
  mutable std::weak_ptr<const hal::Image> pixels_;  ///< whoever holds them
  std::filesystem::path file_;                      ///< empty until it is stored
  mutable std::optional<std::string> fault_;
};

}  // namespace lumibox::lightfield
