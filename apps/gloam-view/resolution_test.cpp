// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "resolution.h"

#include <gtest/gtest.h>

namespace gloam::view {
namespace {

constexpr double kWindow = 640.0 * 420.0;

/// Draws a picture that stands still until it does not grow any more, as a session does; every pixel costs as much.
float settle(Resolution& resolution, double window_pixels, double ms_a_pixel) {
  float share = resolution.scale("t", window_pixels, false);
  for (int i = 0; i < 8; ++i) {
    const double pixels = window_pixels * double(share) * double(share);
    const double milliseconds = 5.0 + pixels * ms_a_pixel;
    resolution.add("t", pixels, share, milliseconds);
    if (!resolution.mayGrow(share, milliseconds)) break;
    share = resolution.grown(resolution.scale("t", window_pixels, false), share);
  }
  return share;
}

TEST(Resolution, TinyWindowsTeachNothing) {
  Resolution resolution;
  for (const double tiny : {1.0, 1600.0}) {
    resolution.fit(tiny);
    EXPECT_EQ(settle(resolution, tiny, 1e-4), 1.0f);
    resolution.add("t", tiny, 1.0f, 30.0);
    resolution.fit(kWindow);
    EXPECT_EQ(settle(resolution, kWindow, 1e-4), 1.0f);
  }
}

TEST(Resolution, AStalePredictionDoesNotStopGrowth) {
  Resolution resolution;
  resolution.fit(kWindow);
  resolution.add("t", kWindow * 0.7, 0.84f, 60000.0);  // once, when the machine was busy
  EXPECT_LT(resolution.scale("t", kWindow, false), 0.3f);
  EXPECT_EQ(settle(resolution, kWindow, 1e-4), 1.0f);
}

TEST(Resolution, WhatCostsMuchStaysSmall) {
  Resolution resolution;
  resolution.fit(kWindow);
  EXPECT_LE(settle(resolution, kWindow, 0.05), 0.71f);  // 6.8 s, with nothing learnt yet
  EXPECT_LT(resolution.scale("t", kWindow, false), 0.4f);
  resolution.fixed = 0.5f;
  EXPECT_EQ(settle(resolution, kWindow, 1e-4), 0.5f);
}

/// A small picture whose pixels come cheap (from what is kept) promises a large one that takes longer than it should.
TEST(Resolution, WhatMovesIsHeldToWhatLargePicturesTook) {
  Resolution resolution;
  resolution.fit(kWindow);
  resolution.add("t", kWindow * 0.06, 0.25f, 9.0);
  EXPECT_EQ(resolution.scale("t", kWindow, true), 1.0f);
  resolution.add("t", kWindow, 1.0f, 250.0);
  EXPECT_EQ(resolution.scale("t", kWindow, true), 0.6f);        // 90 ms
  EXPECT_EQ(resolution.scale("t", kWindow, true, true), 0.5f);  // 45 ms, by what small ones took
  for (int i = 0; i < 8; ++i) resolution.add("t", kWindow, 1.0f, 30.0);
  EXPECT_EQ(resolution.scale("t", kWindow, true), 1.0f);
}

TEST(Resolution, WhatCostsMostIsSeenAtOnceAfterASwitch) {
  Resolution resolution;
  const double window = 1068.0 * 872.0;
  resolution.fit(window);
  resolution.add("t", window * 0.18 * 0.18, 0.18f, 180.0);
  EXPECT_EQ(resolution.scale("t", window, true), 0.18f);
  EXPECT_EQ(resolution.scale("t", window, true, true), 0.11f);
  EXPECT_EQ(resolution.scale("t", 300.0 * 200.0, true, true), 0.35f);  // never below 4,096 pixels
}

TEST(Resolution, AnotherOrderOfSizeForgets) {
  Resolution resolution;
  resolution.fit(kWindow);
  resolution.add("t", kWindow, 1.0f, 60000.0);
  resolution.fit(kWindow * 1.5);
  EXPECT_LT(resolution.scale("t", kWindow * 1.5, false), 0.3f);
  resolution.fit(kWindow * 30.0);
  EXPECT_EQ(resolution.scale("t", kWindow * 30.0, false), 0.25f);  // 4K: not 4 million pixels at once
  EXPECT_EQ(resolution.scale("t", kWindow * 3.0, false), 0.71f);
}

}  // namespace
}  // namespace gloam::view
