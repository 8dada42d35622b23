#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hal/sim_scenes.h"
#include "support/input_error.h"

// Every mistake in a scene file is answered with file, line, key and what is allowed.
namespace lumibox::hal {
namespace {

using lumibox::testing::message_of;
using ::testing::HasSubstr;

struct Mistake {
  std::string name;
  std::string find;  ///< in the good scene; replaced by `instead`
  std::string instead;
  std::string complaint;  ///< part of the message
};

class BadScene : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadScene, IsRefusedWithItsLineAndKey) {
  const Mistake& mistake = GetParam();
  std::string text = testing::wall_scene();
  const std::size_t at = text.find(mistake.find);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, mistake.find.size(), mistake.instead);
  const std::string message = message_of([&] { testing::scene_of(text); });
  EXPECT_THAT(message, ::testing::ContainsRegex("scene.toml:[0-9]+: "));
  EXPECT_THAT(message, HasSubstr(mistake.complaint));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    SimSceneFile, BadScene,
    ::testing::Values(
        Mistake{"UnknownKey", "segments = 4", "segmens = 4", "unknown key; allowed: "},
        Mistake{"NotToml", "duration_s = 1.0", "duration_s 1.0", ":"},
        Mistake{"WrongType", "duration_s = 1.0", "duration_s = \"long\"", "expected a number"},
        Mistake{"OutOfRange", "fps = 20.0", "fps = 0.0", "[camera] fps: is 0; allowed: 1 to 1000"},
        Mistake{"NotANumber", "fx = 140.0", "fx = nan", "[camera] fx: is nan; allowed"},
        Mistake{"Missing", "duration_s = 1.0", "", "duration_s: is missing"},
        Mistake{"NoSuchShape", "\"quad\"", "\"blob\"", "is \"blob\"; allowed: quad, box"},
        Mistake{"NoSuchTexture", "texture = \"wall\"", "texture = \"wal\"", "named \"wal\""},
        Mistake{"TwoNumbers", "size = [6.0, 6.0, 0.0]", "size = [6.0, 6.0]", "expected 3 numbers"},
        Mistake{"TexelsNotAPower", "[128, 128]", "[100, 128]", "powers of two"},
        Mistake{"TimesGoBack", "time_s = 1.0", "time_s = 0.0", "later than the key before"},
        Mistake{"ShakeOfNoLength", "[[objects]]",
                "[path.shake]\nstart_s = 0.2\nduration_s = 0.0\n[[objects]]",
                "[shake] duration_s: is 0; allowed"},
        Mistake{"NoPath", "keys = [", "[other]\nkeys = [", "expected either"},
        Mistake{"UnknownEffect", "[[objects]]", "[[effects]]\nkind = \"fog\"\n[[objects]]",
                "is \"fog\"; allowed: lens_distortion"},
        Mistake{"EffectTwice", "[[objects]]",
                "[[effects]]\nkind = \"vignetting\"\ncorner = 0.5\n[[effects]]\nkind = "
                "\"vignetting\"\ncorner = 0.5\n[[objects]]",
                "appears twice"},
        Mistake{"MirrorWithoutEffect", "segments = 4", "mirror = 0.5",
                "needs [[effects]] kind = \"reflection\""},
        Mistake{"NobodyMoves", "[[objects]]",
                "[[effects]]\nkind = \"moving_subject\"\nobjects = [\"me\"]\npivot = [0, 0, "
                "0]\n[[objects]]",
                "no object \"me\""}),
    [](const auto& test) { return test.param.name; });

TEST(SimSceneFile, WhatIsNoFileIsNamed) {
  EXPECT_THAT(message_of([] { load_scene("no/such/scene.toml"); }),
              HasSubstr("no/such/scene.toml: no such file"));
  EXPECT_THAT(message_of([] { load_scene("/tmp"); }), HasSubstr("/tmp: a folder, not a file"));
  EXPECT_THAT(message_of([] { load_scene("/dev/zero"); }), HasSubstr("/dev/zero: not a file"));
}

// Such a device never ends.
TEST(SimSceneFile, MeshMustBeAFile) {
  EXPECT_THAT(message_of([] {
                testing::scene_of(testing::wall_scene(
                    "[[objects]]\nname = \"m\"\nshape = \"mesh\"\nfile = \"/dev/full\"\n"));
              }),
              HasSubstr("/dev/full: not a file"));
}

TEST(SimSceneFile, WithoutAnObjectIsRefused) {
  std::string text = testing::wall_scene();
  const std::size_t objects = text.find("[[objects]]");
  text.erase(objects, text.find("\n[", objects) - objects);
  EXPECT_THAT(message_of([&] { testing::scene_of(text); }),
              HasSubstr("objects: is missing; expected at least one"));
}

TEST(SimSceneFile, MeshIsReadAndItsMistakesHaveALine) {
  const lumibox::testing::TempDir folder;
  const auto scene_with = [&](const std::string& obj) {
    folder.write("mesh.obj", obj);
    return message_of([&] {
      load_scene(folder.write(
          "scene.toml", testing::wall_scene(
                            "[[objects]]\nname = \"m\"\nshape = \"mesh\"\nfile = \"mesh.obj\"\n")));
    });
  };
  EXPECT_EQ(scene_with("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 -1\n"), "");
  EXPECT_THAT(scene_with("v 0 0 0\nv 1 0\n"), HasSubstr("mesh.obj:2: expected 3 numbers"));
  EXPECT_THAT(scene_with("v 0 0 0\nf 1 1 9\n"), HasSubstr("mesh.obj:2: index 9 is outside"));
  EXPECT_THAT(scene_with("v 0 0 0\nf 1 x 1\n"), HasSubstr("is not an index"));
  EXPECT_THAT(scene_with("# nothing\n"), HasSubstr("has no faces"));
}

}  // namespace
}  // namespace lumibox::hal
