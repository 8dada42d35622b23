#pragma once

#include <unistd.h>

#include <utility>

namespace lumibox::hal {

/// For a std::unique_ptr to what a C library hands out: calls the function that frees it.
template <auto free_object>
struct Freed {
  template <typename Object>
  void operator()(Object* object) const {
    free_object(object);
  }
};

/// Owns an open file.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;  ///< below 0: none, as system calls say it
};

}  // namespace lumibox::hal
