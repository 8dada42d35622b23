#include "hal/fake_libcamera.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <deque>

namespace lumibox::testing {
namespace {

using hal::libcam::Abilities;
using hal::libcam::Adjustments;
using hal::libcam::CameraName;
using hal::libcam::Completed;
using hal::libcam::Configured;
using hal::libcam::Offer;
using hal::libcam::Opened;
using hal::libcam::Orders;
namespace live = hal::live;

constexpr std::uint32_t kRequests = 4;

void overwrite(Adjustments& target, const Adjustments& source) {
  if (source.exposure_us) target.exposure_us = source.exposure_us;
  if (source.gain) target.gain = source.gain;
  if (source.white_gains) target.white_gains = source.white_gains;
  if (source.lens_dioptres) target.lens_dioptres = source.lens_dioptres;
}

/// A camera that somebody has acquired.
class OpenFake : public hal::libcam::OpenCamera {
 public:
  OpenFake(const hal::Clock& clock, std::shared_ptr<FakeSensor> sensor, int event_fd)
      : clock_(clock), sensor_(std::move(sensor)), plugs_(sensor_->plugs), event_fd_(event_fd) {
    ++sensor_->open;
    ++sensor_->opened;
    sensor_->queue_error = 0;
  }
  ~OpenFake() override { --sensor_->open; }
  OpenFake(const OpenFake&) = delete;
  OpenFake& operator=(const OpenFake&) = delete;

  std::vector<Offer> offers() override {
    touch();
    return is_removed() ? std::vector<Offer>{} : sensor_->offers;
  }

  std::variant<Configured, int> configure(const live::Mode& mode) override {
    touch();
    if (is_removed()) return ENODEV;
    const Configured got = sensor_->gives.value_or(
        Configured{mode.format, mode.width, mode.height, 0, sensor_->limited_range});
    mode_ = {got.format.value_or(mode.format), got.width, got.height, {}};
    layout_ = live::make_layout(mode_, 0, false);
    layout_ = live::make_layout(mode_, layout_.stride + sensor_->padding, sensor_->limited_range);
    return Configured{got.format, got.width, got.height, layout_.stride, got.limited_range};
  }

  Abilities abilities() const override { return sensor_->abilities; }

  int start(const Orders& orders) override {
    touch();
    if (is_removed()) return ENODEV;
    if (sensor_->start_error != 0) return sensor_->start_error;
    ++sensor_->streams;
    streaming_ = true;
    begun_ns_ = clock_.now_ns();
    ticks_ = 0;
    sequence_ = 0;
    buffers_.assign(kRequests, {});
    for (std::uint32_t i = 0; i < kRequests; ++i) queued_.push_back(i);
    tell(orders, 0);
    obey();
    return 0;
  }

  void stop() override {
    streaming_ = false;
    queued_.clear();
    done_.clear();
    told_.clear();
  }

  std::optional<Completed> take() override {
    touch();
    eventfd_t count = 0;
    eventfd_read(event_fd_, &count);
    if (is_removed()) {
      cancel_all();
    } else {
      make_pictures();
    }
    if (done_.empty()) return std::nullopt;
    const Completed first = done_.front();
    done_.pop_front();
    return first;
  }

  int queue(std::uint32_t request, const std::optional<Orders>& orders) override {
    touch();
    if (is_removed()) return ENODEV;
    if (sensor_->queue_error != 0) return sensor_->queue_error;
    if (request >= kRequests || std::ranges::find(queued_, request) != queued_.end()) return EINVAL;
    queued_.push_back(request);
    if (orders) tell(*orders, static_cast<std::uint32_t>(sensor_->latency));
    return 0;
  }

  bool is_removed() const override { return !sensor_->plugged || plugs_ != sensor_->plugs; }
  int poll_fd() const override { return event_fd_; }

 private:
  struct Told {
    std::uint32_t from;  ///< sequence of the first picture of it
    Orders orders;
  };

  void touch() {
    if (sensor_->calls_until_unplugged == 0) sensor_->unplug();
    if (sensor_->calls_until_unplugged >= 0) --sensor_->calls_until_unplugged;
  }

  void tell(const Orders& orders, std::uint32_t latency) {
    sensor_->orders.push_back(orders);
    if (sensor_->deaf > 0) {
      --sensor_->deaf;
      return;
    }
    told_.push_back({sequence_ + latency, orders});
  }

  /// What is due before the next picture.
  void obey() {
    while (!told_.empty() && told_.front().from <= sequence_) {
      const Orders orders = told_.front().orders;
      told_.pop_front();
      if (orders.frame_duration_us) duration_us_ = *orders.frame_duration_us;
      if (orders.automatic) automatic_ = *orders.automatic;
      if (automatic_) continue;
      if (orders.automatic && sensor_->freezes) continue;
      overwrite(held_, orders.values);
    }
    if (automatic_) held_ = sensor_->own;
    sensor_->now = held_;
  }

  void cancel_all() {
    if (!sensor_->cancels) return;
    for (const std::uint32_t request : queued_) {
      Completed cancelled;
      cancelled.request = request;
      cancelled.status = Completed::Status::Cancelled;
      cancelled.sequence = sequence_;
      done_.push_back(cancelled);
    }
    queued_.clear();
  }

  /// All that have become due by now.
  void make_pictures() {
    if (!streaming_) return;
    while (begun_ns_ + (ticks_ + 1) * 1000 * duration_us_ <= clock_.now_ns()) {
      ++ticks_;
      if (is_silent(sensor_->silence, sensor_->streams, sensor_->opened)) continue;
      make_picture(begun_ns_ + ticks_ * 1000 * duration_us_);
      ++sequence_;
    }
  }

  void make_picture(std::int64_t timestamp_ns) {
    obey();
    if (queued_.empty() || sensor_->skipped.contains(sequence_)) return;
    Completed done;
    done.request = queued_.front();
    queued_.pop_front();
    done.sequence = sequence_;
    done.timestamp_ns = timestamp_ns;
    if (sensor_->says_exposure_begin) done.exposure_begin_ns = timestamp_ns;
    if (sensor_->cancelled.contains(sequence_)) done.status = Completed::Status::Cancelled;
    if (sensor_->faulty.contains(sequence_)) done.status = Completed::Status::Error;
    if (done.status == Completed::Status::Success) done.adjustments = sensor_->now;
    if (done.status != Completed::Status::Cancelled) fill(buffers_[done.request], done.planes);
    done_.push_back(done);
  }

  /// Each plane where the one before, and what is spare of it, ends.
  void fill(std::vector<std::uint8_t>& buffer,
            std::vector<std::span<const std::uint8_t>>& planes) const {
    const std::vector<std::uint8_t> picture =
        encode(picture_of(static_cast<int>(sequence_), mode_.width, mode_.height), mode_.format,
               sensor_->limited_range, sensor_->padding);
    std::vector<std::size_t> sizes = live::plane_sizes(layout_);
    if (sizes.empty() || sensor_->in_one_piece) sizes = {picture.size()};
    buffer.assign(picture.size() + sizes.size() * sensor_->spare, 0xEE);
    std::size_t from = 0;
    std::size_t to = 0;
    for (const std::size_t size : sizes) {
      std::copy_n(picture.begin() + static_cast<std::ptrdiff_t>(from), size,
                  buffer.begin() + static_cast<std::ptrdiff_t>(to));
      const std::size_t given = sensor_->cut.contains(sequence_) ? size / 2 : size + sensor_->spare;
      planes.emplace_back(std::span<const std::uint8_t>(buffer).subspan(to, given));
      from += size;
      to += size + sensor_->spare;
    }
  }

  const hal::Clock& clock_;
  std::shared_ptr<FakeSensor> sensor_;
  int plugs_;
  int event_fd_;
  live::Mode mode_;
  live::Layout layout_;
  std::int64_t duration_us_ = 100'000;
  std::vector<std::vector<std::uint8_t>> buffers_;
  std::deque<std::uint32_t> queued_;
  std::deque<Completed> done_;
  std::deque<Told> told_;
  bool automatic_ = true;
  Adjustments held_;
  bool streaming_ = false;
  std::int64_t begun_ns_ = 0;
  std::int64_t ticks_ = 0;  ///< durations since then
  std::uint32_t sequence_ = 0;
};

}  // namespace

Offer offer(live::PixelFormat format, std::uint32_t width, std::uint32_t height) {
  return {format, {width, height}, {width, height}, {1, 1}};
}

void FakeSensor::unplug() {
  plugged = false;
  ++plugs;
}

FakeLibcamera::FakeLibcamera(const hal::Clock& clock,
                             std::vector<std::shared_ptr<FakeSensor>> sensors)
    : clock_(clock),
      sensors_(std::move(sensors)),
      event_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

FakeLibcamera::~FakeLibcamera() {
  close(event_fd_);
}

std::vector<CameraName> FakeLibcamera::cameras() {
  std::vector<CameraName> names;
  for (const auto& sensor : sensors_) {
    if (sensor->plugged) names.push_back({sensor->id, sensor->model});
  }
  return names;
}

Opened FakeLibcamera::open(const std::string& id) {
  for (const auto& sensor : sensors_) {
    if (!sensor->plugged || sensor->id != id) continue;
    if (sensor->open_error != 0) return {nullptr, sensor->open_error};
    if (sensor->open > 0) return {nullptr, EBUSY};
    return {std::make_unique<OpenFake>(clock_, sensor, event_fd_), 0};
  }
  return {nullptr, ENODEV};
}

void FakeLibcamera::wake() {
  eventfd_write(event_fd_, 1);
}

}  // namespace lumibox::testing
