#include "lightfield/map_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "hal/image_io.h"
#include "lightfield/fixtures.h"
#include "lightfield/map_fixtures.h"
#include "tracking/map.h"

namespace lumibox::lightfield {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kLevels = 2;

void save(const tracking::MapView& map, const std::filesystem::path& capture) {
  MapWriter(capture, 0).write(map, *small_camera(), {});
}

TEST(MapFiles, WhatIsReadIsWhatWasWrittenToTheBit) {
  const TemporaryFolder folder;
  const tracking::MapView map = make_map(4);
  save(map, folder / "c");
  EXPECT_EQ(difference(read_map(folder / "c", *small_camera(), kLevels), map), "");
}

TEST(MapFiles, AMapMadeOfItGoesOnAsTheOneItWasCopiedFrom) {
  const TemporaryFolder folder;
  save(make_map(4), folder / "c");
  tracking::Map restored(read_map(folder / "c", *small_camera(), kLevels));
  tracking::Map map(make_map(4));
  EXPECT_EQ(difference(restored.view(1), make_map(4)), "");
  EXPECT_EQ(restored.add_point({}), map.add_point({})) << "ids are never used again";
  for (std::size_t i = 0; i < map.keyframes().size(); ++i) {
    EXPECT_EQ(restored.keyframes()[i].points, map.keyframes()[i].points);
  }
}

TEST(MapFiles, PicturesAreWrittenOnce) {
  const TemporaryFolder folder;
  std::vector<std::string> written;
  const DurableFiles files([&](DurableFiles::Step step, const std::filesystem::path& path) {
    if (step == DurableFiles::Step::Renamed) written.push_back(path.filename());
  });
  MapWriter writer(folder / "c", 0);
  writer.write(make_map(2), *small_camera(), files);
  writer.write(make_map(3), *small_camera(), files);
  const std::vector<std::string> expected = {"000000.png", "000001.png", "map.json", "000002.png",
                                             "map.json"};
  EXPECT_EQ(written, expected);
}

TEST(MapFiles, PicturesOfCulledKeyframesGo) {
  const TemporaryFolder folder;
  MapWriter writer(folder / "c", 0);
  writer.write(make_map(3), *small_camera(), {});
  EXPECT_TRUE(std::filesystem::exists(folder / "c" / "map/000002.png"));
  writer.write(make_map(4), *small_camera(), {});  // which has culled it
  EXPECT_FALSE(std::filesystem::exists(folder / "c" / "map/000002.png"));
  EXPECT_EQ(read_map(folder / "c", *small_camera(), kLevels).keyframes.size(), 4U);
}

// The picture of a keyframe that map.json did not come to name is of another picture than the one
// that now has its number.
TEST(MapFiles, APictureThatTheMapDidNotNameIsWrittenAgain) {
  const TemporaryFolder folder;
  save(make_map(4), folder / "c");
  MapWriter writer(folder / "c", 3);
  const tracking::MapView other = make_map(4, /*seed=*/7);
  writer.write(other, *small_camera(), {});
  const auto read = read_map(folder / "c", *small_camera(), kLevels);
  EXPECT_EQ(read.keyframes[3].pyramid->level(0), other.keyframes[3].pyramid->level(0));
  EXPECT_NE(read.keyframes[1].pyramid->level(0), other.keyframes[1].pyramid->level(0));
}

TEST(MapFiles, AMapThatIsNotFiniteLeavesTheOldOne) {
  const TemporaryFolder folder;
  save(make_map(3), folder / "c");
  tracking::MapView bad = make_map(3);
  bad.keyframes[1].world_from_camera.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(input_error([&] { save(bad, folder / "c"); }), HasSubstr("keyframe 1 is not finite"));
  EXPECT_EQ(difference(read_map(folder / "c", *small_camera(), kLevels), make_map(3)), "");
}

TEST(MapFiles, AMapThatWouldNotBeReadIsNotWritten) {
  const TemporaryFolder folder;
  tracking::MapView scaled = make_map(3);
  scaled.keyframes[2].scale = 1e9;
  EXPECT_THAT(input_error([&] { save(scaled, folder / "c"); }), HasSubstr("keyframe 2 is not"));
  tracking::MapView fast = make_map(3);
  fast.keyframes[0].readout_twist[4] = 7.0;
  EXPECT_THAT(input_error([&] { save(fast, folder / "c"); }), HasSubstr("keyframe 0 is not"));
  tracking::MapView empty = make_map(3);
  empty.points.clear();
  EXPECT_THAT(input_error([&] { save(empty, folder / "c"); }), HasSubstr("has no points"));
  EXPECT_FALSE(std::filesystem::exists(folder / "c"));
}

TEST(MapFiles, APointWithoutAPlaceIsLeftOut) {
  const TemporaryFolder folder;
  tracking::MapView map = make_map(3);
  map.points[5].position.y() = std::numeric_limits<double>::infinity();
  save(map, folder / "c");
  const auto read = read_map(folder / "c", *small_camera(), kLevels);
  EXPECT_EQ(read.points.size(), map.points.size() - 1);
}

/// What replaces the first `found` in map.json, and words of the complaint.
struct Damage {
  const char* name;
  const char* found;
  const char* replacement;
  const char* words;
};

class DamagedMap : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedMap, IsRefusedWithTheFileAndThePlaceInIt) {
  const TemporaryFolder folder;
  save(make_map(3), folder / "c");
  const auto file = folder / "c" / "map/map.json";
  std::string text = read_text(file);
  const std::size_t at = text.find(GetParam().found);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().found).size(), GetParam().replacement);
  write_text(file, text);
  EXPECT_THAT(input_error([&] { read_map(folder / "c", *small_camera(), kLevels); }),
              AllOf(HasSubstr(file.string()), HasSubstr(GetParam().words)));
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedMap,
    ::testing::Values(
        Damage{"Version", "\"version\": 1", "\"version\": 2",
               "version is 2, expected an integer from 1 to 1"},
        Damage{"NoVersion", "\"version\"", "\"verse\"", "version is missing"},
        Damage{"Lens", "\"fx\":20.1", "\"fx\":20.2", "camera.fx is 20.2, but the camera's is 20.1"},
        Damage{"Distortion", "[0.05,", "[0.06,",
               "camera.distortion[0] is 0.06, but the camera's is 0.05"},
        Damage{"Model", "\"opencv\"", "\"fisheye\"",
               "camera.model is fisheye, but the camera's is opencv"},
        Damage{"Readout", "\"readout_s\":0.0", "\"readout_s\":0.02", "camera.readout_s is 0.02"},
        Damage{"Size", "\"width\":16", "\"width\":32",
               "camera.width is 32, but the camera's is 16"},
        Damage{"NotANumber", "\"median_depth\":", "\"median_depth\":null,\"x\":",
               "keyframes[0].median_depth is null"},
        Damage{"Infinite", "\"position\":[", "\"position\":[1e999,", "1e999"},
        Damage{"NoScale", "\"scale\":1.0", "\"scale\":0.0",
               "keyframes[0].world_from_this.scale is 0, expected 0.001"},
        Damage{"TiedToNothing", "{\"world_from_this\":", "{\"tied_to\":3,\"tied_from_this\":",
               "keyframes[0].tied_to is 3, expected an integer from 0 to 2"},
        Damage{"TiedToItself", "{\"world_from_this\":", "{\"tied_to\":0,\"tied_from_this\":",
               "keyframes[0].tied_to is itself tied"},
        Damage{"SeenInATiedOne", "{\"world_from_this\":", "{\"tied_to\":1,\"tied_from_this\":",
               "points[0].sightings[0] is in a keyframe that is tied"},
        Damage{"NotARotation", "\"rotation_wxyz\":[", "\"rotation_wxyz\":[3,0,0,0],\"x\":[",
               "keyframes[0].world_from_this.rotation_wxyz is not a unit quaternion"},
        Damage{"FarAway", "\"translation\":[", "\"translation\":[2e9,0,0],\"x\":[",
               "keyframes[0].world_from_this.translation has"},
        Damage{"KeyframeThatIsNot", "\"sightings\":[[0,", "\"sightings\":[[3,",
               "points[0].sightings[0][0] is 3, expected an integer from 0 to 2"},
        Damage{"NegativeKeyframe", "\"sightings\":[[0,", "\"sightings\":[[-1,",
               "points[0].sightings[0][0] is -1"},
        Damage{"SameKeyframeTwice", "\"sightings\":[[0,", "\"sightings\":[[1,",
               "is the second in its keyframe"},
        Damage{"NoSightings", "\"sightings\":[[0,", "\"sightings\":[],\"x\":[[0,",
               "points[0].sightings is empty"},
        Damage{"OutsideThePicture", "\"sightings\":[[0,", "\"sightings\":[[0,-90.5,1.0,0],[0,",
               "points[0].sightings[0] lies outside the picture"},
        Damage{"LevelThatIsNot", "\"sightings\":[[0,", "\"sightings\":[[0,1.0,1.0,2],[0,",
               "points[0].sightings[0][3] is 2, expected an integer from 0 to 1"},
        Damage{"PointBeyondTheNext", "\"next_point\": ", "\"next_point\": 1, \"x\": ",
               "next_point is 1, but there is a point of id 34; expected more than every id"},
        Damage{"NoNextPoint", "\"next_point\": ", "\"next_point\": 0, \"x\": ",
               "next_point is 0, but there is a point of id 34"},
        Damage{"NoPoints", "\"points\": [", "\"points\": [], \"x\": [", "points is empty"},
        Damage{"HugeScale", "\"scale\":1.0", "\"scale\":1e9",
               "keyframes[0].world_from_this.scale is 1e+09, expected 0.001 to 1000"},
        Damage{"FastReadout", "\"readout_twist\":[", "\"readout_twist\":[1e300,0,0,0,0,0],\"x\":[",
               "keyframes[0].readout_twist is a motion of 1e+300"},
        Damage{"ReadoutOfMoreThanATurn", "\"readout_twist\":[",
               "\"readout_twist\":[0,0,0,0,7,0],\"x\":[",
               "keyframes[0].readout_twist is a motion of 0 and a turn of 7 rad"},
        Damage{"SamePointTwice", "\"id\":1,", "\"id\":0,",
               "points[1].id is 0, expected an integer from 1"},
        Damage{"FoundMoreThanSearched", "\"searched\":1,", "\"searched\":0,",
               "points[1].found is 1, expected an integer from 0 to 0"},
        Damage{"NoKeyframes", "\"keyframes\": [", "\"keyframes\": [], \"x\": [",
               "keyframes has none with a picture"}),
    [](const auto& damage) { return damage.param.name; });

TEST(DamagedMapFiles, AMapThatIsCutAnywhereIsRefused) {
  const TemporaryFolder folder;
  save(make_map(2), folder / "c");
  const auto file = folder / "c" / "map/map.json";
  const std::string whole = read_text(file);
  for (std::size_t size = 0; size + 2 < whole.size(); size += 97) {
    write_text(file, whole.substr(0, size));
    EXPECT_THAT(input_error([&] { read_map(folder / "c", *small_camera(), kLevels); }),
                HasSubstr(file.string()))
        << size;
  }
}

TEST(DamagedMapFiles, MissingFilesAreNamed) {
  const TemporaryFolder folder;
  const auto complaint = [&] {
    return input_error([&] { read_map(folder / "c", *small_camera(), kLevels); });
  };
  EXPECT_THAT(complaint(), HasSubstr((folder / "c" / "map/map.json").string()));
  save(make_map(2), folder / "c");
  std::filesystem::remove(folder / "c" / "map/000001.png");
  EXPECT_THAT(complaint(), HasSubstr((folder / "c" / "map/000001.png").string()));
}

TEST(DamagedMapFiles, PicturesOfAnotherKindOrDamagedAreNamed) {
  const TemporaryFolder folder;
  save(make_map(2), folder / "c");
  const auto picture = folder / "c" / "map/000001.png";
  const auto complaint = [&] {
    return input_error([&] { read_map(folder / "c", *small_camera(), kLevels); });
  };
  const std::string whole = read_text(picture);
  write_text(picture, whole.substr(0, whole.size() / 2));
  EXPECT_THAT(complaint(), HasSubstr(picture.string()));
  hal::write_png(picture, hal::Image(16, 10, 1));
  EXPECT_THAT(complaint(), AllOf(HasSubstr(picture.string()),
                                 HasSubstr("16x10 pixels in 1 channels; expected 16x12 in 1")));
  hal::write_png(picture, hal::Image(16, 12, 3));
  EXPECT_THAT(complaint(), HasSubstr("in 3 channels"));
}

/// Bytes changed at random: read or refused, never anything else.
TEST(DamagedMapFiles, NoChangedByteCrashes) {
  const TemporaryFolder folder;
  save(make_map(2), folder / "c");
  const auto file = folder / "c" / "map/map.json";
  const std::string whole = read_text(file);
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string text = whole;
    text[random() % text.size()] = static_cast<char>(random() % 256U);
    write_text(file, text);
    refused +=
        input_error([&] { read_map(folder / "c", *small_camera(), kLevels); }).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace lumibox::lightfield
