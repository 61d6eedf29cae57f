// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/video.h"

#include <cmath>
#include <cstdlib>

#include "image/color.h"
#include "image/test_files.h"

namespace gloam {
namespace {

using test::Bytes;
using test::errorOf;
namespace fs = std::filesystem;

class Video : public test::FileTest {
 protected:
  void SetUp() override {
    FileTest::SetUp();
    search_path_ = std::getenv("PATH");
  }
  void TearDown() override {
    setenv("PATH", search_path_.c_str(), 1);
    FileTest::TearDown();
  }
  static bool ffmpegIsThere() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }
  // A program called ffmpeg that does what the test wants.
  void pretend(const std::string& script) {
    fs::create_directory(path("bin"));
    put("bin/ffmpeg", "#!/bin/sh\n" + script + "\n");
    fs::permissions(path("bin/ffmpeg"), fs::perms::owner_all);
    setenv("PATH", (path("bin").string() + ":" + search_path_).c_str(), 1);
  }
  std::string search_path_;
};

// Left half of one colour, right half of another; the brightness rises from frame to frame.
Image frame(int width, int height, int index) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float* p = image.at(x, y);
      p[x < width / 2 ? 0 : 2] = srgbDecode(float(100 + 20 * index) / 255.0f);
      p[1] = srgbDecode(0.3f);
    }
  return image;
}

TEST_F(Video, FramesComeBackInColourAndOrder) {
  if (!ffmpegIsThere()) GTEST_SKIP() << "ffmpeg is not installed";
  // Odd sizes, and a name that a shell or ffmpeg's protocols would trip over.
  constexpr int kWidth = 67, kHeight = 41, kFrames = 5;
  const fs::path target = path("a: $(touch x) 'b' %d.mp4");
  {
    VideoWriter video(target, kWidth, kHeight, 25.0);
    for (int i = 0; i < kFrames; ++i) video.add(frame(kWidth, kHeight, i));
    EXPECT_FALSE(fs::exists(target)) << "nothing under the name before it is whole";
    video.finish();
    EXPECT_EQ(video.frameCount(), kFrames);
    EXPECT_THROW(video.add(frame(kWidth, kHeight, 0)), Error);
  }
  EXPECT_EQ(filesInFolder(), 1u);
  fs::rename(target, path("a.mp4"));
  const std::string decode = "ffmpeg -v error -i " + path("a.mp4").string() +
                             " -vf scale=in_color_matrix=bt709 -f rawvideo -pix_fmt rgb24 " +
                             path("raw").string();
  ASSERT_EQ(std::system(decode.c_str()), 0);
  const Bytes raw = bytesOf(path("raw"));
  constexpr int kEvenWidth = 68, kEvenHeight = 42;
  ASSERT_EQ(raw.size(), std::size_t(kEvenWidth * kEvenHeight * 3 * kFrames));
  for (int i = 0; i < kFrames; ++i)
    for (const int x : {8, 60}) {
      const std::uint8_t* p = &raw[std::size_t(((i * kEvenHeight + 20) * kEvenWidth + x) * 3)];
      EXPECT_NEAR(p[x == 8 ? 0 : 2], 100 + 20 * i, 4) << i;
      EXPECT_NEAR(p[x == 8 ? 2 : 0], 0, 4) << i;
      EXPECT_NEAR(p[1], 77, 4) << i;
    }
}

TEST_F(Video, AFolderTakesNumberedPictures) {
  VideoWriter video(path("frames"), 5, 4, 30.0);
  for (int i = 0; i < 3; ++i) video.add(frame(5, 4, i));
  video.finish();
  EXPECT_EQ(encodeSrgb8(readImage(path("frames/frame_0002.png"))), encodeSrgb8(frame(5, 4, 2)));
  EXPECT_FALSE(fs::exists(path("frames/frame_0003.png")));
}

TEST_F(Video, AbandonedLeavesNothing) {
  if (!ffmpegIsThere()) GTEST_SKIP() << "ffmpeg is not installed";
  {
    VideoWriter video(path("a.mp4"), 64, 64, 30.0);
    video.add(frame(64, 64, 0));
  }
  EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(Video, WithoutFfmpegThePackageIsNamed) {
  setenv("PATH", path("nothing").c_str(), 1);
  const std::string error = errorOf([&] { VideoWriter(path("a.mp4"), 4, 4, 30.0); });
  EXPECT_NE(error.find("apt-get install ffmpeg"), std::string::npos) << error;
  EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(Video, AnEncoderThatDiesIsAnErrorWithItsLastWords) {
  pretend("echo first >&2; echo 'no such codec' >&2; exit 3");
  std::string error = errorOf([&] {
    VideoWriter video(path("a.mp4"), 512, 512, 30.0);
    for (int i = 0; i < 8; ++i) video.add(frame(512, 512, 0));
    video.finish();
  });
  EXPECT_NE(error.find("no such codec"), std::string::npos) << error;
  EXPECT_EQ(error.find("first"), std::string::npos);
  fs::remove_all(path("bin"));
  pretend("cat >/dev/null; echo 'disk full' >&2; exit 1");
  error = errorOf([&] {
    VideoWriter video(path("a.mp4"), 4, 4, 30.0);
    video.add(frame(4, 4, 0));
    video.finish();
  });
  EXPECT_NE(error.find("disk full"), std::string::npos) << error;
  EXPECT_FALSE(fs::exists(path("a.mp4")));
}

TEST_F(Video, BadUseIsRefused) {
  EXPECT_NE(errorOf([&] { VideoWriter(path("a.avi"), 4, 4, 30.0); }).find(".mp4"), std::string::npos);
  EXPECT_NE(errorOf([&] { VideoWriter(path("a"), 0, 4, 30.0); }).find("0 x 4"), std::string::npos);
  EXPECT_NE(errorOf([&] { VideoWriter(path("a"), 4, 4, 0.0); }).find("frames per second"), std::string::npos);
  EXPECT_NE(errorOf([&] { VideoWriter(path("a"), 4, 4, std::nan("")); }).find("frames per second"),
            std::string::npos);
  VideoWriter video(path("b"), 4, 4, 30.0);
  EXPECT_NE(errorOf([&] { video.finish(); }).find("without frames"), std::string::npos);
  EXPECT_NE(errorOf([&] { video.add(Image(5, 4, 3)); }).find("4 x 4 was expected"), std::string::npos);
  put("file", std::string("x"));
  EXPECT_NE(errorOf([&] { VideoWriter(path("file"), 4, 4, 30.0); }).find("cannot make"), std::string::npos);
}

}  // namespace
}  // namespace gloam
