// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "outline.h"

#include <gtest/gtest.h>

namespace gloam::view {
namespace {

TEST(Outline, StandsRoundWhatIsChosenAndNowhereElse) {
  constexpr int kWidth = 12, kHeight = 10;
  std::vector<std::uint32_t> ids(kWidth * kHeight, 1);
  for (int y = 4; y < 6; ++y) {
    for (int x = 5; x < 8; ++x) ids[std::size_t(y * kWidth + x)] = 2;
  }
  const std::vector<std::uint8_t> before(4 * ids.size(), 100);
  std::vector<std::uint8_t> after = before;
  drawOutline(after, kWidth, kHeight, ids, {false, true});
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int away = std::max({5 - x, x - 7, 4 - y, y - 5});  // pixels from the chosen ones
      const int red = after[std::size_t(4 * (y * kWidth + x))];
      EXPECT_EQ(red, away == 1 ? 255 : away == 2 ? 12 : 100) << x << " " << y;
      EXPECT_EQ(after[std::size_t(4 * (y * kWidth + x) + 3)], 100);  // alpha stays
    }
  }
  after = before;
  drawOutline(after, kWidth, kHeight, ids, {false, false});
  EXPECT_EQ(after, before);
  drawOutline(after, kWidth, kHeight + 1, ids, {false, true});  // another size: nothing
  EXPECT_EQ(after, before);
}

TEST(Outline, FollowsTheTree) {
  Scene scene;
  scene.nodes.resize(3);
  scene.nodes[1].parent = 0;
  EXPECT_EQ(instancesBelow(scene, {0, 1, 2}, 0), (std::vector<bool>{true, true, false}));
  EXPECT_EQ(instancesBelow(scene, {0, 1, 2}, 1), (std::vector<bool>{false, true, false}));
  EXPECT_EQ(instancesBelow(scene, {0, 1, 2}, kNone), (std::vector<bool>{false, false, false}));
}

}  // namespace
}  // namespace gloam::view
