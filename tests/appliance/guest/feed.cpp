// Plays a film (film.cpp) into a v4l2loopback device, over and over, forwards and backwards, so
// that the camera never jumps. Runs in the guest.
//
//   feed FILM WIDTH HEIGHT HZ DEVICE
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace {

[[noreturn]] void fail(const char* what) {
  std::perror(what);
  std::exit(1);
}

/// The picture of step `step` of a walk to and fro over `count` pictures.
long to_and_fro(long step, long count) {
  if (count < 2) return 0;
  const long period = 2 * (count - 1);
  const long at = step % period;
  return at < count ? at : period - at;
}

void set_format(int device, unsigned width, unsigned height, unsigned rate_hz) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = width;
  format.fmt.pix.height = height;
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = 2 * width;
  format.fmt.pix.sizeimage = 2 * width * height;
  format.fmt.pix.colorspace = V4L2_COLORSPACE_SRGB;
  if (ioctl(device, VIDIOC_S_FMT, &format) != 0) fail("feed: format");
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  rate.parm.output.timeperframe = {1, rate_hz};
  if (ioctl(device, VIDIOC_S_PARM, &rate) != 0) fail("feed: rate");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: feed FILM WIDTH HEIGHT HZ DEVICE\n");
    return 2;
  }
  const auto width = static_cast<unsigned>(std::atoi(argv[2]));
  const auto height = static_cast<unsigned>(std::atoi(argv[3]));
  const auto rate_hz = static_cast<unsigned>(std::atoi(argv[4]));
  if (width == 0 || height == 0 || rate_hz == 0) {
    std::fprintf(stderr, "feed: WIDTH, HEIGHT and HZ must be numbers of at least 1\n");
    return 2;
  }
  const std::size_t picture = std::size_t{2} * width * height;

  const int film = open(argv[1], O_RDONLY | O_CLOEXEC);
  struct stat info {};
  if (film < 0 || fstat(film, &info) != 0) fail(argv[1]);
  const long count = info.st_size / static_cast<long>(picture);
  void* const pictures =
      mmap(nullptr, static_cast<std::size_t>(info.st_size), PROT_READ, MAP_SHARED, film, 0);
  if (pictures == MAP_FAILED) fail(argv[1]);

  const int device = open(argv[5], O_RDWR | O_CLOEXEC);
  if (device < 0) fail(argv[5]);
  set_format(device, width, height, rate_hz);

  timespec next{};
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (long step = 0;; ++step) {
    const auto* at = static_cast<const char*>(pictures) +
                     static_cast<std::size_t>(to_and_fro(step, count)) * picture;
    if (write(device, at, picture) < 0) fail("feed: write");
    next.tv_nsec += 1'000'000'000L / static_cast<long>(rate_hz);
    if (next.tv_nsec >= 1'000'000'000L) {
      next.tv_nsec -= 1'000'000'000L;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
  }
}
