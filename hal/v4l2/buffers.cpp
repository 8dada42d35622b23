#include "hal/v4l2/buffers.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include "hal/live/refusal.h"

namespace lumibox::hal::v4l2 {
namespace {

// One is being filled and one read; two more keep the camera going while the reader is late.
constexpr std::uint32_t kBuffers = 4;

v4l2_buffer mapped_buffer(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

v4l2_requestbuffers request_for(std::uint32_t count) {
  v4l2_requestbuffers request{};
  request.count = count;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  return request;
}

}  // namespace

BufferRing::~BufferRing() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  device_.ioctl(VIDIOC_STREAMOFF, &type);
  for (const std::span<std::uint8_t> memory : buffers_) device_.unmap(memory);
  v4l2_requestbuffers none = request_for(0);
  device_.ioctl(VIDIOC_REQBUFS, &none);
}

std::optional<std::string> BufferRing::begin() {
  v4l2_requestbuffers request = request_for(kBuffers);
  if (const int error = device_.ioctl(VIDIOC_REQBUFS, &request); error != 0) {
    return live::refusal("gives no buffers", error);
  }
  // As many as it likes, but the kernel has no more than these.
  const std::uint32_t count = std::min<std::uint32_t>(request.count, VIDEO_MAX_FRAME);
  if (auto fault = map_buffers(count)) return fault;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (const int error = queue(i); error != 0) return live::refusal("takes no buffers", error);
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int error = device_.ioctl(VIDIOC_STREAMON, &type); error != 0) {
    return live::refusal("does not stream", error);
  }
  return std::nullopt;
}

std::optional<std::string> BufferRing::map_buffers(std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    v4l2_buffer buffer = mapped_buffer(i);
    if (const int error = device_.ioctl(VIDIOC_QUERYBUF, &buffer); error != 0) {
      return live::refusal("does not describe its buffers", error);
    }
    const std::span<std::uint8_t> memory = device_.map(buffer.length, buffer.m.offset);
    if (memory.empty()) return "does not share its buffers";
    buffers_.push_back(memory);
  }
  return std::nullopt;
}

int BufferRing::take(live::Filled& filled) {
  v4l2_buffer buffer = mapped_buffer(0);
  if (const int error = device_.ioctl(VIDIOC_DQBUF, &buffer); error != 0) return error;
  if (buffer.index >= buffers_.size()) return EIO;
  const std::span<std::uint8_t> memory = buffers_[buffer.index];
  filled.buffer = buffer.index;
  filled.bytes[0] = memory.first(std::min<std::size_t>(buffer.bytesused, memory.size()));
  filled.sequence = buffer.sequence;
  filled.timestamp_ns =
      std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 + buffer.timestamp.tv_usec * 1000;
  filled.monotonic =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  filled.start_of_exposure =
      (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  filled.faulty = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  return 0;
}

int BufferRing::give_back(const live::Filled& filled) {
  return queue(filled.buffer);
}

int BufferRing::queue(std::uint32_t index) {
  v4l2_buffer buffer = mapped_buffer(index);
  return device_.ioctl(VIDIOC_QBUF, &buffer);
}

}  // namespace lumibox::hal::v4l2
