#include "render/overlay.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "geometry/rotation.h"
#include "render/font.h"
#include "render/gl_test.h"
#include "render/leave_one_out.h"
#include "render/quality_color.h"
#include "render/ray_cast.h"

namespace lumibox::render {
namespace {

using test::look_at;
using test::make_camera;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

class OverlayTest : public test::GlTest {
 protected:
  void SetUp() override {
    display_ = open_display(kWidth, kHeight);
    if (display_) overlay_ = std::make_unique<Overlay>();
  }

  void clear(float grey) {
    glBindFramebuffer(GL_FRAMEBUFFER, display_->framebuffer());
    glClearColor(grey, grey, grey, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
  }

  hal::Image read_back() const {
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return display_->read_back();
  }

  unsigned framebuffer() const { return display_->framebuffer(); }

  std::unique_ptr<hal::OffscreenDisplay> display_;
  std::unique_ptr<Overlay> overlay_;
  const lightfield::Sphere sphere_{Eigen::Vector3d::Zero(), 1.0};
  const View front_{make_camera(kWidth, kHeight), look_at({0, 0, -4}, {0, 0, 0})};
};

TEST_F(OverlayTest, APinholesPictureIsShownAsItIs) {
  const hal::Image picture =
      test::photograph(test::textured_ball(1.0), front_.camera, front_.world_from_camera);
  overlay_->draw_image(picture, front_.camera, front_, 1.0F, framebuffer());
  const hal::Image shown = read_back();
  for (std::size_t i = 0; i < shown.size_bytes(); ++i) {
    ASSERT_LE(std::abs(shown.data()[i] - picture.data()[i]), 1) << i;
  }
}

TEST_F(OverlayTest, ALensIsStraightened) {
  for (const geometry::Camera& lens :
       {make_camera(kWidth, kHeight, true), test::make_fisheye_camera(kWidth, kHeight)}) {
    const auto perspective =
        test::photograph_perspective(0, test::textured_ball(1.0), lens, front_.world_from_camera);
    const View view{lens.undistorted(), front_.world_from_camera};
    overlay_->draw_image(*perspective.photo->rgb(), *perspective.camera, view, 1.0F, framebuffer());
    const hal::Image shown = read_back();
    const UndistortedPicture expected = undistort(perspective);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (*expected.valid.at(x, y) == 0) continue;
        ASSERT_LE(std::abs(shown.at(x, y)[0] - expected.color.at(x, y)[0]), 3) << x << " " << y;
      }
    }
  }
}

TEST_F(OverlayTest, OpacityMixesWithWhatIsThere) {
  hal::Image white(kWidth, kHeight, 3);
  std::fill_n(white.data(), white.size_bytes(), std::uint8_t{255});
  clear(0.0F);
  overlay_->draw_image(white, front_.camera, front_, 0.25F, framebuffer());
  EXPECT_NEAR(read_back().at(100, 100)[1], 64, 1);
}

TEST_F(OverlayTest, DotsLieWhereTheLineToSMeetsTheSphere) {
  clear(0.4F);
  const Eigen::Vector3d recorded(-4.0, 1.0, -8.0);
  const Eigen::Vector3d current(3.0, -2.0, -7.0);
  overlay_->draw_coverage({sphere_, {{recorded, 26.0}}, current, {}}, front_, framebuffer());
  const hal::Image shown = read_back();
  const auto shown_at = [&](const Eigen::Vector3d& center) {
    const auto pixel = front_.camera.project(front_.world_from_camera.inverse() *
                                             Eigen::Vector3d(center.normalized()));
    return shown.at(static_cast<int>(std::lround(pixel->x())),
                    static_cast<int>(std::lround(pixel->y())));
  };
  const std::uint8_t* white = shown_at(recorded);
  EXPECT_TRUE(white[0] > 240 && white[1] > 240 && white[2] > 240);
  const std::uint8_t* red = shown_at(current);
  EXPECT_TRUE(red[0] > 240 && red[1] < 60 && red[2] < 60);
}

TEST_F(OverlayTest, DotsHaveTheColourOfTheirQuality) {
  clear(0.4F);
  const std::vector<Coverage::Dot> dots = {
      {{-2.0, 0.0, -4.0}, 40.0}, {{-0.7, 0.0, -4.0}, {}}, {{0.7, 0.0, -4.0}, 12.0}};
  overlay_->draw_coverage({sphere_, dots, {}, {}}, front_, framebuffer());
  const hal::Image shown = read_back();
  const auto shown_at = [&](std::size_t i) {
    const auto pixel = front_.camera.project(front_.world_from_camera.inverse() *
                                             Eigen::Vector3d(dots[i].center.normalized()));
    return shown.at(static_cast<int>(std::lround(pixel->x())),
                    static_cast<int>(std::lround(pixel->y())));
  };
  EXPECT_GT(shown_at(0)[2], shown_at(0)[0] + 100) << "good: blue";
  EXPECT_NEAR(shown_at(1)[0], shown_at(1)[2], 3) << "unknown: grey";
  EXPECT_LT(shown_at(1)[0], 200);
  EXPECT_GT(shown_at(2)[0], shown_at(2)[2] + 100) << "poor: orange";
}

TEST_F(OverlayTest, OneThatDisagreesHasARing) {
  const auto orange = [&](bool disagrees) {
    clear(0.0F);
    overlay_->draw_coverage({sphere_, {{{0.0, 0.0, -4.0}, 26.0, disagrees}}, {}, {}}, front_,
                            framebuffer());
    const hal::Image shown = read_back();
    int count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        count += shown.at(x, y)[0] > shown.at(x, y)[2] + 100 ? 1 : 0;
      }
    }
    return count;
  };
  EXPECT_EQ(orange(false), 0);
  EXPECT_GT(orange(true), 15);
}

/// Pixels that are yellow, by their mean place.
struct Yellow {
  int count = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();

  explicit Yellow(const hal::Image& image) {
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const std::uint8_t* p = image.at(x, y);
        if (p[0] < 180 || p[1] < 140 || p[2] > 120) continue;
        ++count;
        middle += Eigen::Vector2d(x, y);
      }
    }
    if (count > 0) middle /= count;
  }
};

TEST_F(OverlayTest, AnArrowOnTheSphereLeadsFromTheCameraToTheHole) {
  const Eigen::Vector3d current(-1.5, 0.0, -4.0);
  const Eigen::Vector3d hole = Eigen::Vector3d(1.5, -2.0, -4.0).normalized();
  clear(0.0F);
  overlay_->draw_coverage({sphere_, {}, current, hole}, front_, framebuffer());
  const hal::Image shown = read_back();
  const auto on_screen = [&](const Eigen::Vector3d& direction) {
    return *front_.camera.project(front_.world_from_camera.inverse() *
                                  Eigen::Vector3d(direction.normalized()));
  };
  const auto is_yellow = [&](const Eigen::Vector2d& pixel) {
    const std::uint8_t* p = shown.at(static_cast<int>(std::lround(pixel.x())),
                                     static_cast<int>(std::lround(pixel.y())));
    return p[0] > 150 && p[1] > 120 && p[2] < 120;
  };
  for (const double share : {0.3, 0.5, 0.8}) {
    EXPECT_TRUE(is_yellow(on_screen(geometry::slerp(current.normalized(), hole, share)))) << share;
  }
  clear(0.0F);
  overlay_->draw_coverage({sphere_, {}, current, {}}, front_, framebuffer());
  EXPECT_EQ(Yellow(read_back()).count, 0);
}

TEST_F(OverlayTest, AnArrowAtTheEdgePointsOutwards) {
  for (const auto& [way, where] : {std::pair{Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(300, 120)},
                                   {Eigen::Vector2d(-2.0, 0.0), Eigen::Vector2d(20, 120)},
                                   {Eigen::Vector2d(0.0, -0.1), Eigen::Vector2d(160, 50)},
                                   {Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(160, 190)}}) {
    clear(0.0F);
    overlay_->draw_arrow(way, kWidth, kHeight, framebuffer());
    const hal::Image shown = read_back();
    const Yellow yellow(shown);
    EXPECT_GT(yellow.count, 20);
    EXPECT_LT((yellow.middle - where).norm(), 25.0) << yellow.middle.transpose();
    // The head is wider than the shaft, and outside.
    const Eigen::Vector2d middle(0.5 * (kWidth - 1), 0.5 * (kHeight - 1));
    EXPECT_GT((yellow.middle - middle).dot(way.normalized()), 50.0);
  }
  clear(0.0F);
  overlay_->draw_arrow({0.0, 0.0}, kWidth, kHeight, framebuffer());
  EXPECT_EQ(read_back(), hal::Image(kWidth, kHeight, 3));
}

TEST(ColorOfQuality, GoesFromOrangeOverWhiteToBlue) {
  EXPECT_EQ(color_of_quality(10.0).b, color_of_quality(18.0).b);
  EXPECT_EQ(color_of_quality(26.0).r, 1.0F);
  EXPECT_EQ(color_of_quality(26.0).b, 1.0F);
  EXPECT_EQ(color_of_quality(34.0).r, color_of_quality(99.0).r);
  float before = 2.0F;
  for (double psnr = 26.0; psnr <= 34.0; psnr += 1.0) {
    EXPECT_LT(color_of_quality(psnr).r, before);
    before = color_of_quality(psnr).r;
  }
}

TEST_F(OverlayTest, TheFarSideIsDimmer) {
  const auto brightest_at_middle = [&](const Eigen::Vector3d& center) {
    clear(0.0F);
    overlay_->draw_coverage({sphere_, {{center, 26.0}}, {}, {}}, front_, framebuffer());
    return *read_back().at(kWidth / 2, kHeight / 2);
  };
  const int near = brightest_at_middle({0.02, 0.0, -4.0});
  const int far = brightest_at_middle({0.02, 0.0, 4.0});
  EXPECT_GT(near, 240);
  EXPECT_GT(far, 60);
  EXPECT_LT(far, 160);
}

TEST_F(OverlayTest, OddSpheresAreNoError) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Coverage::Dot> dots = {
      {{0, 0, 0}, {}}, {{0, 0, -4}, 20.0, true}, {{nan, 0, 0}, nan}};
  const Eigen::Vector3d current(0, 0, -4);
  for (const double radius : {0.0, -1.0, nan, 1e-6, 3.999, 4.0, 50.0, 1e12}) {
    for (const Eigen::Vector3d& hole : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(nan, 0, 0)}) {
      overlay_->draw_coverage({{Eigen::Vector3d::Zero(), radius}, dots, current, hole}, front_,
                              framebuffer());
    }
  }
  const View away{front_.camera, look_at({0, 0, -4}, {0, 0, -8})};
  clear(0.0F);
  overlay_->draw_coverage({sphere_, dots, current, current}, away, framebuffer());
  EXPECT_EQ(read_back(), hal::Image(kWidth, kHeight, 3));  // all of it lies behind
}

// Text must be read on any picture: it holds both nearly white and nearly black pixels.
TEST_F(OverlayTest, TextStandsOutOnAnyGrey) {
  for (const float grey : {0.0F, 0.5F, 1.0F}) {
    clear(grey);
    overlay_->draw_text({{"threshold 4°", 20.0F, 60.0F, 22.0F, {}}}, kWidth, kHeight,
                        framebuffer());
    const hal::Image shown = read_back();
    const auto [least, most] = std::minmax_element(shown.data(), shown.data() + shown.size_bytes());
    EXPECT_LT(*least, 80) << grey;
    EXPECT_GT(*most, 240) << grey;
    EXPECT_EQ(*shown.at(20, 100), *shown.at(300, 10));  // nothing far from the line
  }
}

TEST_F(OverlayTest, TextOfAllKindsIsNoError) {
  std::vector<Text> lines;
  for (int size = 0; size < 30; ++size) {  // more sizes than the atlas holds at once
    lines.push_back({"ABCDEFGHIJKLMNOPQRSTUVWXYZ abcdefghijklmnopqrstuvwxyz 0123456789 →°é€",
                     2.0F,
                     4.0F * static_cast<float>(size),
                     8.0F + 3.0F * static_cast<float>(size),
                     {}});
  }
  lines.push_back({"", 0.0F, 0.0F, 18.0F, {}});
  lines.push_back({"\xff\xfe broken \xe2\x82", 0.0F, 20.0F, 18.0F, {}});
  lines.push_back({"size", 0.0F, 20.0F, std::numeric_limits<float>::quiet_NaN(), {}});
  lines.push_back({"size", 0.0F, 20.0F, 1e9F, {}});
  overlay_->draw_text(lines, kWidth, kHeight, framebuffer());
  read_back();
}

TEST_F(OverlayTest, ReticleIsInTheMiddle) {
  clear(0.2F);
  overlay_->draw_reticle(kWidth, kHeight, framebuffer());
  const hal::Image shown = read_back();
  double x_sum = 0.0;
  double y_sum = 0.0;
  double count = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (*shown.at(x, y) < 128) continue;
      x_sum += x;
      y_sum += y;
      count += 1.0;
    }
  }
  ASSERT_GT(count, 10.0);
  EXPECT_NEAR(x_sum / count, 0.5 * (kWidth - 1), 0.3);
  EXPECT_NEAR(y_sum / count, 0.5 * (kHeight - 1), 0.3);
}

TEST(DecodeUtf8, GivesCodePointsAndReplacements) {
  EXPECT_EQ(decode_utf8("a°→𝄞"), (std::vector<char32_t>{U'a', U'°', U'→', U'𝄞'}));
  EXPECT_EQ(decode_utf8("\xff"
                        "a\xe2\x82"),
            (std::vector<char32_t>{0xFFFD, U'a', 0xFFFD, 0xFFFD}));
  EXPECT_TRUE(decode_utf8("").empty());
}

}  // namespace
}  // namespace lumibox::render
