#include "lightfield/photo.h"

#include <cassert>
#include <exception>
#include <utility>

#include "config/error.h"
#include "hal/image_io.h"

namespace lumibox::lightfield {
namespace {

/// Throws config::InputError.
hal::Image read_rgb(const std::filesystem::path& file, int width, int height) {
  hal::Image image = hal::read_image(file);
  if (image.width() != width || image.height() != height) {
    throw config::InputError(file, "is " + std::to_string(image.width()) + "x" +
                                       std::to_string(image.height()) + ", its camera says " +
                                       std::to_string(width) + "x" + std::to_string(height));
  }
  return image.channels() == 3 ? std::move(image) : hal::to_rgb(image);
}

}  // namespace

Photo::Photo(std::shared_ptr<const hal::Image> pixels)
    : width_(pixels->width()), height_(pixels->height()), held_(std::move(pixels)), pixels_(held_) {
  assert(held_->channels() == 3 && !held_->empty());
}

Photo::Photo(std::filesystem::path file, const geometry::Camera& camera)
    : width_(camera.width()), height_(camera.height()), file_(std::move(file)) {
  read_rgb(file_, width_, height_);
}

std::shared_ptr<const hal::Image> Photo::rgb() const {
  if (auto pixels = in_memory()) return pixels;
  return fault() ? nullptr : read();
}

std::shared_ptr<const hal::Image> Photo::in_memory() const {
  const std::lock_guard lock(mutex_);
  return pixels_.lock();
}

std::shared_ptr<const hal::Image> Photo::require_rgb() const {
  auto pixels = rgb();
  if (!pixels) throw config::InputError(*fault());
  return pixels;
}

std::optional<std::string> Photo::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

void Photo::stored_in(std::filesystem::path file) {
  std::shared_ptr<const hal::Image> let_go;  // which takes longer than the lock may be held
  const std::lock_guard lock(mutex_);
  file_ = std::move(file);
  let_go.swap(held_);
}

std::filesystem::path Photo::file() const {
  const std::lock_guard lock(mutex_);
  return file_;
}

std::size_t Photo::bytes_held() const {
  const std::lock_guard lock(mutex_);
  return held_ ? held_->size_bytes() : 0;
}

/// Whatever goes wrong is this photo's fault and nobody else's. Nobody waits for another who reads,
/// since that one may be a thread that is put aside for long (config::step_back).
std::shared_ptr<const hal::Image> Photo::read() const {
  std::shared_ptr<const hal::Image> pixels;
  std::optional<std::string> fault;
  try {
    pixels = std::make_shared<const hal::Image>(read_rgb(file(), width_, height_));
  } catch (const std::exception& exception) {
    fault = exception.what();
  }
  const std::lock_guard lock(mutex_);
  if (auto first = pixels_.lock()) return first;  // somebody was quicker: all share the same
  pixels_ = pixels;
  fault_ = std::move(fault);
  return pixels;
}

}  // namespace lumibox::lightfield
