#include "lightfield/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <map>
#include <nlohmann/json.hpp>

#include "hal/image_io.h"
#include "lightfield/fixtures.h"
#include "lightfield/transforms.h"
#include "support/source_file.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using testing::files_in;
using ::testing::HasSubstr;

const Sphere kSphere{Eigen::Vector3d(0.1, -0.2, 3.0), 0.7};

/// Every kind of change, in the order of a capture: record, wipe, correct the map, undo.
void act_out(Store& store) {
  std::vector<Perspective> taken;
  for (int i = 0; i < 6; ++i) {
    taken.push_back(make_perspective(i, kSphere.center, small_camera()));
  }
  store.set_subject(kSphere);
  for (int i = 0; i < 4; ++i) store.add(taken[static_cast<std::size_t>(i)]);
  store.remove(1);
  store.remove(2);
  store.set_points({{1.0, 2.0, 3.0}, {0.1, 0.2, 1.0 / 3.0}});
  store.set_subject({kSphere.center, 0.8});
  store.set_pose(0, taken[5].world_from_camera);
  store.set_pose(3, taken[4].world_from_camera);
  store.restore(taken[2]);
  store.set_points({{4.0, 5.0, 6.0}});
  store.add(taken[4]);
  store.set_pose(4, taken[0].world_from_camera);
}

TEST(Store, EmptyCaptureIsLoadable) {
  const TemporaryFolder folder;
  const Store store(folder / "deep/down/capture", 90, Writing::Inline);
  const Capture capture = load_capture(folder / "deep/down/capture");
  EXPECT_TRUE(capture.light_field.perspectives().empty());
  EXPECT_FALSE(capture.light_field.subject());
}

TEST(Store, LoadsBackWhatWasRecorded) {
  const TemporaryFolder folder;
  {
    Store store(folder / "c", 90, Writing::Inline);
    act_out(store);
  }
  const Capture capture = load_capture(folder / "c");
  ASSERT_EQ(capture.light_field.perspectives().size(), 4U);
  EXPECT_EQ(capture.light_field.subject()->center, kSphere.center);
  EXPECT_EQ(capture.light_field.subject()->radius, 0.8);
  ASSERT_EQ(capture.points.size(), 1U);
  EXPECT_EQ(capture.points[0], Eigen::Vector3d(4.0, 5.0, 6.0));
  const std::map<int, int> pose_of{{0, 5}, {2, 2}, {3, 4}, {4, 0}};
  for (const Perspective& loaded : capture.light_field.perspectives()) {
    const Perspective taken = make_perspective(loaded.id, kSphere.center, small_camera());
    const geometry::Pose expected = orbit_pose(pose_of.at(loaded.id), kSphere.center);
    EXPECT_LT((loaded.world_from_camera.matrix4() - expected.matrix4()).norm(), 1e-14);
    EXPECT_EQ(loaded.timestamp_ns, taken.timestamp_ns);
    EXPECT_EQ(loaded.keyframe, taken.keyframe);
    EXPECT_LT((loaded.keyframe_from_camera.matrix4() - taken.keyframe_from_camera.matrix4()).norm(),
              1e-14);
    EXPECT_NEAR(loaded.camera->profile().cx, taken.camera->profile().cx, 1e-14);
    EXPECT_EQ(loaded.camera->profile().p2, taken.camera->profile().p2);
    EXPECT_EQ(*loaded.photo->rgb(),
              hal::decode_jpeg(hal::encode_jpeg(*taken.photo->rgb(), 90), "memory"));
  }
}

TEST(Store, IsWhatNerfstudioReads) {
  const TemporaryFolder folder;
  {
    Store store(folder / "c", 90, Writing::Inline);
    act_out(store);
  }
  const auto json = nlohmann::json::parse(read_text(folder / "c" / "transforms.json"));
  EXPECT_EQ(json.at("camera_model"), "OPENCV");
  EXPECT_EQ(json.at("w"), 16);
  EXPECT_EQ(json.at("h"), 12);
  EXPECT_EQ(json.at("fl_x"), 20.1);
  EXPECT_EQ(json.at("cx"), 7.4 + 0.5);  // the first pixel's centre is at 0.5 there
  EXPECT_EQ(json.at("k1"), 0.05);
  EXPECT_EQ(json.at("ply_file_path"), "points.ply");
  EXPECT_FALSE(json.contains("applied_transform"));
  const auto& frame = json.at("frames").at(1);
  EXPECT_EQ(frame.at("file_path"), "images/000002.jpg");
  EXPECT_NEAR(frame.at("timestamp").get<double>(), 1305031102.241970, 1e-6);
  // OpenGL: the third column points from the subject to the camera, the second up (ours is down).
  const geometry::Pose pose = orbit_pose(2, kSphere.center);
  for (int r = 0; r < 3; ++r) {
    const auto& row = frame.at("transform_matrix").at(static_cast<std::size_t>(r));
    EXPECT_NEAR(row.at(0).get<double>(), pose.matrix3()(r, 0), 1e-15);
    EXPECT_NEAR(row.at(1).get<double>(), -pose.matrix3()(r, 1), 1e-15);
    EXPECT_NEAR(row.at(2).get<double>(), -pose.matrix3()(r, 2), 1e-15);
    EXPECT_EQ(row.at(3).get<double>(), pose.translation[r]);
  }
}

TEST(Store, ThreadedWritesTheSameBytesAsInline) {
  const TemporaryFolder folder;
  {
    Store threaded(folder / "threaded", 90, Writing::Threaded);
    Store inline_store(folder / "inline", 90, Writing::Inline);
    act_out(threaded);
    act_out(inline_store);
    threaded.flush();
    inline_store.flush();
    EXPECT_EQ(files_in(folder / "threaded"), files_in(folder / "inline"));
  }
  EXPECT_EQ(files_in(folder / "threaded"), files_in(folder / "inline"));
}

TEST(Store, EndLeavesTheRestToItsThread) {
  const TemporaryFolder folder;
  std::promise<void> disk;
  const std::shared_future<void> ready = disk.get_future().share();
  const auto slow_disk = [ready](DurableFiles::Step, const fs::path& path) {
    if (path.filename() == "points.ply") ready.wait();
  };
  Store store(folder / "c", 90, Writing::Threaded, DurableFiles(slow_disk));
  act_out(store);
  store.end();
  EXPECT_FALSE(store.ended());
  disk.set_value();
  store.flush();
  EXPECT_TRUE(store.ended());
  EXPECT_EQ(load_capture(folder / "c").points.size(), 1U);
  EXPECT_FALSE(fs::exists(folder / "c/images/000001.jpg")) << "wiped";
}

TEST(Store, WipedPictureStaysUntilTheEnd) {
  const TemporaryFolder folder;
  {
    Store store(folder / "c", 90, Writing::Inline);
    act_out(store);
    EXPECT_TRUE(fs::exists(folder / "c/images/000001.jpg"));
  }
  EXPECT_FALSE(fs::exists(folder / "c/images/000001.jpg"));
  EXPECT_TRUE(fs::exists(folder / "c/images/000002.jpg"));
}

/// Bytes of pixels that all photos of a light field hold.
std::size_t bytes_held(const std::vector<Perspective>& perspectives) {
  std::size_t bytes = 0;
  for (const Perspective& perspective : perspectives) bytes += perspective.photo->bytes_held();
  return bytes;
}

TEST(Store, PicturesLeaveTheMemoryWhenTheyAreOnDisk) {
  for (const Writing writing : {Writing::Inline, Writing::Threaded}) {
    const TemporaryFolder folder;
    const Perspective taken = make_perspective(0, kSphere.center, small_camera());
    int steps = 0;
    const auto check = [&](DurableFiles::Step, const fs::path& path) {
      if (!path.filename().string().starts_with("000000")) return;
      ++steps;
      EXPECT_GT(taken.photo->bytes_held(), 0U) << "not all of it is done";
    };
    Store store(folder / "c", 90, writing, DurableFiles(check));
    store.add(taken);
    if (writing == Writing::Threaded) store.flush();
    EXPECT_GE(steps, 3) << "written, synced, renamed";
    EXPECT_EQ(taken.photo->bytes_held(), 0U);
    EXPECT_EQ(*taken.photo->rgb(), hal::read_image(folder / "c/images/000000.jpg"));
  }
}

TEST(Store, PicturesThatCannotBeStoredStayInMemory) {
  for (const Writing writing : {Writing::Inline, Writing::Threaded}) {
    const TemporaryFolder folder;
    std::vector<Perspective> taken;
    for (int i = 0; i < 3; ++i) {
      taken.push_back(make_perspective(i, kSphere.center, small_camera()));
    }
    const std::size_t each = taken[0].photo->bytes_held();
    Store store(folder / "c", 90, writing);
    fs::remove_all(folder / "c/images");
    for (const Perspective& perspective : taken) store.add(perspective);
    EXPECT_THAT(input_error([&] { store.flush(); }), HasSubstr("images/000000.jpg"));
    EXPECT_EQ(bytes_held(taken), 3 * each);
    for (const Perspective& perspective : taken) EXPECT_TRUE(perspective.photo->rgb());
  }
}

TEST(Store, UndoNeedsNoPixels) {
  const TemporaryFolder folder;
  const Perspective taken = make_perspective(0, kSphere.center, small_camera());
  {
    Store store(folder / "c", 90, Writing::Inline);
    store.add(taken);
    store.remove(0);
    store.flush();
    const std::string before = read_text(folder / "c/images/000000.jpg");
    store.restore(taken);
    EXPECT_EQ(read_text(folder / "c/images/000000.jpg"), before);
  }
  EXPECT_EQ(taken.photo->bytes_held(), 0U);
  EXPECT_EQ(*load_capture(folder / "c").light_field.perspectives().at(0).photo->rgb(),
            *taken.photo->rgb());
}

TEST(Store, ACaptureThatIsLoadedHoldsNoPixels) {
  const TemporaryFolder folder;
  save_capture(make_capture(3), folder / "c", 90);
  const Capture loaded = load_capture(folder / "c");
  EXPECT_EQ(bytes_held(loaded.light_field.perspectives()), 0U);
  Store store(loaded, 0, 90, Writing::Inline);
  store.remove(1);
  store.restore(loaded.light_field.perspectives()[1]);
  store.flush();
  EXPECT_EQ(bytes_held(loaded.light_field.perspectives()), 0U);
  const Capture imported = import_capture(folder / "c");
  EXPECT_EQ(bytes_held(imported.light_field.perspectives()), 0U);
  EXPECT_TRUE(imported.light_field.perspectives().at(2).photo->rgb());
}

TEST(Store, DifferentCamerasAreWrittenWithEachFrame) {
  const TemporaryFolder folder;
  Store store(folder / "c", 90, Writing::Inline);
  store.add(make_perspective(0, kSphere.center, small_camera()));
  store.add(make_perspective(1, kSphere.center, small_camera(0.25)));
  const auto json = nlohmann::json::parse(read_text(folder / "c" / "transforms.json"));
  // nerfstudio would use one found at the top for all.
  EXPECT_FALSE(json.contains("fl_x"));
  EXPECT_FALSE(json.contains("k1"));
  const Capture capture = load_capture(folder / "c");
  EXPECT_EQ(capture.light_field.perspectives()[0].camera->profile().k3, 0.0);
  EXPECT_EQ(capture.light_field.perspectives()[1].camera->profile().k3, 0.25);
}

TEST(Store, KeepsAFisheyeLens) {
  const TemporaryFolder folder;
  Store store(folder / "c", 90, Writing::Inline);
  store.add(make_perspective(0, kSphere.center, small_fisheye_camera()));
  const auto json = nlohmann::json::parse(read_text(folder / "c" / "transforms.json"));
  EXPECT_EQ(json.at("camera_model"), "OPENCV_FISHEYE");
  EXPECT_FALSE(json.contains("p1"));
  const Capture capture = load_capture(folder / "c");
  const config::CameraProfile& c = capture.light_field.perspectives()[0].camera->profile();
  EXPECT_EQ(c.model, config::LensModel::Fisheye);
  EXPECT_EQ(c.k1, 0.05);
  EXPECT_EQ(c.k2, -0.01);
  EXPECT_EQ(c.k3, 0.003);
  EXPECT_EQ(c.k4, -0.004);
}

// nerfstudio knows one camera_model for all.
TEST(Store, RefusesAFisheyeLensAmongOthers) {
  const TemporaryFolder folder;
  Store store(folder / "c", 90, Writing::Inline);
  store.add(make_perspective(0, kSphere.center, small_camera()));
  store.add(make_perspective(1, kSphere.center, small_fisheye_camera()));
  EXPECT_THAT(store.error().value_or(""), HasSubstr("1 of 2 pictures are of a fisheye lens"));
}

TEST(Store, RefusesAFolderThatHoldsSomething) {
  const TemporaryFolder folder;
  write_text(folder / "full/note.txt", "mine");
  write_text(folder / "file", "mine");
  const auto open = [&](const char* name) {
    return input_error([&] { Store(folder / name, 90, Writing::Inline); });
  };
  EXPECT_THAT(open("full"), HasSubstr("full: is not empty"));
  EXPECT_THAT(open("file"), HasSubstr("file: is a file"));
  EXPECT_THAT(open("file/below"), HasSubstr("file"));
  EXPECT_EQ(read_text(folder / "full/note.txt"), "mine");
  fs::create_directory(folder / "empty");
  EXPECT_EQ(open("empty"), "");
}

/// The picture of a perspective as another program may have left it.
std::string make_it_a_png(const fs::path& capture, int id) {
  std::string text = read_text(capture / "transforms.json");
  const std::string jpeg = picture_file(id);
  const std::string png = picture_file(id, ".png");
  text.replace(text.find(jpeg), jpeg.size(), png);
  write_text(capture / "transforms.json", text);
  hal::write_png(capture / png, hal::read_image(capture / jpeg));
  fs::remove(capture / jpeg);
  return png;
}

TEST(Store, UndoBringsBackTheOriginalPicture) {
  const TemporaryFolder folder;
  save_capture(make_capture(3), folder / "c", 90);
  const std::string png = make_it_a_png(folder / "c", 1);
  const auto before = files_in(folder / "c" / "images");
  const Capture capture = load_capture(folder / "c");
  {
    Store store(capture, 0, 90, Writing::Inline);
    store.remove(1);
    store.flush();
    EXPECT_EQ(load_capture(folder / "c").light_field.perspectives().size(), 2U);
    store.restore(capture.light_field.perspectives()[1]);
  }
  EXPECT_EQ(files_in(folder / "c" / "images"), before);
  EXPECT_EQ(load_capture(folder / "c").light_field.perspectives().at(1).file, png);
}

TEST(Store, FolderThatGoesAwayIsAnErrorNotACrash) {
  for (const Writing writing : {Writing::Inline, Writing::Threaded}) {
    const TemporaryFolder folder;
    Store store(folder / "c", 90, writing);
    fs::remove_all(folder / "c");
    store.add(make_perspective(0, kSphere.center, small_camera()));
    EXPECT_THAT(input_error([&] { store.flush(); }), HasSubstr("images/000000.jpg"));
    EXPECT_THAT(store.error().value_or(""), HasSubstr("No such file"));
  }
}

TEST(Store, PoseThatIsNotFiniteNeverReachesTheDisk) {
  const TemporaryFolder folder;
  Store store(folder / "c", 90, Writing::Inline);
  store.add(make_perspective(0, kSphere.center, small_camera()));
  geometry::Pose pose;
  pose.translation.x() = NAN;
  store.set_pose(0, pose);
  EXPECT_THAT(input_error([&] { store.flush(); }), HasSubstr("perspective 0 is not finite"));
  EXPECT_EQ(load_capture(folder / "c").light_field.perspectives().size(), 1U);
}

TEST(Store, WhatPerspectivesHangOnIsWrittenAsMovesAre) {
  const TemporaryFolder folder;
  const geometry::Pose there(geometry::exp_so3({0.1, 0.2, 0.3}), {4.0, 5.0, 6.0});
  Store store(folder / "c", 90, Writing::Inline);
  store.add(make_perspective(0, kSphere.center, small_camera()));
  store.hang(0, 7, there);
  store.hang(1, 8, there);  // there is none: nothing happens
  EXPECT_EQ(load_capture(folder / "c").light_field.perspectives()[0].keyframe, 0);
  store.flush();
  const auto perspective = load_capture(folder / "c").light_field.perspectives()[0];
  EXPECT_EQ(perspective.keyframe, 7);
  EXPECT_EQ(perspective.keyframe_from_camera.translation, there.translation);
}

TEST(Store, SphereAndThresholdComeBackAsTheyWere) {
  const TemporaryFolder folder;
  Sphere sphere = kSphere;
  sphere.keyframe = 3;
  sphere.center_in_keyframe = {0.1, 0.2, 1.0 / 3.0};
  {
    Store store(folder / "c", 90, Writing::Threaded);
    store.set_subject(sphere);
    store.set_threshold(0.07);
    store.add(make_perspective(0, kSphere.center, small_camera()));
  }
  const Capture capture = load_capture(folder / "c");
  EXPECT_EQ(capture.light_field.subject()->keyframe, 3);
  EXPECT_EQ(capture.light_field.subject()->center_in_keyframe, sphere.center_in_keyframe);
  EXPECT_NEAR(capture.threshold.value(), 0.07, 1e-15);
}

}  // namespace
}  // namespace lumibox::lightfield
