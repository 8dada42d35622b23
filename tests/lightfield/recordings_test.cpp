#include <gtest/gtest.h>

#include "lightfield/fixtures.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

/// Real recordings that are not part of the source tree.
class Recording : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    source_ = fs::path(LUMIBOX_SOURCE_DIR) / "../shared/data" / GetParam() / "transforms.json";
    if (!fs::exists(source_)) GTEST_SKIP() << source_ << " is not here";
  }
  fs::path source_;
};

INSTANTIATE_TEST_SUITE_P(Shared, Recording, ::testing::Values("fox", "box"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_P(Recording, SubjectIsBeforeTheCamerasAndInTheirPictures) {
  const Capture capture = import_capture(source_);
  const auto& perspectives = capture.light_field.perspectives();
  ASSERT_GT(perspectives.size(), 50U);
  const Sphere subject = capture.light_field.subject().value();
  int seen = 0;
  for (const Perspective& perspective : perspectives) {
    const auto pixel =
        perspective.camera->project(perspective.world_from_camera.inverse() * subject.center);
    if (pixel && perspective.camera->contains(*pixel)) ++seen;
  }
  EXPECT_GT(seen, static_cast<int>(0.9 * static_cast<double>(perspectives.size())));
}

TEST_P(Recording, SurvivesSavingAndEveryExport) {
  const Capture capture = import_capture(source_);
  const TemporaryFolder folder;
  save_capture(capture, folder / "saved", 90);
  const Capture saved = load_capture(folder / "saved");
  EXPECT_LT(pose_difference(capture.light_field, saved.light_field), 1e-12);
  const auto& first = capture.light_field.perspectives().front();
  EXPECT_EQ(read_text(capture.folder / first.file), read_text(folder / "saved/images/000000.jpg"));
  for (const ExportFormat format : {ExportFormat::Nerfstudio, ExportFormat::Colmap}) {
    const TemporaryFolder exported;
    export_capture(saved, format, exported / "out");
    const Capture back = import_capture(exported / "out");
    EXPECT_LT(pose_difference(capture.light_field, back.light_field), 1e-12);
    EXPECT_LT((capture.light_field.subject()->center - back.light_field.subject()->center).norm(),
              1e-9);
  }
}

}  // namespace
}  // namespace lumibox::lightfield
