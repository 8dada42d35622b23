// In a program of its own, for it replaces operator new.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "geometry/rotation.h"
#include "tracking/textured_world.h"
#include "tracking/tracker.h"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
// What std::stable_sort takes its buffer from.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace lumibox::tracking {
namespace {

// To and fro over a way that the map knows: the second time everything has the memory it needs.
void expect_no_allocations(const config::CameraProfile& profile) {
  const geometry::Camera camera(profile);
  std::vector<hal::Image> images;
  for (int i = 0; i < 24; ++i) {
    const geometry::Pose pose(geometry::exp_so3(Eigen::Vector3d(0.0, -0.004 * i, 0.0)),
                              Eigen::Vector3d(0.015 * i, 0.0015 * i, 0.0));
    images.push_back(testing::render_wedge(camera, pose));
  }
  config::Tracking options;
  options.pyramid_levels = 3;
  Tracker tracker(camera, options, Mapping::Lockstep, 1);
  int steady = 0;
  for (int i = 0; i < 4 * 23; ++i) {
    const int step = i % 46;
    const hal::Image& image = images[static_cast<std::size_t>(step < 23 ? step : 46 - step)];
    const auto revision = tracker.map_revision();
    const long before = allocations;
    const TrackedFrame frame = tracker.track(image, i, i * std::int64_t{33'333'333});
    const long during = allocations - before;
    if (i < 46 || frame.state != TrackingState::Good || tracker.map_revision() != revision)
      continue;
    EXPECT_EQ(during, 0) << "frame " << i;
    ++steady;
  }
  EXPECT_GT(steady, 20) << "or this tests little";
}

TEST(Allocation, ATrackedFrameNeedsNoMemory) {
  expect_no_allocations(testing::small_camera().profile());
}

TEST(Allocation, NorDoesOneOfARollingShutter) {
  config::CameraProfile profile = testing::small_camera().profile();
  profile.readout_s = 1e-4;  // the pictures are of a global one
  expect_no_allocations(profile);
}

}  // namespace
}  // namespace lumibox::tracking
