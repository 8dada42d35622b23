#include "lightfield/capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hal/image_io.h"
#include "lightfield/fixtures.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

/// A saved capture whose transforms.json a test then spoils.
class BadCapture : public ::testing::Test {
 protected:
  BadCapture() { save_capture(make_capture(3), folder_ / "c", 90); }

  std::string load() const {
    return input_error([this] { load_capture(folder_ / "c"); });
  }
  std::string load_with(const std::function<void(json&)>& spoil) const {
    json document = json::parse(read_text(transforms_));
    spoil(document);
    write_text(transforms_, document.dump(1));
    return load();
  }

  TemporaryFolder folder_;
  fs::path transforms_ = folder_ / "c/transforms.json";
};

TEST_F(BadCapture, GoodOneLoads) {
  EXPECT_EQ(load(), "");
}

TEST_F(BadCapture, NoFolder) {
  EXPECT_THAT(input_error([&] { load_capture(folder_ / "none"); }), HasSubstr("none: is not a"));
}

TEST_F(BadCapture, NoTransforms) {
  fs::remove(transforms_);
  EXPECT_THAT(load(), HasSubstr("transforms.json: no such file"));
}

TEST_F(BadCapture, SyntaxErrorNamesItsLine) {
  write_text(transforms_, "{\n  \"frames\": [\n    {]\n");
  EXPECT_THAT(load(), HasSubstr("transforms.json:3: not valid JSON"));
}

TEST_F(BadCapture, NanIsNotJson) {
  write_text(transforms_, "{\n\"fl_x\": NaN}");
  EXPECT_THAT(load(), HasSubstr("transforms.json:2: not valid JSON"));
}

TEST_F(BadCapture, EmptyFileAndWrongRoot) {
  write_text(transforms_, "");
  EXPECT_THAT(load(), HasSubstr("not valid JSON"));
  write_text(transforms_, "[]");
  EXPECT_THAT(load(), HasSubstr("expected a capture"));
}

TEST_F(BadCapture, SomebodyElsesDataSet) {
  EXPECT_THAT(load_with([](json& j) { j.erase("lumibox"); }), HasSubstr("lumibox import"));
}

TEST_F(BadCapture, LaterVersion) {
  EXPECT_THAT(load_with([](json& j) { j["lumibox"]["version"] = 2; }),
              HasSubstr("lumibox.version is 2"));
}

TEST_F(BadCapture, WrongType) {
  EXPECT_THAT(load_with([](json& j) { j["frames"][1]["file_path"] = 5; }),
              HasSubstr("frames[1].file_path is number, expected text"));
}

TEST_F(BadCapture, MissingKey) {
  EXPECT_THAT(load_with([](json& j) { j["frames"][2].erase("transform_matrix"); }),
              HasSubstr("frames[2].transform_matrix is missing"));
}

TEST_F(BadCapture, MatrixThatIsNoRotation) {
  EXPECT_THAT(load_with([](json& j) { j["frames"][0]["transform_matrix"][0][0] = 7.0; }),
              HasSubstr("frames[0].transform_matrix is not a rotation"));
}

TEST_F(BadCapture, MirroredMatrix) {
  EXPECT_THAT(load_with([](json& j) {
                for (auto& row : j["frames"][0]["transform_matrix"]) {
                  row[0] = -row[0].get<double>();
                }
                j["frames"][0]["transform_matrix"][3][0] = 0.0;
              }),
              HasSubstr("frames[0].transform_matrix is not a rotation"));
}

TEST_F(BadCapture, MatrixOfWrongShape) {
  EXPECT_THAT(load_with([](json& j) { j["frames"][0]["transform_matrix"][1].erase(0); }),
              HasSubstr("transform_matrix[1] has 3 numbers, expected 4"));
}

TEST_F(BadCapture, NumberTooLarge) {
  std::string text = read_text(transforms_);
  text.replace(text.find("\"fl_x\": ") + 8, 1, "1e999");
  write_text(transforms_, text);
  EXPECT_THAT(load(), HasSubstr("transforms.json"));
  text.replace(text.find("1e999"), 5, std::string(100000, '9'));
  write_text(transforms_, text);
  EXPECT_LT(load().size(), 300U);
}

TEST_F(BadCapture, ZeroFocalLength) {
  EXPECT_THAT(load_with([](json& j) { j["fl_x"] = -1.0; }), HasSubstr("fx is -1; expected"));
}

TEST_F(BadCapture, MissingPicturesAreListed) {
  fs::remove(folder_ / "c/images/000000.jpg");
  fs::remove(folder_ / "c/images/000002.jpg");
  EXPECT_THAT(load(), HasSubstr("2 of 3 pictures are missing"));
  EXPECT_THAT(load(), HasSubstr("images/000000.jpg, images/000002.jpg"));
}

TEST_F(BadCapture, SizeThatContradictsThePicture) {
  EXPECT_THAT(load_with([](json& j) { j["w"] = 17; }),
              HasSubstr("images/000000.jpg: is 16x12, its camera says 17x12"));
}

TEST_F(BadCapture, DamagedPicture) {
  const fs::path picture = folder_ / "c/images/000001.jpg";
  write_text(picture, read_text(picture).substr(0, 300));
  EXPECT_THAT(load(), HasSubstr("000001.jpg"));
  write_text(picture, "not a picture");
  EXPECT_THAT(load(), HasSubstr("000001.jpg"));
}

TEST_F(BadCapture, PathThatLeavesTheFolder) {
  const fs::path outside = folder_ / "outside.jpg";
  fs::copy_file(folder_ / "c/images/000000.jpg", outside);
  for (const std::string& path : {std::string("../outside.jpg"), outside.string(),
                                  std::string("images/../../outside.jpg"), std::string()}) {
    EXPECT_THAT(load_with([&](json& j) { j["frames"][0]["file_path"] = path; }),
                HasSubstr("expected a path inside the folder"));
  }
  EXPECT_THAT(load_with([&](json& j) {
                j["frames"][0]["file_path"] = "images/000000.jpg";
                j["ply_file_path"] = "../points.ply";
              }),
              HasSubstr("ply_file_path"));
}

TEST_F(BadCapture, SameIdTwice) {
  EXPECT_THAT(load_with([](json& j) { j["frames"][1]["lumibox"]["id"] = 0; }),
              HasSubstr("frames[1] has the id of an earlier frame"));
}

TEST_F(BadCapture, SphereWithoutSize) {
  EXPECT_THAT(load_with([](json& j) { j["lumibox"]["subject"]["radius"] = 0; }),
              HasSubstr("lumibox.subject.radius is "));
}

TEST_F(BadCapture, DamagedPoints) {
  const fs::path points = folder_ / "c/points.ply";
  const std::string good = read_text(points);
  write_text(points, good.substr(0, good.size() - 1));
  EXPECT_THAT(load(), HasSubstr("points.ply: is truncated"));
  write_text(points, "junk");
  EXPECT_THAT(load(), HasSubstr("points.ply: is no PLY file"));
  write_text(points, "ply\nformat binary_big_endian 1.0\n");
  EXPECT_THAT(load(), HasSubstr("points.ply: not the header"));
  fs::remove(points);
  EXPECT_THAT(load(), HasSubstr("points.ply"));
}

TEST(SaveCapture, CopiesOriginalsByteForByte) {
  const TemporaryFolder folder;
  save_capture(make_capture(2), folder / "first", 50);
  save_capture(load_capture(folder / "first"), folder / "second", 95);
  for (const char* file : {"images/000000.jpg", "images/000001.jpg", "points.ply"}) {
    EXPECT_EQ(read_text(folder / "first" / file), read_text(folder / "second" / file));
  }
  const Capture first = load_capture(folder / "first");
  const Capture second = load_capture(folder / "second");
  EXPECT_LT(pose_difference(first.light_field, second.light_field), 1e-14);
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.points, make_capture(2).points);
}

TEST(SaveCapture, GapsInIdsStay) {
  const TemporaryFolder folder;
  Capture capture = make_capture(4);
  capture.light_field.wipe(1);
  save_capture(capture, folder / "c", 90);
  const Capture loaded = load_capture(folder / "c");
  ASSERT_EQ(loaded.light_field.perspectives().size(), 3U);
  EXPECT_EQ(loaded.light_field.perspectives()[1].id, 2);
}

TEST(ExportCapture, NerfstudioHasNoKeysOfOurs) {
  const TemporaryFolder folder;
  export_capture(make_capture(2), ExportFormat::Nerfstudio, folder / "out");
  EXPECT_THAT(read_text(folder / "out/transforms.json"), ::testing::Not(HasSubstr("lumibox")));
  EXPECT_TRUE(fs::exists(folder / "out/points.ply"));
}

TEST(ExportCapture, RoundTripKeepsPosesAndLenses) {
  const Capture capture = make_capture(6);
  for (const ExportFormat format : {ExportFormat::Nerfstudio, ExportFormat::Colmap}) {
    const TemporaryFolder folder;
    export_capture(capture, format, folder / "out");
    const Capture back = import_capture(folder / "out");
    EXPECT_LT(pose_difference(capture.light_field, back.light_field), 1e-12);
    EXPECT_EQ(capture.points, back.points);
    const auto& before = capture.light_field.perspectives()[3].camera->profile();
    const auto& after = back.light_field.perspectives()[3].camera->profile();
    EXPECT_NEAR(before.cx, after.cx, 1e-14);
    EXPECT_NEAR(before.cy, after.cy, 1e-14);
    EXPECT_EQ(before.fx, after.fx);
    EXPECT_EQ(before.k2, after.k2);
    EXPECT_EQ(before.p1, after.p1);
  }
}

TEST(ExportCapture, RoundTripKeepsAFisheyeLens) {
  Capture capture;
  capture.light_field.add(make_perspective(0, Eigen::Vector3d::Zero(), small_fisheye_camera()));
  const config::CameraProfile before = small_fisheye_camera()->profile();
  for (const ExportFormat format : {ExportFormat::Nerfstudio, ExportFormat::Colmap}) {
    const TemporaryFolder folder;
    export_capture(capture, format, folder / "out");
    const Capture back = import_capture(folder / "out");
    const config::CameraProfile& after = back.light_field.perspectives()[0].camera->profile();
    EXPECT_EQ(after.model, config::LensModel::Fisheye);
    EXPECT_EQ(after.k2, before.k2);
    EXPECT_EQ(after.k3, before.k3);
    EXPECT_EQ(after.k4, before.k4);
  }
}

TEST(ExportCapture, RefusesAFolderThatHoldsSomething) {
  const TemporaryFolder folder;
  write_text(folder / "out/mine", "");
  for (const ExportFormat format : {ExportFormat::Nerfstudio, ExportFormat::Colmap}) {
    EXPECT_THAT(input_error([&] { export_capture(make_capture(1), format, folder / "out"); }),
                HasSubstr("is not empty"));
  }
}

}  // namespace
}  // namespace lumibox::lightfield
