#include "lightfield/store.h"

#include <cassert>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "config/error.h"
#include "lightfield/capture_writer.h"

namespace lumibox::lightfield {

/// A queue of changes before a CaptureWriter; the writer is touched by one thread only.
class Store::Impl {
 public:
  using Change = std::function<void(CaptureWriter&)>;

  Impl(CaptureWriter writer, Writing writing) : writer_(std::move(writer)) {
    if (writing == Writing::Threaded) thread_ = std::thread([this] { run(); });
  }

  ~Impl() {
    end();
    if (thread_.joinable()) thread_.join();
  }

  void post(Change change) {
    if (!thread_.joinable()) {
      apply({std::move(change)});
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(std::move(change));
    }
    wake_.notify_all();
  }

  void post_map(std::shared_ptr<const tracking::MapView> map,
                std::shared_ptr<const geometry::Camera> camera) {
    {
      const std::lock_guard lock(mutex_);
      if (std::exchange(map_, std::move(map))) return;  // one is on its way: this in its place
    }
    post([this, camera = std::move(camera)](CaptureWriter& writer) {
      auto map_error = writer.set_map(*take_map(), *camera);
      const std::lock_guard lock(mutex_);
      map_error_ = std::move(map_error);
    });
  }

  void end() {
    if (ending_) return;
    post([](CaptureWriter& writer) {
      writer.commit_moves();
      writer.remove_unnamed_pictures();
      writer.unlock();
    });
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
  }

  bool ended() const {
    const std::lock_guard lock(mutex_);
    return ending_ && queue_.empty() && !busy_;
  }

  void flush() {
    if (!ending_) post([](CaptureWriter& writer) { writer.commit_moves(); });
    {
      std::unique_lock lock(mutex_);
      idle_.wait(lock, [this] { return queue_.empty() && !busy_; });
    }
    if (const auto message = error()) throw config::InputError(*message);
  }

  std::optional<std::string> error() const {
    const std::lock_guard lock(mutex_);
    return error_ ? error_ : map_error_;
  }

  const std::filesystem::path& folder() const { return writer_.folder(); }

 private:
  std::shared_ptr<const tracking::MapView> take_map() {
    const std::lock_guard lock(mutex_);
    return std::exchange(map_, nullptr);
  }

  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return ending_ || !queue_.empty(); });
      if (queue_.empty()) return;
      const std::vector<Change> changes = std::exchange(queue_, {});
      busy_ = true;
      lock.unlock();
      apply(changes);
      lock.lock();
      busy_ = false;
      idle_.notify_all();
    }
  }

  bool stopped() const {
    const std::lock_guard lock(mutex_);
    return error_.has_value();
  }

  /// Changes that have queued up share one transforms.json.
  void apply(const std::vector<Change>& changes) {
    if (stopped()) return;
    attempt([&] {
      for (const Change& change : changes) change(writer_);
    });
    // After an error too: what was complete before it is named.
    attempt([this] { writer_.commit(); });
  }

  void attempt(const std::function<void()>& action) {
    try {
      action();
    } catch (const std::exception& exception) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = exception.what();
    }
  }

  CaptureWriter writer_;
  mutable std::mutex mutex_;  ///< guards all below
  std::condition_variable wake_;
  std::condition_variable idle_;
  std::vector<Change> queue_;
  std::shared_ptr<const tracking::MapView> map_;  ///< that waits to be written
  std::optional<std::string> error_;              ///< that ended the writing
  std::optional<std::string> map_error_;          ///< of the last map, which ended nothing
  bool busy_ = false;
  bool ending_ = false;  ///< set by the caller's thread, which alone reads it unguarded
  std::thread thread_;   ///< last: it uses all of the above
};

Store::Store(const std::filesystem::path& folder, int jpeg_quality, Writing writing,
             DurableFiles files)
    : impl_(
          std::make_unique<Impl>(CaptureWriter(folder, jpeg_quality, std::move(files)), writing)) {}

Store::Store(const Capture& capture, std::size_t keyframes, int jpeg_quality, Writing writing,
             DurableFiles files)
    : impl_(std::make_unique<Impl>(
          CaptureWriter(capture, keyframes, jpeg_quality, std::move(files)), writing)) {}

Store::~Store() = default;

void Store::set_subject(const Sphere& sphere) {
  impl_->post([sphere](CaptureWriter& writer) { writer.set_subject(sphere); });
}

void Store::add(const Perspective& perspective) {
  assert(perspective.photo && perspective.camera);
  impl_->post([perspective](CaptureWriter& writer) { writer.add(perspective); });
}

void Store::remove(int id) {
  impl_->post([id](CaptureWriter& writer) { writer.remove(id); });
}

void Store::restore(const Perspective& perspective) {
  assert(perspective.photo && perspective.camera);
  impl_->post([perspective](CaptureWriter& writer) { writer.restore(perspective); });
}

void Store::set_pose(int id, const geometry::Pose& world_from_camera) {
  impl_->post(
      [id, world_from_camera](CaptureWriter& writer) { writer.set_pose(id, world_from_camera); });
}

void Store::hang(int id, int keyframe, const geometry::Pose& keyframe_from_camera) {
  impl_->post([=](CaptureWriter& writer) { writer.hang(id, keyframe, keyframe_from_camera); });
}

void Store::set_points(std::vector<Eigen::Vector3d> points) {
  impl_->post([points = std::move(points)](CaptureWriter& writer) { writer.set_points(points); });
}

void Store::set_map(std::shared_ptr<const tracking::MapView> map,
                    std::shared_ptr<const geometry::Camera> camera) {
  assert(map && camera);
  impl_->post_map(std::move(map), std::move(camera));
}

void Store::set_threshold(double radians) {
  impl_->post([radians](CaptureWriter& writer) { writer.set_threshold(radians); });
}

std::optional<std::string> Store::error() const {
  return impl_->error();
}

void Store::flush() {
  impl_->flush();
}

void Store::end() {
  impl_->end();
}

bool Store::ended() const {
  return impl_->ended();
}

const std::filesystem::path& Store::folder() const {
  return impl_->folder();
}

}  // namespace lumibox::lightfield
