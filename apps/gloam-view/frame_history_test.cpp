// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame_history.h"

#include <gtest/gtest.h>

namespace gloam::view {
namespace {

Drawn drawn(const char* technique, int width, double milliseconds, const char* right = "") {
  Drawn d;
  d.technique = technique;
  d.right_technique = right;
  d.width = d.height = width;
  d.left.frame_ms = milliseconds;
  d.left.passes = {{"pass", milliseconds * 0.5}};
  return d;
}

TEST(FrameHistory, SizesThatAlternateForgetNothing) {
  FrameHistory history;
  for (int i = 0; i < 10; ++i) {  // a hand that moves and rests
    history.add(drawn("prt", 100, 900.0));
    for (int j = 0; j < 3; ++j) history.add(drawn("prt", 100, 10.0 + i));
    history.add(drawn("prt", 400, 5000.0));
    history.add(drawn("prt", 400, 160.0));
  }
  EXPECT_EQ(history.frameMs().size(), 60u);
  EXPECT_DOUBLE_EQ(history.medianMs(), 160.0);  // of the newest one's size, without those that came first
  EXPECT_DOUBLE_EQ(history.p95Ms(), 160.0);
  ASSERT_EQ(history.rows().size(), 1u);
  EXPECT_DOUBLE_EQ(history.rows()[0].median_ms, 80.0);
  history.add(drawn("prt", 100, 900.0));
  EXPECT_DOUBLE_EQ(history.medianMs(), 14.5);
}

TEST(FrameHistory, TheFirstCountsWhereThereIsNoOther) {
  FrameHistory history;
  history.add(drawn("prt", 100, 900.0));
  EXPECT_DOUBLE_EQ(history.medianMs(), 900.0);
  history.add(drawn("prt", 100, 10.0));
  EXPECT_DOUBLE_EQ(history.medianMs(), 10.0);
}

TEST(FrameHistory, TechniquesStandApartAndBothHalvesCount) {
  FrameHistory history;
  history.add(drawn("prt", 100, 900.0));
  history.add(drawn("prt", 100, 10.0));
  Drawn split = drawn("prt", 100, 20.0, "proxies");
  split.right.frame_ms = 30.0;
  split.right.passes = {{"other", 12.0}};
  history.add(split);
  EXPECT_EQ(history.frameMs().size(), 1u);
  EXPECT_DOUBLE_EQ(history.medianMs(), 50.0);
  ASSERT_EQ(history.rows().size(), 2u);
  EXPECT_DOUBLE_EQ(history.rows()[1].median_ms, 12.0);
}

TEST(FrameHistory, KeepsTheLast) {
  FrameHistory history;
  for (int i = 0; i < 300; ++i) history.add(drawn("prt", 100, i));
  EXPECT_EQ(history.frameMs().size(), FrameHistory::kKept);
  EXPECT_FLOAT_EQ(history.frameMs().back(), 299.0f);
}

}  // namespace
}  // namespace gloam::view
