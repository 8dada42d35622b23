#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/rendering_curves.h"
#include "bench/rendering_memory.h"
#include "bench/rendering_quality.h"
#include "bench/rendering_speed.h"
#include "config/error.h"
#include "hal/sim_scenes.h"
#include "render/gl_test.h"
#include "support/input_error.h"
#include "support/small_scene.h"

namespace lumibox::bench {
namespace {

using ::testing::HasSubstr;

std::set<std::string> fields(const nlohmann::json& json) {
  std::set<std::string> names;
  for (const auto& item : json.items()) names.insert(item.key());
  return names;
}

void expect_times(const nlohmann::json& json, const char* field) {
  EXPECT_GT(json[field]["median"], 0.0) << field;
  EXPECT_LE(json[field]["median"], json[field]["p95"]) << field;
  EXPECT_LE(json[field]["p95"], json[field]["max"]) << field;
}

/// Measurements draw.
class RenderingBench : public test::GlTest {
 protected:
  void SetUp() override { open_display(16, 16); }

  const std::shared_ptr<const hal::Scene> scene_ = hal::testing::scene_of(testing::kSmallScene);
};

TEST(RenderingVariations, DifferInOneSettingAndHoldTheDefaultOnce) {
  config::Config config;
  config.capture.threshold_deg = 4.5;  // none of the values tried
  config.render.k = 20;                // one of them
  std::map<std::string, int> defaults;
  std::string before;
  double last = 0.0;
  for (const auto& v : rendering_variations(config, {})) {
    const bool on_shape = v.method.geometry == render::Geometry::Mesh;
    const int k = on_shape ? 8 : 20;
    const int set = on_shape ? std::min(8, v.method.settings.k) : v.method.settings.k;
    EXPECT_EQ((v.threshold_deg != 4.5) + (set != k), v.is_default ? 0 : 1)
        << v.method.name << " " << v.setting << " " << v.value;
    const std::string curve = v.method.name + " " + v.setting;
    if (v.is_default) ++defaults[curve];
    if (curve == before) {
      EXPECT_GT(v.value, last) << curve;
    }
    before = curve;
    last = v.value;
  }
  EXPECT_EQ(defaults, (std::map<std::string, int>{{"plane-small threshold_deg", 1},
                                                  {"plane-small k", 1},
                                                  {"plane-wide threshold_deg", 1},
                                                  {"plane-wide k", 1},
                                                  {"mesh threshold_deg", 1},
                                                  {"mesh k", 1}}));
}

TEST_F(RenderingBench, QualityLinesHaveTheFieldsPromised) {
  std::map<std::string, std::map<double, nlohmann::json>> by_threshold;
  measure_quality(scene_, "small", {}, 2, [&](const auto& variation, const auto& result) {
    const nlohmann::json json = to_json("small", variation, result);
    ASSERT_EQ(fields(json),
              (std::set<std::string>{"what", "scene", "method", "setting", "value", "default",
                                     "perspectives", "views", "psnr_subject", "ssim_subject", "ms",
                                     "cpu_ms"}));
    EXPECT_EQ(json["what"], "rendering_quality");
    EXPECT_EQ(json["scene"], "small");
    EXPECT_EQ(json["views"], 2);
    EXPECT_GT(json["psnr_subject"], 10.0) << json;
    EXPECT_GT(json["ssim_subject"], 0.1) << json;
    expect_times(json, "ms");
    expect_times(json, "cpu_ms");
    if (json["setting"] == "threshold_deg") {
      by_threshold[json["method"]][json["value"]] = json;
    }
  });
  ASSERT_EQ(by_threshold.size(), 3U);
  for (auto& [method, line] : by_threshold) {
    EXPECT_GT(line[2]["perspectives"], line[4]["perspectives"]) << method;
    EXPECT_GT(line[4]["perspectives"], line[10]["perspectives"]) << method;
  }
  auto& small = by_threshold["plane-small"];
  EXPECT_GT(small[2]["psnr_subject"], small[10]["psnr_subject"]) << "more is better";
}

TEST_F(RenderingBench, AWalkThatStaysWhereItIsCannotBeJudged) {
  const auto scene = hal::testing::scene_of(hal::testing::ball_scene(0.0, 2.0, 0.0));
  const auto judge = [&] {
    measure_quality(scene, "still", {}, 2, [](const auto&, const auto&) {});
  };
  EXPECT_THAT(testing::message_of(judge), HasSubstr("scene still"));
}

TEST_F(RenderingBench, SpeedLinesHaveTheFieldsPromised) {
  const SpeedEffort effort{10, 3, 2};
  const SpeedRun run = measure_speed(*scene_, {}, effort);
  std::set<std::string> methods;
  for (const SpeedResult& result : run.results) {
    methods.insert(result.method);
    const nlohmann::json json = to_json("small", run, result);
    ASSERT_EQ(fields(json),
              (std::set<std::string>{"what", "scene", "method", "k", "perspectives", "width",
                                     "height", "frames", "rounds", "ms", "cpu_ms", "fit_ms"}));
    EXPECT_EQ(json["what"], "rendering_speed");
    EXPECT_EQ(json["perspectives"], 10);
    EXPECT_EQ(json["width"], 48);
    EXPECT_EQ(json["height"], 36);
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["k"], result.method == "mesh" ? 8 : 40) << result.method;
    expect_times(json, "ms");
    expect_times(json, "cpu_ms");
    EXPECT_LE(json["fit_ms"]["max"], json["ms"]["max"]) << "a part of it";
  }
  EXPECT_EQ(methods, (std::set<std::string>{"plane-small", "plane-wide", "mesh", "naive-quads"}));
  ASSERT_EQ(fields(ratios_to_json("small", run)),
            (std::set<std::string>{"what", "scene", "naive_over_small", "naive_over_small_cpu",
                                   "target"}));
}

TEST(RenderingSpeed, RatiosAreOfTheMedians) {
  SpeedRun run;
  run.results = {{"naive-quads", 40, {120.0, 130.0, 140.0}, {200.0, 0.0, 0.0}, {}},
                 {"plane-small", 40, {10.0, 20.0, 30.0}, {40.0, 0.0, 0.0}, {}}};
  const auto json = ratios_to_json("toy", run);
  EXPECT_EQ(json["naive_over_small"], 12.0);
  EXPECT_EQ(json["naive_over_small_cpu"], 5.0);
}

TEST_F(RenderingBench, MemoryLineHasTheFieldsPromised) {
  const auto json = to_json("small", measure_memory(*scene_, {}, 5));
  ASSERT_EQ(fields(json),
            (std::set<std::string>{"what", "scene", "perspectives", "width", "height", "held_mb",
                                   "drawn_mb", "mesh_mb", "mesh_mb_per_perspective", "upload_ms"}));
  EXPECT_EQ(json["what"], "rendering_memory");
  EXPECT_EQ(json["perspectives"], 5);
  EXPECT_LE(json["held_mb"], json["drawn_mb"]);
  EXPECT_LE(json["drawn_mb"], json["mesh_mb"]);
  expect_times(json, "upload_ms");
}

TEST(PeakMemory, GrowsWithWhatIsHeldAndStaysWhenItIsGone) {
  forget_peak_memory();
  const double before_mb = peak_memory_mb();
  ASSERT_GT(before_mb, 1.0);
  { const std::vector<char> held(64'000'000, 'x'); }
  EXPECT_GT(peak_memory_mb() - before_mb, 60.0);
}

QualityPoint point(const char* method, const char* setting, double value, double cost,
                   double psnr) {
  QualityPoint result;
  result.variation.method.name = method;
  result.variation.setting = setting;
  result.variation.value = value;
  result.variation.is_default = value == 4.0;
  result.perspectives = cost;
  result.cpu_ms = 0.1 * cost;
  result.psnr = psnr;
  return result;
}

const std::vector<QualityPoint> kPoints{
    point("mesh", "threshold_deg", 2, 100, 30.2), point("mesh", "threshold_deg", 4, 50, 30.0),
    point("mesh", "threshold_deg", 8, 25, 25.0), point("mesh", "k", 4, 30, 30.0),
    point("mesh", "k", 8, 60, 30.1)};

TEST(RenderingCurves, ThresholdIsDrawnOverWhatItRecordsAndOverTime) {
  const auto curves = quality_curves("toy", kPoints);
  ASSERT_EQ(curves.size(), 3U);
  EXPECT_EQ(curves[0].points[1].cost, 50.0);
  EXPECT_EQ(curves[0].costs, "perspectives recorded");
  EXPECT_TRUE(curves[0].points[1].is_default);
  EXPECT_EQ(curves[1].points[1].cost, 5.0);
  EXPECT_EQ(curves[2].points.size(), 2U);
  EXPECT_EQ(curves[2].points[1].value, 8.0);
  EXPECT_THAT(draw_quality(curves).str(),
              ::testing::AllOf(HasSubstr(">perspectives recorded<"), HasSubstr(">toy<"),
                               HasSubstr(">mesh: pictures blended, by time<")));
}

TEST(RenderingCurves, KneeIsTheCheapestThatIsNearlyAsGood) {
  EXPECT_EQ(knees(kPoints), (std::vector<bool>{false, true, false, true, false}));
}

TEST(RenderingCurves, TwentyDecibelsAreATenth) {
  EXPECT_DOUBLE_EQ(grey_levels_from_psnr(20.0), 25.5);
}

TEST(RenderingCurves, ScenesAreJudgedByTheirMedians) {
  const auto result = [](double value) {
    QualityResult r;
    r.perspectives = static_cast<std::size_t>(value);
    r.psnr = value;
    r.ssim = value;
    r.wall_ms.median = value;
    r.cpu_ms.median = value;
    return r;
  };
  const QualityPoint median = median_of({}, {result(9), result(1), result(4)});
  for (const double value :
       {median.perspectives, median.psnr, median.ssim, median.wall_ms, median.cpu_ms}) {
    EXPECT_EQ(value, 4.0);
  }
}

}  // namespace
}  // namespace lumibox::bench
