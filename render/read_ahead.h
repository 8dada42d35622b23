#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "hal/image.h"
#include "lightfield/photo.h"

namespace lumibox::render {

/// Pictures that will be drawn soon, read from their files before anybody has to wait for them.
/// Whoever has the time calls read_next(); the pixels then are Photo::in_memory() until the picture
/// is no longer wanted. All functions are thread safe.
class ReadAhead {
 public:
  using Pictures = std::vector<std::shared_ptr<const lightfield::Photo>>;

  /// Most pictures whose pixels are kept for those who want them: 7 MB of 640x480.
  static constexpr std::size_t kMostKept = 8;

  /// What is wanted from now on, the most urgent first; of all others the pixels are let go.
  void want(const Pictures& pictures);

  /// Reads the most urgent of those that were not read. False if there is nothing to do now:
  /// nothing is wanted, or enough is kept.
  bool read_next();

  /// Waits until there is something to do; false from stop() on.
  bool wait();
  void stop();

 private:
  struct Wish {
    std::shared_ptr<const lightfield::Photo> picture;
    bool taken_on = false;                     ///< read, or being read
    std::shared_ptr<const hal::Image> pixels;  ///< null also of one that is lost
  };

  Wish* next();
  Wish* wish_for(const std::shared_ptr<const lightfield::Photo>& picture);

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::vector<Wish> wishes_;  ///< the most urgent first
  bool stopping_ = false;
};

/// A thread that reads ahead while this lives.
class ReadAheadThread {
 public:
  ReadAheadThread();
  ~ReadAheadThread();
  ReadAheadThread(const ReadAheadThread&) = delete;
  ReadAheadThread& operator=(const ReadAheadThread&) = delete;

  ReadAhead& pictures() { return pictures_; }

 private:
  ReadAhead pictures_;
  std::thread thread_;
};

}  // namespace lumibox::render
