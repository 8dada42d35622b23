#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "hal/image_io.h"
#include "lightfield/fixtures.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

void write_picture(const fs::path& path) {
  const auto bytes = hal::encode_jpeg(
      *make_perspective(0, Eigen::Vector3d::Zero(), small_camera()).photo->rgb(), 90);
  write_text(path, std::string(bytes.begin(), bytes.end()));
}

/// Two images, one of them without 2D points, as COLMAP writes them: not in order of name.
void write_text_model(const fs::path& folder,
                      const std::string& camera = "PINHOLE 16 12 20 21 8 6") {
  write_text(folder / "cameras.txt", "# comment\n7 " + camera + "\n");
  write_text(folder / "images.txt",
             "# comment\n"
             "2 1 0 0 0 0 0 5 7 b picture.jpg\n"
             "1.5 2.5 9 3.5 4.5 -1\n"
             "1 0.7071067811865476 0 0.7071067811865475 0 1 2 3 7 a.jpg\n"
             "\n");
  write_text(folder / "points3D.txt", "9 1 2 3 255 0 0 0.5 2 0\n");
}

template <typename T>
void put(std::string* bytes, T value) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// The same model in COLMAP's binary layout.
void write_binary_model(const fs::path& folder, std::int32_t camera_model = 1) {
  std::string cameras;
  put<std::uint64_t>(&cameras, 1);
  put<std::int32_t>(&cameras, 7);
  put<std::int32_t>(&cameras, camera_model);
  put<std::uint64_t>(&cameras, 16);
  put<std::uint64_t>(&cameras, 12);
  for (const double parameter : {20.0, 21.0, 8.0, 6.0}) put(&cameras, parameter);
  write_text(folder / "cameras.bin", cameras);

  std::string images;
  put<std::uint64_t>(&images, 2);
  put<std::uint32_t>(&images, 2);
  for (const double number : {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0}) put(&images, number);
  put<std::int32_t>(&images, 7);
  images += std::string("b picture.jpg") + '\0';
  put<std::uint64_t>(&images, 1);
  put(&images, 1.5);
  put(&images, 2.5);
  put<std::int64_t>(&images, 9);
  put<std::uint32_t>(&images, 1);
  for (const double number : {0.7071067811865476, 0.0, 0.7071067811865475, 0.0, 1.0, 2.0, 3.0}) {
    put(&images, number);
  }
  put<std::int32_t>(&images, 7);
  images += std::string("a.jpg") + '\0';
  put<std::uint64_t>(&images, 0);
  write_text(folder / "images.bin", images);

  std::string points;
  put<std::uint64_t>(&points, 1);
  put<std::uint64_t>(&points, 9);
  for (const double number : {1.0, 2.0, 3.0}) put(&points, number);
  points += "\xff";
  points += std::string(2, '\0');
  put(&points, 0.5);
  put<std::uint64_t>(&points, 1);
  put<std::int32_t>(&points, 2);
  put<std::int32_t>(&points, 0);
  write_text(folder / "points3D.bin", points);
}

void write_pictures(const fs::path& folder) {
  write_picture(folder / "a.jpg");
  write_picture(folder / "b picture.jpg");
}

void expect_model(const Capture& capture) {
  const auto& perspectives = capture.light_field.perspectives();
  ASSERT_EQ(perspectives.size(), 2U);
  EXPECT_EQ(perspectives[0].file, "a.jpg");
  EXPECT_EQ(perspectives[1].file, "b picture.jpg");
  // camera_from_world turns by 90 degrees about y: x' = z, z' = -x, then adds (1, 2, 3).
  const Eigen::Vector3d in_camera =
      perspectives[0].world_from_camera.inverse() * Eigen::Vector3d(10.0, 20.0, 30.0);
  EXPECT_LT((in_camera - Eigen::Vector3d(31.0, 22.0, -7.0)).norm(), 1e-12);
  EXPECT_EQ(perspectives[1].center(), Eigen::Vector3d(0.0, 0.0, -5.0));
  EXPECT_EQ(perspectives[0].camera->profile().fy, 21.0);
  EXPECT_EQ(perspectives[0].camera->profile().cx, 7.5);
  EXPECT_EQ(perspectives[0].camera, perspectives[1].camera);
  ASSERT_EQ(capture.points.size(), 1U);
  EXPECT_EQ(capture.points[0], Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(ImportColmap, TextAndBinaryInEveryUsualPlace) {
  struct Places {
    const char* model;
    const char* pictures;
    const char* source;
  };
  for (const Places& places : {Places{"", "", ""},
                               {"", "images", ""},
                               {"sparse/0", "images", ""},
                               {"sparse", "images", ""},
                               {"sparse/0", "images", "sparse/0"}}) {
    for (const bool binary : {false, true}) {
      const TemporaryFolder folder;
      write_pictures(folder / "p" / places.pictures);
      const fs::path model = folder / "p" / places.model;
      binary ? write_binary_model(model) : write_text_model(model);
      SCOPED_TRACE(std::string(places.model) + (binary ? " binary" : " text"));
      expect_model(import_capture(folder / "p" / places.source));
    }
  }
}

TEST(ImportColmap, CameraModels) {
  const auto lens = [](const std::string& camera) {
    const TemporaryFolder folder;
    write_pictures(folder / "p");
    write_text_model(folder / "p", camera);
    return import_capture(folder / "p").light_field.perspectives()[0].camera->profile();
  };
  EXPECT_EQ(lens("SIMPLE_PINHOLE 16 12 20 8 6").fy, 20.0);
  EXPECT_EQ(lens("SIMPLE_RADIAL 16 12 20 8 6 0.1").k1, 0.1);
  EXPECT_EQ(lens("RADIAL 16 12 20 8 6 0.1 0.2").k2, 0.2);
  EXPECT_EQ(lens("RADIAL 16 12 20 8 6 0.1 0.2").cy, 5.5);
  EXPECT_EQ(lens("OPENCV 16 12 20 21 8 6 0.1 0.2 0.3 0.4").p2, 0.4);
  EXPECT_EQ(lens("FULL_OPENCV 16 12 20 21 8 6 0.1 0.2 0.3 0.4 0.5 0 0 0").k3, 0.5);
  const config::CameraProfile fisheye = lens("OPENCV_FISHEYE 16 12 20 21 8 6 0.1 0.2 0.3 0.4");
  EXPECT_EQ(fisheye.model, config::LensModel::Fisheye);
  EXPECT_EQ(fisheye.k2, 0.2);
  EXPECT_EQ(fisheye.k3, 0.3);
  EXPECT_EQ(fisheye.k4, 0.4);
}

TEST(ImportColmap, RefusesWithFileLineAndReason) {
  const auto error = [](const std::string& camera) {
    const TemporaryFolder folder;
    write_pictures(folder / "p");
    write_text_model(folder / "p", camera);
    return input_error([&] { import_capture(folder / "p"); });
  };
  EXPECT_THAT(error("RADIAL_FISHEYE 16 12 20 8 6 0 0"),
              HasSubstr("cameras.txt:2: camera model RADIAL_FISHEYE, expected SIMPLE_PINHOLE"));
  EXPECT_THAT(error("FULL_OPENCV 16 12 20 21 8 6 0 0 0 0 0 0 0 1"), HasSubstr("k4, k5 or k6"));
  EXPECT_THAT(error("PINHOLE 16 12 20 21 8"), HasSubstr("3 parameters, PINHOLE has 4"));
  EXPECT_THAT(error("PINHOLE 16 12 20 21 8 x"), HasSubstr("not a number: x"));
  EXPECT_THAT(error("PINHOLE 16 12 20 nan 8 6"), HasSubstr("not a number: nan"));
  EXPECT_THAT(error("PINHOLE 16 12 0 21 8 6"),
              HasSubstr("cameras.txt:2: fx is 0; expected 0.16 to 1600"));
  EXPECT_THAT(error("PINHOLE 16 12 1e-200 21 8 6"), HasSubstr("fx is 1e-200; expected"));
  EXPECT_THAT(error("OPENCV 16 12 20 21 8 6 1e300 0 0 0"), HasSubstr("k1 is 1e+300; expected"));
  EXPECT_THAT(error("PINHOLE 16 99999999999 1 1 8 6"), HasSubstr("height is"));
  EXPECT_THAT(error("PINHOLE 17 12 20 21 8 6"), HasSubstr("its camera says 17x12"));
}

TEST(ImportColmap, RefusesBadImages) {
  const auto error = [](const std::string& images) {
    const TemporaryFolder folder;
    write_pictures(folder / "p");
    write_text_model(folder / "p");
    write_text(folder / "p/images.txt", images);
    return input_error([&] { import_capture(folder / "p"); });
  };
  EXPECT_THAT(error("1 1 0 0 0 0 0 5 8 a.jpg\n"), HasSubstr("camera 8, which is not in the model"));
  EXPECT_THAT(error("1 1 1 0 0 0 0 5 7 a.jpg\n"), HasSubstr("images.txt:1: the image has a rot"));
  EXPECT_THAT(error("1 1 0 0 0 0 0 5 7\n"), HasSubstr("images.txt:1: expected IMAGE_ID"));
  EXPECT_THAT(error("1 1 0 0 0 0 0 5 7 none.jpg\n"), HasSubstr("1 of 1 pictures are missing"));
  EXPECT_THAT(error("1 1 0 0 0 0 0 5 7 ../a.jpg\n"), HasSubstr("inside the folder"));
  EXPECT_THAT(error("1 1 0 0 0 0 0 1e308 7 a.jpg\n"),
              HasSubstr("images.txt:1: the image has a coordinate of 1e+308; expected -1e+09 to"));
  EXPECT_THAT(error("one 1 0 0 0 0 0 5 7 a.jpg\n"), HasSubstr("images.txt:1: not a number: one"));
  EXPECT_THAT(error("1 1 0 0 0 0 0 5 7 a.jpg\n\n2 1 0 0 0 0 0 6 7 ./a.jpg\n"),
              HasSubstr("images.txt: images \"./a.jpg\" and \"a.jpg\" are one picture"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("holds no pictures"));
}

TEST(ImportColmap, RefusesAPointOutOfReach) {
  const TemporaryFolder folder;
  write_pictures(folder / "p");
  write_text_model(folder / "p");
  write_text(folder / "p/points3D.txt", "9 1 2 3 255 0 0 0.5 2 0\n8 1 -1e300 3 255 0 0 0.5 2 0\n");
  EXPECT_THAT(input_error([&] { import_capture(folder / "p"); }),
              HasSubstr("points3D.txt:2: a coordinate of -1e+300; expected"));
}

TEST(ImportColmap, NoModel) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "p");
  EXPECT_THAT(input_error([&] { import_capture(folder / "p"); }),
              HasSubstr("neither a transforms"));
}

TEST(ImportColmap, UnknownBinaryModelIsNamed) {
  const TemporaryFolder folder;
  write_pictures(folder / "p");
  write_binary_model(folder / "p", 9);
  EXPECT_THAT(input_error([&] { import_capture(folder / "p"); }), HasSubstr("RADIAL_FISHEYE"));
}

RC_GTEST_PROP(ImportColmapMutated, BinaryGivesAnErrorOrACapture, ()) {
  const TemporaryFolder folder;
  write_pictures(folder / "p");
  write_binary_model(folder / "p");
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const std::string good = read_text(folder / "p" / name);
    std::string bad = good;
    const auto place = *rc::gen::inRange<std::size_t>(0, bad.size());
    if (*rc::gen::arbitrary<bool>()) {
      bad[place] = *rc::gen::arbitrary<char>();
    } else {
      bad.resize(place);
    }
    write_text(folder / "p" / name, bad);
    const std::string message = input_error([&] { import_capture(folder / "p"); });
    RC_ASSERT(message.find('\n') == std::string::npos);
    if (bad.size() < good.size()) RC_ASSERT(!message.empty());
    write_text(folder / "p" / name, good);
  }
}

}  // namespace
}  // namespace lumibox::lightfield
