#include "hal/fake_video.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <limits>

namespace lumibox::testing {
namespace {

using hal::v4l2::Node;
using hal::v4l2::Opened;

hal::live::PixelFormat format_of(std::uint32_t fourcc) {
  switch (fourcc) {
    case V4L2_PIX_FMT_YUYV:
      return hal::live::PixelFormat::Yuyv;
    case V4L2_PIX_FMT_NV12:
      return hal::live::PixelFormat::Nv12;
    case V4L2_PIX_FMT_GREY:
      return hal::live::PixelFormat::Grey;
    default:
      return hal::live::PixelFormat::Mjpeg;
  }
}

template <std::size_t n>
void set_text(__u8 (&field)[n], const std::string& text) {
  std::memcpy(field, text.data(), std::min(text.size(), n - 1));
}

/// A camera that somebody has open.
class OpenFake : public hal::v4l2::VideoDevice {
 public:
  OpenFake(const hal::Clock& clock, std::shared_ptr<FakeCamera> camera, int event_fd)
      : clock_(clock), camera_(std::move(camera)), plugs_(camera_->plugs), event_fd_(event_fd) {
    ++camera_->open;
  }
  ~OpenFake() override { --camera_->open; }
  OpenFake(const OpenFake&) = delete;
  OpenFake& operator=(const OpenFake&) = delete;

  int ioctl(unsigned long request, void* argument) override;

  std::span<std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    ++camera_->mapped;
    return std::span(buffers_.at(static_cast<std::size_t>(offset))).first(length);
  }
  void unmap(std::span<std::uint8_t> /*memory*/) override { --camera_->mapped; }
  bool hung_up() override { return camera_->hung_up || is_gone(); }
  int poll_fd() const override { return event_fd_; }

 private:
  struct Done {
    std::uint32_t buffer;
    std::size_t bytes;
    std::uint32_t sequence;
    std::int64_t timestamp_ns;
  };

  bool is_gone() const { return !camera_->plugged || plugs_ != camera_->plugs; }
  int describe(v4l2_capability& capability) const;
  int enumerate_format(v4l2_fmtdesc& format) const;
  int enumerate_size(v4l2_frmsizeenum& size) const;
  int enumerate_interval(v4l2_frmivalenum& interval) const;
  int set_format(v4l2_format& format);
  int set_parameters(v4l2_streamparm& parameters);
  int get_parameters(v4l2_streamparm& parameters) const;
  int request_buffers(v4l2_requestbuffers& request);
  int describe_buffer(v4l2_buffer& buffer) const;
  int queue(const v4l2_buffer& buffer);
  int dequeue(v4l2_buffer& buffer);
  int begin();
  int end();
  int describe_control(v4l2_queryctrl& control) const;
  int describe_entry(const v4l2_querymenu& entry) const;
  int read_control(v4l2_control& control) const;
  int write_control(const v4l2_control& control);
  void make_pictures();
  void make_picture(std::uint32_t sequence, std::int64_t timestamp_ns);

  const hal::Clock& clock_;
  std::shared_ptr<FakeCamera> camera_;
  int plugs_;
  int event_fd_;
  FakeMode mode_;
  v4l2_fract interval_{1, 10};
  std::vector<std::vector<std::uint8_t>> buffers_;
  std::deque<std::uint32_t> queued_;
  std::deque<Done> done_;
  bool streaming_ = false;
  int streams_ = 0;  ///< of this opening
  std::int64_t begun_ns_ = 0;
  std::int64_t ticks_ = 0;  ///< periods since then
  std::uint32_t sequence_ = 0;
};

int OpenFake::ioctl(unsigned long request, void* argument) {
  ++camera_->calls;
  if (camera_->calls_until_unplugged == 0) camera_->unplug();
  if (camera_->calls_until_unplugged >= 0) --camera_->calls_until_unplugged;
  if (is_gone()) return ENODEV;
  switch (request) {
    case VIDIOC_QUERYCAP:
      return describe(*static_cast<v4l2_capability*>(argument));
    case VIDIOC_ENUM_FMT:
      return enumerate_format(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerate_size(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate_interval(*static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_S_FMT:
      return set_format(*static_cast<v4l2_format*>(argument));
    case VIDIOC_S_PARM:
      return set_parameters(*static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_G_PARM:
      return get_parameters(*static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_REQBUFS:
      return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return describe_buffer(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      return queue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_DQBUF:
      return dequeue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_STREAMON:
      return begin();
    case VIDIOC_STREAMOFF:
      return end();
    case VIDIOC_QUERYCTRL:
      return describe_control(*static_cast<v4l2_queryctrl*>(argument));
    case VIDIOC_QUERYMENU:
      return describe_entry(*static_cast<v4l2_querymenu*>(argument));
    case VIDIOC_G_CTRL:
      return read_control(*static_cast<v4l2_control*>(argument));
    case VIDIOC_S_CTRL:
      return write_control(*static_cast<v4l2_control*>(argument));
    default:
      return ENOTTY;
  }
}

int OpenFake::describe(v4l2_capability& capability) const {
  set_text(capability.driver, "fake");
  set_text(capability.card, camera_->card);
  set_text(capability.bus_info, "memory:" + camera_->path);
  capability.device_caps = camera_->capabilities;
  capability.capabilities = camera_->capabilities | V4L2_CAP_DEVICE_CAPS;
  return 0;
}

int OpenFake::enumerate_format(v4l2_fmtdesc& format) const {
  std::vector<std::uint32_t> formats;
  for (const FakeMode& mode : camera_->modes) {
    if (std::ranges::find(formats, mode.fourcc) == formats.end()) formats.push_back(mode.fourcc);
  }
  if (format.index >= formats.size() && !camera_->endless) return EINVAL;
  format.pixelformat = formats[format.index % formats.size()];
  return 0;
}

int OpenFake::enumerate_size(v4l2_frmsizeenum& size) const {
  if (camera_->endless) size.index = 0;
  if (camera_->any_size) {
    if (size.index > 0) return EINVAL;
    size.type = V4L2_FRMSIZE_TYPE_STEPWISE;
    size.stepwise = *camera_->any_size;
    return 0;
  }
  std::uint32_t index = 0;
  for (const FakeMode& mode : camera_->modes) {
    if (mode.fourcc != size.pixel_format || index++ != size.index) continue;
    size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size.discrete = {static_cast<std::uint32_t>(mode.width),
                     static_cast<std::uint32_t>(mode.height)};
    return 0;
  }
  return EINVAL;
}

int OpenFake::enumerate_interval(v4l2_frmivalenum& interval) const {
  if (camera_->endless) interval.index = 0;
  if (camera_->any_rate) {
    if (interval.index > 0) return EINVAL;
    interval.type = V4L2_FRMIVAL_TYPE_STEPWISE;
    interval.stepwise = *camera_->any_rate;
    return 0;
  }
  for (const FakeMode& mode : camera_->modes) {
    if (mode.fourcc != interval.pixel_format || mode.width != static_cast<int>(interval.width) ||
        mode.height != static_cast<int>(interval.height) || interval.index >= mode.rates.size()) {
      continue;
    }
    interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    interval.discrete = {1, mode.rates[interval.index]};
    return 0;
  }
  return EINVAL;
}

int OpenFake::set_format(v4l2_format& format) {
  if (!buffers_.empty()) return EBUSY;
  v4l2_pix_format& pix = format.fmt.pix;
  const auto fits = [&](const FakeMode& mode) {
    return mode.fourcc == pix.pixelformat && mode.width == static_cast<int>(pix.width) &&
           mode.height == static_cast<int>(pix.height);
  };
  const auto found = std::ranges::find_if(camera_->modes, fits);
  mode_ = found == camera_->modes.end() ? camera_->modes.front() : *found;
  if (camera_->any_size) {
    mode_.width = static_cast<int>(pix.width);
    mode_.height = static_cast<int>(pix.height);
  }
  if (camera_->other_size) std::tie(mode_.width, mode_.height) = *camera_->other_size;
  pix.pixelformat = mode_.fourcc;
  pix.field = camera_->field;
  pix.width = static_cast<std::uint32_t>(mode_.width);
  pix.height = static_cast<std::uint32_t>(mode_.height);
  const std::size_t row = mode_.fourcc == V4L2_PIX_FMT_YUYV ? 2U * pix.width : pix.width;
  pix.bytesperline =
      mode_.fourcc == V4L2_PIX_FMT_MJPEG ? 0 : static_cast<std::uint32_t>(row + camera_->padding);
  const bool full = mode_.fourcc == V4L2_PIX_FMT_MJPEG || !camera_->limited_range;
  pix.colorspace = full ? V4L2_COLORSPACE_JPEG : V4L2_COLORSPACE_SRGB;
  pix.quantization = V4L2_QUANTIZATION_DEFAULT;
  return 0;
}

int OpenFake::set_parameters(v4l2_streamparm& parameters) {
  interval_ = parameters.parm.capture.timeperframe;
  return get_parameters(parameters);
}

int OpenFake::get_parameters(v4l2_streamparm& parameters) const {
  parameters.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
  parameters.parm.capture.timeperframe = camera_->other_interval.value_or(interval_);
  return 0;
}

int OpenFake::request_buffers(v4l2_requestbuffers& request) {
  if (camera_->busy_error != 0) return camera_->busy_error;
  constexpr std::size_t kMostBytes = 1U << 20;
  buffers_.assign(request.count, std::vector<std::uint8_t>(kMostBytes));
  queued_.clear();
  done_.clear();
  return 0;
}

int OpenFake::describe_buffer(v4l2_buffer& buffer) const {
  if (buffer.index >= buffers_.size()) return EINVAL;
  buffer.length = static_cast<std::uint32_t>(buffers_[buffer.index].size());
  buffer.m.offset = buffer.index;
  return 0;
}

int OpenFake::queue(const v4l2_buffer& buffer) {
  make_pictures();
  const bool is_queued = std::ranges::find(queued_, buffer.index) != queued_.end();
  if (buffer.index >= buffers_.size() || is_queued) return EINVAL;
  queued_.push_back(buffer.index);
  return 0;
}

int OpenFake::dequeue(v4l2_buffer& buffer) {
  eventfd_t count = 0;
  eventfd_read(event_fd_, &count);
  make_pictures();
  if (camera_->take_error != 0) return camera_->take_error;
  if (!streaming_) return EINVAL;
  if (camera_->hasty && done_.empty()) make_picture(sequence_++, clock_.now_ns());
  if (done_.empty()) return EAGAIN;
  const Done done = done_.front();
  done_.pop_front();
  buffer.index = done.buffer;
  buffer.bytesused = static_cast<std::uint32_t>(done.bytes);
  buffer.sequence = done.sequence;
  buffer.timestamp.tv_sec = done.timestamp_ns / 1'000'000'000;
  buffer.timestamp.tv_usec = done.timestamp_ns % 1'000'000'000 / 1000;
  buffer.flags = camera_->monotonic ? V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC : 0;
  buffer.flags |= camera_->start_of_exposure ? V4L2_BUF_FLAG_TSTAMP_SRC_SOE : 0;
  buffer.flags |= camera_->faulty.contains(done.sequence) ? V4L2_BUF_FLAG_ERROR : 0;
  return 0;
}

int OpenFake::begin() {
  streaming_ = true;
  begun_ns_ = clock_.now_ns();
  ticks_ = 0;
  sequence_ = 0;
  ++camera_->streams;
  ++streams_;
  return 0;
}

int OpenFake::end() {
  streaming_ = false;
  queued_.clear();
  done_.clear();
  return 0;
}

int OpenFake::describe_control(v4l2_queryctrl& control) const {
  const bool next = (control.id & V4L2_CTRL_FLAG_NEXT_CTRL) != 0;
  const std::uint32_t id = control.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
  const auto found = next ? camera_->controls.upper_bound(id) : camera_->controls.find(id);
  if (next && found == camera_->controls.end() && camera_->endless) return 0;  // just as asked
  if (found == camera_->controls.end()) return EINVAL;
  control = {};
  control.id = found->first;
  control.type = found->second.type;
  control.minimum = found->second.least;
  control.maximum = found->second.most;
  control.default_value = found->second.usual;
  set_text(control.name, found->second.name);
  return 0;
}

int OpenFake::describe_entry(const v4l2_querymenu& entry) const {
  const auto found = camera_->controls.find(entry.id);
  const bool offered = found != camera_->controls.end() &&
                       found->second.entries.contains(static_cast<std::int32_t>(entry.index));
  return offered ? 0 : EINVAL;
}

int OpenFake::read_control(v4l2_control& control) const {
  const auto found = camera_->controls.find(control.id);
  if (found == camera_->controls.end()) return EINVAL;
  control.value = found->second.value;
  return 0;
}

int OpenFake::write_control(const v4l2_control& control) {
  camera_->writes.emplace_back(control.id, control.value);
  const auto found = camera_->controls.find(control.id);
  if (found == camera_->controls.end()) return EINVAL;
  FakeControl& own = found->second;
  if (own.ruled_by != 0 && camera_->controls.at(own.ruled_by).value != own.ruled_unless) return EIO;
  if (own.refusals > 0) {
    --own.refusals;
    return EBUSY;
  }
  if (!own.stubborn) own.value = control.value;
  return 0;
}

/// All that have become due by now.
void OpenFake::make_pictures() {
  if (!streaming_) return;
  const v4l2_fract interval = camera_->other_interval.value_or(interval_);
  const std::int64_t period_ns = 1'000'000'000LL * interval.numerator / interval.denominator;
  while (begun_ns_ + (ticks_ + 1) * period_ns <= clock_.now_ns()) {
    ++ticks_;
    if (is_silent(camera_->silence, camera_->streams, camera_->opened)) continue;
    make_picture(sequence_++, begun_ns_ + ticks_ * period_ns);
  }
}

void OpenFake::make_picture(std::uint32_t sequence, std::int64_t timestamp_ns) {
  if (queued_.empty() || camera_->skipped.contains(sequence)) return;
  std::vector<std::uint8_t> bytes =
      encode(picture_of(static_cast<int>(sequence), mode_.width, mode_.height),
             format_of(mode_.fourcc), camera_->limited_range, camera_->padding);
  if (camera_->cut.contains(sequence)) bytes.resize(bytes.size() / 2);
  if (camera_->garbled.contains(sequence)) {
    // In the middle of the compressed picture: begins and ends as it should.
    std::fill(bytes.end() - 60, bytes.end() - 10, std::uint8_t{0xFF});
  }
  const std::uint32_t buffer = queued_.front();
  queued_.pop_front();
  std::ranges::copy(bytes, buffers_[buffer].begin());
  done_.push_back({buffer, bytes.size(), sequence, timestamp_ns});
}

}  // namespace

void FakeCamera::unplug() {
  plugged = false;
  ++plugs;
}

void FakeCamera::plug() {
  plugged = true;
}

std::map<std::uint32_t, FakeControl> webcam_controls() {
  std::map<std::uint32_t, FakeControl> controls;
  const auto flag = [](const char* name, std::int32_t value) {
    return FakeControl{.name = name, .type = V4L2_CTRL_TYPE_BOOLEAN, .most = 1, .value = value};
  };
  controls[V4L2_CID_AUTO_WHITE_BALANCE] = flag("White Balance, Automatic", 1);
  controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE] = {.name = "White Balance Temperature",
                                                  .least = 2000,
                                                  .most = 6500,
                                                  .value = 4600,
                                                  .ruled_by = V4L2_CID_AUTO_WHITE_BALANCE,
                                                  .ruled_unless = 0};
  controls[V4L2_CID_POWER_LINE_FREQUENCY] = {.name = "Power Line Frequency",
                                             .type = V4L2_CTRL_TYPE_MENU,
                                             .most = 2,
                                             .value = 2,
                                             .entries = {0, 1, 2}};
  controls[V4L2_CID_EXPOSURE_AUTO] = {
      .name = "Auto Exposure",
      .type = V4L2_CTRL_TYPE_MENU,
      .most = 3,
      .value = V4L2_EXPOSURE_APERTURE_PRIORITY,
      .entries = {V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_APERTURE_PRIORITY}};
  controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {.name = "Exposure Time, Absolute",
                                          .least = 3,
                                          .most = 2047,
                                          .value = 156,
                                          .ruled_by = V4L2_CID_EXPOSURE_AUTO,
                                          .ruled_unless = V4L2_EXPOSURE_MANUAL};
  controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY] = flag("Exposure, Dynamic Framerate", 1);
  controls[V4L2_CID_FOCUS_AUTO] = flag("Focus, Automatic Continuous", 1);
  controls[V4L2_CID_FOCUS_ABSOLUTE] = {.name = "Focus, Absolute",
                                       .most = 250,
                                       .value = 40,
                                       .ruled_by = V4L2_CID_FOCUS_AUTO,
                                       .ruled_unless = 0};
  for (auto& [id, control] : controls) control.usual = control.value;
  return controls;
}

FakeVideo::FakeVideo(const hal::Clock& clock, std::vector<std::shared_ptr<FakeCamera>> cameras)
    : clock_(clock),
      cameras_(std::move(cameras)),
      event_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

FakeVideo::~FakeVideo() {
  close(event_fd_);
}

std::vector<Node> FakeVideo::nodes() {
  std::vector<Node> nodes;
  for (const auto& camera : cameras_) {
    if (camera->plugged) nodes.push_back({camera->path, camera->stable_path});
  }
  return nodes;
}

Opened FakeVideo::open(const std::string& path) {
  for (const auto& camera : cameras_) {
    if (!camera->plugged || (camera->path != path && camera->stable_path != path)) continue;
    if (camera->open_error != 0) return {nullptr, camera->open_error};
    ++camera->opened;
    camera->take_error = 0;
    camera->hung_up = false;
    return {std::make_unique<OpenFake>(clock_, camera, event_fd_), 0};
  }
  return {nullptr, ENOENT};
}

void FakeVideo::wake() {
  eventfd_write(event_fd_, 1);
}

}  // namespace lumibox::testing
