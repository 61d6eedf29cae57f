// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "golden.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace gloam::test {
namespace {

namespace fs = std::filesystem;

class Golden : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("GLOAM_UPDATE_GOLDEN");
    fs::create_directories(folder_ / "goldens");
    for (int i = 0; i < 256; ++i) ramp_.pixels[std::size_t(i) * 3 + std::size_t(i) % 3] = float(i) / 255.0f;
  }
  void TearDown() override {
    unsetenv("GLOAM_UPDATE_GOLDEN");
    fs::remove_all(folder_);
  }
  std::string compare(const Image& image, const GoldenTolerance& tolerance = {}) {
    return compareWithGolden(image, "ramp", tolerance, folder_ / "goldens", folder_ / "failures");
  }
  void accept(const Image& image) {
    setenv("GLOAM_UPDATE_GOLDEN", "1", 1);
    EXPECT_EQ(compare(image), "");
    unsetenv("GLOAM_UPDATE_GOLDEN");
  }
  bool left(const char* name) const { return fs::exists(folder_ / "failures" / "ramp" / name); }

  fs::path folder_ = fs::temp_directory_path() / ("gloam_golden_test_" + std::to_string(getpid()));
  Image ramp_{16, 16, 3};
};

TEST_F(Golden, APictureAgreesWithItself) {
  accept(ramp_);
  EXPECT_EQ(compare(ramp_, {.max_difference = 0, .share_differing = 0.0}), "");
  EXPECT_FALSE(fs::exists(folder_ / "failures" / "ramp"));
}

TEST_F(Golden, AMissingOneIsAFailureThatLeavesWhatWasGot) {
  EXPECT_NE(compare(ramp_).find("there is no"), std::string::npos);
  EXPECT_TRUE(left("got.png"));
}

TEST_F(Golden, OnePixelTooFarFailsAndLeavesThreePictures) {
  accept(ramp_);
  ramp_.at(5, 7)[1] = 1.0f;
  const std::string verdict = compare(ramp_, {.max_difference = 100, .share_differing = 1.0});
  EXPECT_NE(verdict.find("channel 1 at 5, 7"), std::string::npos) << verdict;
  for (const char* name : {"got.png", "want.png", "diff.png"}) EXPECT_TRUE(left(name)) << name;
  const Image diff = readImage(folder_ / "failures" / "ramp" / "diff.png");
  EXPECT_GT(diff.at(5, 7)[1], 0.9f);
  EXPECT_EQ(diff.at(5, 6)[1], 0.0f);
  ramp_.at(5, 7)[1] = 0.0f;
  accept(ramp_);
  EXPECT_EQ(compare(ramp_), "");
  EXPECT_FALSE(left("got.png")) << "an old failure is cleared";
}

TEST_F(Golden, ManyPixelsALittleOffFailByTheirShare) {
  accept(ramp_);
  for (int i = 0; i < 8; ++i) ramp_.at(i, 3)[0] += 0.02f;
  EXPECT_EQ(compare(ramp_, {.max_difference = 60, .share_differing = 8.0 / 256.0}), "");
  EXPECT_NE(compare(ramp_, {.max_difference = 60, .share_differing = 7.0 / 256.0}), "");
}

TEST_F(Golden, OtherSizesDoNotAgree) {
  accept(ramp_);
  EXPECT_NE(compare(Image(8, 16, 3)).find("8 x 16"), std::string::npos);
  EXPECT_NE(compare(Image(16, 16, 4)), "");
  EXPECT_NE(compare(Image(129, 1, 3)).find("at most 128"), std::string::npos);
}

}  // namespace
}  // namespace gloam::test
