#include "render/governor.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <functional>

namespace lumibox::render {
namespace {

constexpr Governor::Wish kMesh{Geometry::Mesh, Aperture::Small};
constexpr Governor::Wish kWide{Geometry::Plane, Aperture::Wide};
constexpr Effort kAll{Geometry::Mesh, 1.0, 1.0};

/// What a machine takes for a picture, given what full quality takes it.
double cost_ms(const Effort& effort, double full_ms) {
  const double pixels = effort.scale * effort.scale;
  return full_ms * pixels * effort.k_share * (effort.geometry == Geometry::Mesh ? 1.0 : 0.5);
}

Effort run(Governor& governor, const Governor::Wish& wish, double full_ms, double budget_ms,
           int choices) {
  Effort effort;
  for (int i = 0; i < choices; ++i) {
    effort = governor.choose(wish, budget_ms);
    governor.measured(cost_ms(effort, full_ms));
  }
  return effort;
}

TEST(Governor, BeginsWithAllOfIt) {
  Governor governor;
  EXPECT_EQ(governor.choose(kMesh, 10.0), (Effort{Geometry::Mesh, 1.0, 1.0}));
}

TEST(Governor, StaysWithAllOfItWhileThatFits) {
  Governor governor;
  EXPECT_EQ(run(governor, kMesh, 9.9, 10.0, 100), (Effort{Geometry::Mesh, 1.0, 1.0}));
}

TEST(Governor, WhatIsTooSlowIsLeftAfterThreePictures) {
  Governor governor;
  EXPECT_EQ(run(governor, kMesh, 40.0, 15.0, 3), kAll);
  const Effort next = governor.choose(kMesh, 15.0);
  EXPECT_LT(cost_ms(next, 40.0), 15.0);
  EXPECT_EQ(next.geometry, Geometry::Mesh);
}

// Uploads, first depth maps, what a driver does when it first draws.
TEST(Governor, WhatAChangeCostsIsNotTheUsualCost) {
  Governor governor;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(governor.choose(kMesh, 15.0), kAll);
    governor.measured(i < 2 ? 200.0 : 10.0);
  }
  governor.choose(kWide, 15.0);
  governor.measured(8.0);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(governor.choose(kMesh, 15.0), kAll) << "another kind has been shown meanwhile";
    governor.measured(i < 2 ? 200.0 : 10.0);
  }
}

TEST(Governor, AfterAFallTheFirstPictureDoesNotCountEither) {
  Governor governor;
  run(governor, kMesh, 25.0, 15.0, 3);
  const Effort fallen = governor.choose(kMesh, 15.0);
  EXPECT_EQ(fallen, (Effort{Geometry::Mesh, 0.71, 1.0}));
  governor.measured(200.0);
  EXPECT_EQ(governor.choose(kMesh, 15.0), fallen);
  governor.measured(200.0);
  EXPECT_EQ(run(governor, kMesh, 25.0, 15.0, 30), fallen);
}

TEST(Governor, NoSinglePictureMakesItFall) {
  for (int late = 0; late < 40; ++late) {
    Governor governor;
    for (int i = 0; i < 60; ++i) {
      EXPECT_EQ(governor.choose(kMesh, 15.0), kAll) << late << ", " << i;
      governor.measured(i == late ? 500.0 : 10.0);
    }
  }
}

TEST(Governor, NoSingleTickWithoutTimeMakesItFall) {
  for (int late = 0; late < 40; ++late) {
    Governor governor;
    for (int i = 0; i < 60; ++i) {
      EXPECT_EQ(governor.choose(kMesh, i == late ? -20.0 : 15.0), kAll) << late << ", " << i;
      governor.measured(10.0);
    }
  }
}

TEST(Governor, OfTicksThatAlternateTheShorterCount) {
  Governor governor;
  for (int i = 0; i < 60; ++i) {
    const Effort effort = governor.choose(kMesh, i % 2 == 0 ? 30.0 : 15.0);
    governor.measured(cost_ms(effort, 20.0));
    if (i > 10) {
      EXPECT_LT(cost_ms(effort, 20.0), 15.0) << i;
    }
  }
}

// At 30 choices a second: from the last rung to the first, and as long as it takes to see that the
// other work is over.
TEST(Governor, RisesWithinTwoSecondsWhenWhatDelayedItIsOver) {
  for (const double busy_ms : {60.0, 200.0, 1000.0}) {
    Governor governor;
    EXPECT_NE(run(governor, kMesh, busy_ms, 15.0, 90), kAll);
    EXPECT_EQ(run(governor, kMesh, 10.0, 15.0, 60), kAll) << busy_ms;
  }
}

// What is thought of a better rung may be wrong each time: here the last step costs ten times as
// much as the one before.
TEST(Governor, AfterTrialsThatFailItWaitsLonger) {
  Governor governor;
  int trials = 0;
  for (int i = 0; i < 1800; ++i) {  // a minute
    const Effort effort = governor.choose(kMesh, 15.0);
    governor.measured(effort == kAll ? 20.0 : 2.0);
    trials += effort == kAll ? 1 : 0;
  }
  EXPECT_GE(trials, 4 * 3);
  EXPECT_LE(trials, 11 * 3) << "three pictures each";
}

TEST(Governor, WithTooLittleTimeForAnythingItDrawsTheCheapest) {
  Governor governor;
  const Effort effort = run(governor, kWide, 1e6, 1.0, 20);
  EXPECT_EQ(effort, (Effort{Geometry::Plane, 0.35, 0.25}));
  EXPECT_EQ(run(governor, kWide, 1e6, 0.0, 20), effort) << "no time at all";
}

TEST(Governor, WhatDelayedItIsForgotten) {
  Governor governor;
  EXPECT_LT(run(governor, kMesh, 100.0, 15.0, 30).scale, 1.0);
  // 40 s at 30 a second: from 100 ms to a room of 12 costs halve three times, in ten seconds each.
  EXPECT_EQ(run(governor, kMesh, 5.0, 15.0, 1200), (Effort{Geometry::Mesh, 1.0, 1.0}));
}

TEST(Governor, ApertureAndShapeAreLearnedApart) {
  Governor governor;
  run(governor, kMesh, 100.0, 15.0, 30);
  EXPECT_EQ(governor.choose(kWide, 15.0), (Effort{Geometry::Plane, 1.0, 1.0}));
}

TEST(Governor, FocalPlanesStayFocal) {
  Governor governor;
  EXPECT_EQ(run(governor, {Geometry::Focal, Aperture::Small}, 100.0, 15.0, 30).geometry,
            Geometry::Focal);
}

TEST(Governor, SaysWhatItChose) {
  EXPECT_EQ(description({Geometry::Mesh, 0.71, 1.0}, 8), "shape, 0.71 of the size, 8 views");
  EXPECT_EQ(at_effort({}, {Geometry::Plane, 1.0, 0.5}).k, 20);
  Settings one;
  one.k = 1;
  EXPECT_EQ(at_effort(one, {Geometry::Plane, 1.0, 0.25}).k, 1) << "never none";
}

RC_GTEST_PROP(GovernorProperties, KeepsWithinTheBudgetWhereThatCanBeDone, ()) {
  const Governor::Wish wish = *rc::gen::element(kMesh, kWide);
  const double full_ms = *rc::gen::inRange(1, 200);
  const double budget_ms = *rc::gen::inRange(5, 40);
  Governor governor;
  run(governor, wish, full_ms, budget_ms, 20);
  int over = 0;
  for (int i = 0; i < 300; ++i) {
    const double cost = cost_ms(run(governor, wish, full_ms, budget_ms, 1), full_ms);
    over += cost > budget_ms ? 1 : 0;
  }
  const double least = wish.aperture == Aperture::Wide ? full_ms * 0.35 * 0.35 * 0.25 * 0.5
                                                       : full_ms * 0.35 * 0.35 * 0.5;
  RC_PRE(least < budget_ms);
  RC_ASSERT(over <= 9);  // what is better is tried again now and then
}

RC_GTEST_PROP(GovernorProperties, DoesNotChangeBackAndForth, ()) {
  const double full_ms = *rc::gen::inRange(1, 200);
  const std::vector<int> noise =
      *rc::gen::container<std::vector<int>>(300, rc::gen::inRange(-10, 11));
  Governor governor;
  run(governor, kMesh, full_ms, 15.0, 20);
  int changes = 0;
  Effort before = governor.choose(kMesh, 15.0);
  for (const int percent : noise) {
    const Effort effort = governor.choose(kMesh, 15.0);
    governor.measured(cost_ms(effort, full_ms) * (1.0 + 0.01 * percent));
    changes += effort == before ? 0 : 1;
    before = effort;
  }
  RC_ASSERT(changes <= 8);  // in ten seconds
}

}  // namespace
}  // namespace lumibox::render
