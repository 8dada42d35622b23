// The one file that speaks to libcamera, but for what differs between its versions (versions.h).
// Its signals come on a thread of its own: there they are put down, and whoever polls is woken.

#include <libcamera/camera_manager.h>
#include <libcamera/color_space.h>
#include <libcamera/formats.h>
#include <libcamera/framebuffer.h>
#include <libcamera/framebuffer_allocator.h>
#include <libcamera/request.h>
#include <libcamera/stream.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <set>
#include <utility>

#include "config/error.h"
#include "config/error_text.h"
#include "hal/libcamera/camera_system.h"
#include "hal/libcamera/mapped_planes.h"
#include "hal/libcamera/versions.h"
#include "hal/live/wake_up.h"

namespace lumibox::hal::libcam {
namespace {

namespace lc = ::libcamera;
namespace ids = ::libcamera::controls;
using live::PixelFormat;
using versions::has;

// As many as V4L2 gets, for the same reason: one is being filled and one read, two more keep the
// camera going while the reader is late.
constexpr unsigned int kLeastBuffers = 4;

/// RGB is named from the most significant byte there, and here from the first.
constexpr std::pair<PixelFormat, lc::PixelFormat> kFormats[] = {
    {PixelFormat::Yuyv, lc::formats::YUYV},     {PixelFormat::Nv12, lc::formats::NV12},
    {PixelFormat::Yuv420, lc::formats::YUV420}, {PixelFormat::Rgb, lc::formats::BGR888},
    {PixelFormat::Bgr, lc::formats::RGB888},    {PixelFormat::Rgbx, lc::formats::XBGR8888},
    {PixelFormat::Bgrx, lc::formats::XRGB8888}, {PixelFormat::Mjpeg, lc::formats::MJPEG},
    {PixelFormat::Grey, lc::formats::R8}};

std::optional<PixelFormat> format_of(const lc::PixelFormat& format) {
  for (const auto& [ours, theirs] : kFormats) {
    if (theirs == format) return ours;
  }
  return std::nullopt;
}

lc::PixelFormat theirs_of(PixelFormat format) {
  return std::ranges::find(kFormats, format, &std::pair<PixelFormat, lc::PixelFormat>::first)
      ->second;
}

bool is_rgb(PixelFormat format) {
  return format == PixelFormat::Rgb || format == PixelFormat::Bgr || format == PixelFormat::Rgbx ||
         format == PixelFormat::Bgrx;
}

Offer offer_of(PixelFormat format, const lc::Size& least, const lc::Size& most, unsigned int step_x,
               unsigned int step_y) {
  return {format, {least.width, least.height}, {most.width, most.height}, {step_x, step_y}};
}

/// A range, where there is one with steps; else sizes one by one.
void add_offers(const lc::StreamFormats& formats, PixelFormat format, std::vector<Offer>& offers) {
  const lc::PixelFormat theirs = theirs_of(format);
  const lc::SizeRange range = formats.range(theirs);
  if (range.hStep != 0 && range.vStep != 0 && range.min != range.max) {
    offers.push_back(offer_of(format, range.min, range.max, range.hStep, range.vStep));
    return;
  }
  for (const lc::Size& size : formats.sizes(theirs)) {
    offers.push_back(offer_of(format, size, size, 1, 1));
  }
}

/// Continuous, where there is that.
std::int32_t automatic_focus(const lc::ControlInfo& modes) {
  const std::int32_t last = modes.max().get<std::int32_t>();
  return std::min<std::int32_t>(last, ids::AfModeContinuous);
}

void set_switches(bool automatic, const lc::ControlInfoMap& can, lc::ControlList& list) {
  versions::switch_exposure(automatic, can, list);
  if (has(can, ids::AwbEnable)) list.set(ids::AwbEnable, automatic);
  if (has(can, ids::AfMode)) {
    list.set(ids::AfMode,
             automatic ? automatic_focus(can.at(ids::AfMode.id())) : ids::AfModeManual);
  }
}

void set_values(const Adjustments& values, const lc::ControlInfoMap& can, lc::ControlList& list) {
  if (values.exposure_us && has(can, ids::ExposureTime)) {
    list.set(ids::ExposureTime, *values.exposure_us);
  }
  if (values.gain && has(can, ids::AnalogueGain)) list.set(ids::AnalogueGain, *values.gain);
  if (values.white_gains && has(can, ids::ColourGains)) {
    list.set(ids::ColourGains, lc::Span<const float, 2>(*values.white_gains));
  }
  if (values.lens_dioptres && has(can, ids::LensPosition)) {
    list.set(ids::LensPosition, *values.lens_dioptres);
  }
}

void write(const Orders& orders, const lc::ControlInfoMap& can, lc::ControlList& list) {
  if (orders.automatic) set_switches(*orders.automatic, can, list);
  set_values(orders.values, can, list);
  if (orders.frame_duration_us && has(can, ids::FrameDurationLimits)) {
    const std::array<std::int64_t, 2> both{*orders.frame_duration_us, *orders.frame_duration_us};
    list.set(ids::FrameDurationLimits, lc::Span<const std::int64_t, 2>(both));
  }
}

Adjustments read(const lc::ControlList& metadata) {
  Adjustments adjustments;
  adjustments.exposure_us = metadata.get(ids::ExposureTime);
  adjustments.gain = metadata.get(ids::AnalogueGain);
  if (const auto gains = metadata.get(ids::ColourGains)) {
    adjustments.white_gains = {(*gains)[0], (*gains)[1]};
  }
  adjustments.lens_dioptres = metadata.get(ids::LensPosition);
  return adjustments;
}

std::variant<MappedPlanes, int> map(const lc::FrameBuffer& buffer) {
  std::vector<MappedPlanes::Plane> planes;
  for (const lc::FrameBuffer::Plane& plane : buffer.planes()) {
    const bool from_start = plane.offset == lc::FrameBuffer::Plane::kInvalidOffset;
    planes.push_back({plane.fd.get(), from_start ? 0 : plane.offset, plane.length});
  }
  return MappedPlanes::map(planes);
}

/// Cameras that were unplugged while somebody had them.
class Removals {
 public:
  void add(const lc::Camera* camera) {
    const std::lock_guard lock(mutex_);
    removed_.insert(camera);
  }
  void forget(const lc::Camera* camera) {
    const std::lock_guard lock(mutex_);
    removed_.erase(camera);
  }
  bool has(const lc::Camera* camera) const {
    const std::lock_guard lock(mutex_);
    return removed_.contains(camera);
  }

 private:
  mutable std::mutex mutex_;
  std::set<const lc::Camera*> removed_;
};

class RealCamera : public OpenCamera {
 public:
  /// Of a camera that was acquired.
  RealCamera(std::shared_ptr<lc::Camera> camera, Removals& removals)
      : camera_(std::move(camera)), removals_(removals) {}
  ~RealCamera() override {
    RealCamera::stop();
    camera_->release();
    removals_.forget(camera_.get());
  }
  RealCamera(const RealCamera&) = delete;
  RealCamera& operator=(const RealCamera&) = delete;

  std::vector<Offer> offers() override;
  std::variant<Configured, int> configure(const live::Mode& mode) override;
  Abilities abilities() const override;
  int start(const Orders& orders) override;
  void stop() override;
  std::optional<Completed> take() override;
  int queue(std::uint32_t request, const std::optional<Orders>& orders) override;
  bool is_removed() const override { return removals_.has(camera_.get()); }
  int poll_fd() const override { return wake_up_.fd(); }

 private:
  struct Slot {
    std::unique_ptr<lc::Request> request;
    const lc::FrameBuffer* buffer;
    MappedPlanes memory;
  };

  std::unique_ptr<lc::CameraConfiguration> viewfinder() const;
  int make_requests();
  int begin(const Orders& orders);
  void on_completed(lc::Request* request);
  Completed describe(const Slot& slot) const;

  std::shared_ptr<lc::Camera> camera_;
  Removals& removals_;
  std::unique_ptr<lc::CameraConfiguration> configuration_;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  std::vector<Slot> slots_;
  bool running_ = false;
  live::WakeUp wake_up_;
  std::mutex mutex_;
  std::deque<std::uint32_t> completed_;  ///< places in slots_; under the mutex, as the bell is
};

/// None if the camera has no viewfinder.
std::unique_ptr<lc::CameraConfiguration> RealCamera::viewfinder() const {
  auto configuration = camera_->generateConfiguration({lc::StreamRole::Viewfinder});
  return configuration && !configuration->empty() ? std::move(configuration) : nullptr;
}

std::vector<Offer> RealCamera::offers() {
  std::vector<Offer> offers;
  const auto configuration = viewfinder();
  if (!configuration) return offers;
  const lc::StreamConfiguration& stream = configuration->at(0);
  for (const lc::PixelFormat& theirs : stream.formats().pixelformats()) {
    if (const auto format = format_of(theirs)) add_offers(stream.formats(), *format, offers);
  }
  return offers;
}

std::variant<Configured, int> RealCamera::configure(const live::Mode& mode) {
  configuration_ = viewfinder();
  if (!configuration_) return EINVAL;
  lc::StreamConfiguration& stream = configuration_->at(0);
  stream.pixelFormat = theirs_of(mode.format);
  stream.size = {static_cast<unsigned int>(mode.width), static_cast<unsigned int>(mode.height)};
  stream.bufferCount = std::max(stream.bufferCount, kLeastBuffers);
  stream.colorSpace = is_rgb(mode.format) ? lc::ColorSpace::Srgb : lc::ColorSpace::Sycc;
  versions::make_upright(*configuration_, camera_->properties());
  if (configuration_->validate() == lc::CameraConfiguration::Invalid) return EINVAL;
  if (const int error = camera_->configure(configuration_.get()); error < 0) return -error;
  Configured got;
  got.format = format_of(stream.pixelFormat);
  got.width = static_cast<int>(stream.size.width);
  got.height = static_cast<int>(stream.size.height);
  got.stride = stream.stride;
  got.limited_range =
      stream.colorSpace && stream.colorSpace->range == lc::ColorSpace::Range::Limited;
  return got;
}

Abilities RealCamera::abilities() const {
  const lc::ControlInfoMap& can = camera_->controls();
  Abilities abilities;
  abilities.exposure = versions::can_hold_exposure(can);
  abilities.white_balance = has(can, ids::AwbEnable);
  abilities.focus = has(can, ids::AfMode);
  if (has(can, ids::FrameDurationLimits)) {
    const lc::ControlInfo& info = can.at(ids::FrameDurationLimits.id());
    abilities.frame_duration_us = {info.min().get<std::int64_t>(), info.max().get<std::int64_t>()};
  }
  return abilities;
}

int RealCamera::start(const Orders& orders) {
  const int error = begin(orders);
  if (error != 0) stop();
  return error;
}

int RealCamera::begin(const Orders& orders) {
  camera_->requestCompleted.connect(this, &RealCamera::on_completed);
  if (const int error = make_requests(); error != 0) return error;
  lc::ControlList controls(camera_->controls());
  write(orders, camera_->controls(), controls);
  if (const int error = camera_->start(&controls); error < 0) return -error;
  running_ = true;
  for (const Slot& slot : slots_) {
    if (const int error = camera_->queueRequest(slot.request.get()); error < 0) return -error;
  }
  return 0;
}

int RealCamera::make_requests() {
  lc::Stream* stream = configuration_->at(0).stream();
  allocator_ = std::make_unique<lc::FrameBufferAllocator>(camera_);
  if (const int error = allocator_->allocate(stream); error < 0) return -error;
  for (const std::unique_ptr<lc::FrameBuffer>& buffer : allocator_->buffers(stream)) {
    auto memory = map(*buffer);
    if (const int* error = std::get_if<int>(&memory)) return *error;
    auto request = camera_->createRequest(slots_.size());
    if (!request) return ENODEV;
    if (const int error = request->addBuffer(stream, buffer.get()); error < 0) return -error;
    slots_.push_back({std::move(request), buffer.get(), std::get<MappedPlanes>(std::move(memory))});
  }
  return 0;
}

void RealCamera::stop() {
  if (std::exchange(running_, false)) camera_->stop();  // completes all requests
  camera_->requestCompleted.disconnect(this);
  slots_.clear();
  allocator_.reset();
  const std::lock_guard lock(mutex_);
  completed_.clear();
  wake_up_.clear();
}

/// On the library's thread.
void RealCamera::on_completed(lc::Request* request) {
  const std::lock_guard lock(mutex_);
  completed_.push_back(static_cast<std::uint32_t>(request->cookie()));
  wake_up_.ring();
}

std::optional<Completed> RealCamera::take() {
  std::uint32_t place = 0;
  {
    const std::lock_guard lock(mutex_);
    if (completed_.empty()) return std::nullopt;
    place = completed_.front();
    completed_.pop_front();
    if (completed_.empty()) wake_up_.clear();
  }
  Completed completed = describe(slots_[place]);
  completed.request = place;
  slots_[place].memory.begin_read();
  return completed;
}

Completed RealCamera::describe(const Slot& slot) const {
  const lc::FrameMetadata& frame = slot.buffer->metadata();
  Completed completed;
  completed.sequence = frame.sequence;
  completed.timestamp_ns = static_cast<std::int64_t>(frame.timestamp);
  if (slot.request->status() == lc::Request::RequestCancelled) {
    completed.status = Completed::Status::Cancelled;
    return completed;
  }
  if (frame.status != lc::FrameMetadata::FrameSuccess) {
    completed.status = Completed::Status::Error;
    return completed;
  }
  const lc::ControlList& metadata = slot.request->metadata();
  completed.exposure_begin_ns = metadata.get(ids::SensorTimestamp);
  completed.adjustments = read(metadata);
  const auto& planes = slot.memory.planes();
  for (std::size_t i = 0; i < std::min(planes.size(), frame.planes().size()); ++i) {
    const std::size_t used = frame.planes()[i].bytesused;
    completed.planes.push_back(planes[i].first(std::min(planes[i].size(), used)));
  }
  return completed;
}

int RealCamera::queue(std::uint32_t request, const std::optional<Orders>& orders) {
  const Slot& slot = slots_[request];
  slot.memory.end_read();
  slot.request->reuse(lc::Request::ReuseBuffers);
  if (orders) write(*orders, camera_->controls(), slot.request->controls());
  const int error = camera_->queueRequest(slot.request.get());
  return error < 0 ? -error : 0;
}

class RealCameraSystem : public CameraSystem {
 public:
  RealCameraSystem() {
    manager_.cameraAdded.connect(this, &RealCameraSystem::on_added);
    manager_.cameraRemoved.connect(this, &RealCameraSystem::on_removed);
    if (const int error = manager_.start(); error < 0) {
      throw config::Unavailable("devices.camera: libcamera does not start: " +
                                config::error_text(-error));
    }
  }
  RealCameraSystem(const RealCameraSystem&) = delete;
  RealCameraSystem& operator=(const RealCameraSystem&) = delete;

  std::vector<CameraName> cameras() override {
    std::vector<CameraName> names;
    for (const std::shared_ptr<lc::Camera>& camera : manager_.cameras()) {
      const auto model = camera->properties().get(lc::properties::Model);
      names.push_back({camera->id(), model ? std::string(*model) : camera->id()});
    }
    return names;
  }

  Opened open(const std::string& id) override {
    std::shared_ptr<lc::Camera> camera = manager_.get(id);
    if (!camera) return {nullptr, ENODEV};
    if (const int error = camera->acquire(); error < 0) return {nullptr, -error};
    removals_.forget(camera.get());  // of one that lived at the same address
    return {std::make_unique<RealCamera>(std::move(camera), removals_), 0};
  }

  bool changed() override {
    wake_up_.clear();
    return changed_.exchange(false);
  }
  int watch_fd() const override { return wake_up_.fd(); }

 private:
  // Both on the library's thread.
  void on_added(std::shared_ptr<lc::Camera> /*camera*/) { tell(); }
  void on_removed(std::shared_ptr<lc::Camera> camera) {
    removals_.add(camera.get());
    tell();
  }

  void tell() {
    changed_ = true;
    wake_up_.ring();
  }

  Removals removals_;
  live::WakeUp wake_up_;
  std::atomic<bool> changed_ = false;
  lc::CameraManager manager_;  ///< the last, and so the first to go: it ends the thread
};

}  // namespace

std::unique_ptr<CameraSystem> real_camera_system() {
  // Else it greets, and warns that it has no modules for processors that there may not be. Asked
  // for before it says its first word; who asked for something else gets that.
  ::setenv("LIBCAMERA_LOG_LEVELS", "Camera:WARN,IPAManager:ERROR", 0);
  return std::make_unique<RealCameraSystem>();
}

}  // namespace lumibox::hal::libcam
