#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "hal/image_io.h"
#include "lightfield/fixtures.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kIdentity = R"([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";

/// A folder with pictures (16x12) and a transforms.json with one frame.
class OneFrame {
 public:
  explicit OneFrame(const std::string& picture = "images/a.jpg") {
    fs::create_directories((folder_ / picture).parent_path());
    const hal::Image image =
        *make_perspective(0, Eigen::Vector3d::Zero(), small_camera()).photo->rgb();
    if (picture.ends_with(".png")) {
      hal::write_png(folder_ / picture, image);
    } else {
      const auto bytes = hal::encode_jpeg(image, 90);
      write_text(folder_ / picture, std::string(bytes.begin(), bytes.end()));
    }
  }

  Capture import(const std::string& top, const std::string& frame,
                 const std::string& file_path = "images/a.jpg") {
    write_text(folder_ / "transforms.json", "{" + top + "\"frames\":[{" + frame +
                                                "\"file_path\":\"" + file_path +
                                                "\",\"transform_matrix\":" + kIdentity + "}]}");
    return import_capture(folder_ / "transforms.json");
  }
  config::CameraProfile lens(const std::string& top, const std::string& frame = "") {
    return import(top, frame).light_field.perspectives().at(0).camera->profile();
  }
  std::string error(const std::string& top, const std::string& frame = "",
                    const std::string& file_path = "images/a.jpg") {
    return input_error([&] { import(top, frame, file_path); });
  }

  TemporaryFolder folder_;
};

TEST(ImportTransforms, FieldOfViewAlone) {
  const config::CameraProfile c = OneFrame().lens("\"camera_angle_x\":1.0,\"aabb_scale\":4,");
  EXPECT_NEAR(c.fx, 8.0 / std::tan(0.5), 1e-12);
  EXPECT_EQ(c.fy, c.fx);
  EXPECT_EQ(c.cx, 7.5);  // the middle, in coordinates that begin at the first pixel's centre
  EXPECT_EQ(c.cy, 5.5);
  EXPECT_EQ(c.width, 16);
}

TEST(ImportTransforms, FocalLengthWinsOverFieldOfView) {
  const config::CameraProfile c =
      OneFrame().lens("\"camera_angle_x\":1.0,\"fl_x\":20,\"camera_angle_y\":0.5,");
  EXPECT_EQ(c.fx, 20.0);
  EXPECT_NEAR(c.fy, 6.0 / std::tan(0.25), 1e-12);
}

TEST(ImportTransforms, FramesOwnIntrinsicsWin) {
  const config::CameraProfile c =
      OneFrame().lens("\"fl_x\":20,\"cx\":9,\"k1\":0.5,\"w\":16.0,\"h\":12.0,",
                      "\"fl_x\":30,\"cx\":8.25,\"p2\":0.125,");
  EXPECT_EQ(c.fx, 30.0);
  EXPECT_EQ(c.cx, 7.75);
  EXPECT_EQ(c.k1, 0.5);
  EXPECT_EQ(c.p2, 0.125);
}

TEST(ImportTransforms, IdentityInOpenGlLooksDownMinusZ) {
  const Capture capture = OneFrame().import("\"fl_x\":20,", "\"timestamp\":1.5,");
  const Perspective& perspective = capture.light_field.perspectives().at(0);
  EXPECT_LT((perspective.world_from_camera * Eigen::Vector3d(1.0, 2.0, 3.0) -
             Eigen::Vector3d(1.0, -2.0, -3.0))
                .norm(),
            1e-15);
  EXPECT_EQ(perspective.timestamp_ns, 1'500'000'000);
  // One picture says nothing of the subject's distance, but it is before the camera.
  ASSERT_TRUE(capture.light_field.subject());
  EXPECT_LT(capture.light_field.subject()->center.z(), 0.0);
  EXPECT_GT(capture.light_field.subject()->radius, 0.0);
}

TEST(ImportTransforms, NameWithoutExtension) {
  EXPECT_EQ(OneFrame().import("\"fl_x\":20,", "", "./images/a").light_field.perspectives()[0].file,
            "./images/a.jpg");
  OneFrame png("images/b.png");
  const Capture capture = png.import("\"fl_x\":20,", "", "images/b");
  save_capture(capture, png.folder_ / "saved", 90);
  EXPECT_EQ(read_text(png.folder_ / "saved/images/000000.png"),
            read_text(png.folder_ / "images/b.png"));
  EXPECT_EQ(load_capture(png.folder_ / "saved").light_field.perspectives().size(), 1U);
}

TEST(ImportTransforms, RefusesWhatItCannotRepresent) {
  OneFrame source;
  EXPECT_THAT(source.error(""), HasSubstr("frames[0] has neither fl_x nor camera_angle_x"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"camera_model\":\"EQUIRECTANGULAR\","),
              HasSubstr("camera_model is EQUIRECTANGULAR, expected OPENCV"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"camera_model\":\"OPENCV\",\"is_fisheye\":true,"),
              HasSubstr("is_fisheye"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"k4\":0.1,"), HasSubstr("k4 is 0.1; expected 0"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"is_fisheye\":true,\"p1\":0.1,"),
              HasSubstr("p1 is 0.1; expected 0"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"w\":20,\"h\":12,"), HasSubstr("its camera says 20x12"));
  EXPECT_THAT(source.error("\"fl_x\":20,", "", "images/none"), HasSubstr("1 of 1 pictures"));
  EXPECT_THAT(source.error("\"fl_x\":20,", "", "../a.jpg"), HasSubstr("inside the folder"));
  EXPECT_THAT(source.error("\"fl_x\":\"20\","), HasSubstr("fl_x is string, expected a number"));
  EXPECT_THAT(source.error("\"w\":1.5,\"h\":12,\"fl_x\":1,"),
              HasSubstr("w is 1.5, expected an in"));
}

TEST(ImportTransforms, TakesFisheyeLensesOfBothDialects) {
  for (const char* says : {"\"camera_model\":\"OPENCV_FISHEYE\",", "\"is_fisheye\":true,"}) {
    const config::CameraProfile c =
        OneFrame().lens(std::string(says) + "\"fl_x\":9,\"k1\":0.1,\"k3\":0.3,\"k4\":0.4,");
    EXPECT_EQ(c.model, config::LensModel::Fisheye);
    EXPECT_EQ(c.k1, 0.1);
    EXPECT_EQ(c.k3, 0.3);
    EXPECT_EQ(c.k4, 0.4);
  }
}

TEST(ImportTransforms, RefusesIntrinsicsThatNoCameraHas) {
  OneFrame source;
  EXPECT_THAT(source.error("\"fl_x\":0,\"fl_y\":20,"),
              HasSubstr("frames[0] has a camera whose fx is 0; expected 0.16 to 1600"));
  EXPECT_THAT(source.error("\"fl_x\":1e-200,"), HasSubstr("fx is 1e-200; expected"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"k1\":1e300,"), HasSubstr("k1 is 1e+300; expected"));
  EXPECT_THAT(source.error("\"fl_x\":20,\"cx\":-99,"), HasSubstr("cx is -99; expected"));
  EXPECT_THAT(source.error("\"camera_angle_x\":0,"), HasSubstr("fx is inf; expected"));
  EXPECT_THAT(source.error("\"camera_angle_x\":4,"), HasSubstr("fx is -"));
}

TEST(ImportTransforms, RefusesPositionsThatNobodyCanComputeWith) {
  OneFrame source;
  const auto error = [&](const std::string& top, const std::string& x) {
    write_text(source.folder_ / "transforms.json",
               "{\"fl_x\":20," + top +
                   "\"frames\":[{\"file_path\":\"images/a.jpg\",\"transform_matrix\":[[1,0,0," + x +
                   "],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}");
    return input_error([&] { import_capture(source.folder_ / "transforms.json"); });
  };
  EXPECT_EQ(error("", "-1e9"), "");
  EXPECT_THAT(
      error("", "1e308"),
      HasSubstr("frames[0].transform_matrix has a coordinate of 1e+308; expected -1e+09 to"));
  const auto subject = [](const std::string& x, const std::string& radius) {
    return "\"lumibox\":{\"version\":1,\"subject\":{\"center\":[" + x +
           ",0,0],\"radius\":" + radius + "}},";
  };
  EXPECT_EQ(error(subject("1", "1"), "0"), "");
  EXPECT_THAT(error(subject("-2e9", "1"), "0"),
              HasSubstr("subject.center has a coordinate of -2e"));
  EXPECT_THAT(error(subject("1", "1e308"), "0"), HasSubstr("subject.radius is 1e+308, expected"));
  write_text(source.folder_ / "far.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
             "property float y\nproperty float z\nend_header\n1 2 3\n1 1e300 3\n");
  EXPECT_THAT(error("\"ply_file_path\":\"far.ply\",", "0"),
              HasSubstr("far.ply: vertex 1 has a coordinate of 1e+300; expected"));
}

TEST(ImportTransforms, RefusesTwoFramesOfOnePicture) {
  OneFrame source;
  const std::string matrix = std::string("\"transform_matrix\":") + kIdentity;
  for (const char* second : {"images/a.jpg", "./images/a.jpg", "images/a"}) {
    write_text(source.folder_ / "transforms.json",
               "{\"fl_x\":20,\"frames\":[{\"file_path\":\"images/a.jpg\"," + matrix +
                   "},{\"file_path\":\"" + second + "\"," + matrix + "}]}");
    EXPECT_THAT(input_error([&] { import_capture(source.folder_ / "transforms.json"); }),
                HasSubstr("frames[1].file_path names images/a.jpg, as does frames[0].file_path"));
  }
}

// A sparse file costs its author nothing, and the memory of whoever reads it.
TEST(ImportTransforms, RefusesAFileTooLargeToRead) {
  const TemporaryFolder folder;
  write_text(folder / "transforms.json", "{}");
  fs::resize_file(folder / "transforms.json", std::uintmax_t{1} << 40U);
  EXPECT_THAT(input_error([&] { import_capture(folder / "transforms.json"); }),
              HasSubstr("transforms.json: 1099511627776 bytes; expected at most 1073741824"));
}

TEST(ImportTransforms, WithoutFramesOrFile) {
  const TemporaryFolder folder;
  write_text(folder / "transforms.json", R"({"frames":[]})");
  EXPECT_THAT(input_error([&] { import_capture(folder / "transforms.json"); }),
              HasSubstr("holds no pictures"));
  EXPECT_THAT(input_error([&] { import_capture(folder / "none.json"); }), HasSubstr("none.json"));
}

TEST(ImportTransforms, PlyOfOthersIsRead) {
  OneFrame source;
  write_text(source.folder_ / "sparse.ply",
             "ply\nformat ascii 1.0\ncomment x\nelement vertex 2\nproperty float x\n"
             "property float y\nproperty float z\nproperty uchar red\nend_header\n"
             "1 2 3 255\n-4.5 5e-1 6 0\n");
  const Capture capture = source.import("\"fl_x\":20,\"ply_file_path\":\"sparse.ply\",", "");
  ASSERT_EQ(capture.points.size(), 2U);
  EXPECT_EQ(capture.points[1], Eigen::Vector3d(-4.5, 0.5, 6.0));
}

TEST(ImportTransforms, AsksForPointsOnlyWhereThereAreNone) {
  OneFrame source;
  std::size_t asked = 0;
  const PointFinder finder = [&](const std::vector<Perspective>& perspectives) {
    asked += perspectives.size();
    EXPECT_TRUE(perspectives.at(0).photo->rgb());
    return std::vector<Eigen::Vector3d>{{0.0, 0.0, -7.0}};
  };
  source.import("\"fl_x\":20,", "");
  Capture capture = import_capture(source.folder_ / "transforms.json", finder);
  EXPECT_EQ(asked, 1U);
  ASSERT_EQ(capture.points.size(), 1U);
  EXPECT_EQ(capture.light_field.subject()->center.z(), -7.0);  // the guess knows them
  write_text(source.folder_ / "sparse.ply",
             "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
             "property float z\nend_header\n1 2 3\n");
  source.import("\"fl_x\":20,\"ply_file_path\":\"sparse.ply\",", "");
  capture = import_capture(source.folder_ / "transforms.json", finder);
  EXPECT_EQ(asked, 1U);
  EXPECT_EQ(capture.points.at(0), Eigen::Vector3d(1.0, 2.0, 3.0));
}

/// Spoils a few bytes of a valid file.
std::string mutated(std::string bytes) {
  const int changes = *rc::gen::inRange(1, 4);
  for (int i = 0; i < changes && !bytes.empty(); ++i) {
    const auto place = *rc::gen::inRange<std::size_t>(0, bytes.size());
    const auto kind = *rc::gen::inRange(0, 4);
    if (kind == 0) {
      bytes.resize(place);
    } else if (kind == 1) {
      bytes.erase(place, *rc::gen::inRange<std::size_t>(1, 20));
    } else {
      bytes[place] = *rc::gen::arbitrary<char>();
    }
  }
  return bytes;
}

/// Exports a capture and, for each of its model files, imports mutations of it: InputError or
/// success, nothing else.
void check_mutations(ExportFormat format, const std::vector<std::string>& names) {
  static std::map<ExportFormat, std::unique_ptr<TemporaryFolder>> exported;
  auto& folder = exported[format];
  if (!folder) {
    folder = std::make_unique<TemporaryFolder>();
    export_capture(make_capture(3), format, *folder / "out");
  }
  for (const std::string& name : names) {
    const fs::path file = *folder / "out" / name;
    const std::string good = read_text(file);
    write_text(file, mutated(good));
    const std::string message = input_error([&] { import_capture(*folder / "out"); });
    write_text(file, good);
    RC_ASSERT(message.find('\n') == std::string::npos);
  }
}

RC_GTEST_PROP(ImportMutated, TransformsGiveAnErrorOrACapture, ()) {
  check_mutations(ExportFormat::Nerfstudio, {"transforms.json", "points.ply"});
}

RC_GTEST_PROP(ImportMutated, ColmapGivesAnErrorOrACapture, ()) {
  check_mutations(ExportFormat::Colmap, {"cameras.txt", "images.txt", "points3D.txt"});
}

}  // namespace
}  // namespace lumibox::lightfield
