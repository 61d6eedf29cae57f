// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Every form of Radiance's format, written here byte by byte.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "image/formats.h"
#include "image/test_files.h"

namespace gloam {
namespace {

using test::Bytes;
using test::errorOf;
using test::FileTest;
using Rgbe = std::array<std::uint8_t, 4>;

std::string header(const std::string& resolution, const std::string& variables = "FORMAT=32-bit_rle_rgbe\n") {
  return "#?RADIANCE\n# made by a test\n" + variables + "\n" + resolution + "\n";
}

Bytes file(const std::string& header, const Bytes& pixels) {
  Bytes bytes(header.begin(), header.end());
  bytes.insert(bytes.end(), pixels.begin(), pixels.end());
  return bytes;
}

Bytes flat(const std::vector<Rgbe>& pixels) {
  Bytes bytes;
  for (const Rgbe& pixel : pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.end());
  return bytes;
}

Image decode(const Bytes& bytes) {
  return decodeHdr(bytes, "a.hdr");
}

// Pixel (x, y) of a 3 x 2 picture: red x + 1, green y + 1, blue 0.
Rgbe pixelAt(int x, int y) {
  return {std::uint8_t(64 * (x + 1)), std::uint8_t(64 * (y + 1)), 0, 130};
}

TEST(HdrRead, ValuesAreMantissaTimesPowerOfTwo) {
  const Image image = decode(file(
      header("-Y 1 +X 4"), flat({{128, 64, 32, 129}, {255, 0, 1, 128}, {9, 9, 9, 0}, {200, 100, 50, 144}})));
  const std::vector<float> expected{1.0f, 0.5f, 0.25f, 255.0f / 256.0f, 0.0f,     1.0f / 256.0f,
                                    0.0f, 0.0f, 0.0f,  51200.0f,        25600.0f, 12800.0f};
  EXPECT_EQ(image.pixels, expected);
  EXPECT_EQ(image.channels, 3);
}

TEST(HdrRead, AllEightOrientationsShowTheSamePicture) {
  constexpr int kWidth = 3, kHeight = 2;
  for (const bool columns : {false, true})
    for (const char sign_y : {'-', '+'})
      for (const char sign_x : {'+', '-'}) {
        std::vector<Rgbe> stored;
        const int slow_count = columns ? kWidth : kHeight, fast_count = columns ? kHeight : kWidth;
        for (int slow = 0; slow < slow_count; ++slow)
          for (int fast = 0; fast < fast_count; ++fast) {
            const int file_x = columns ? slow : fast, file_y = columns ? fast : slow;
            stored.push_back(pixelAt(sign_x == '+' ? file_x : kWidth - 1 - file_x,
                                     sign_y == '-' ? file_y : kHeight - 1 - file_y));
          }
        const std::string y = fmt::format("{}Y {}", sign_y, kHeight),
                          x = fmt::format("{}X {}", sign_x, kWidth);
        const std::string resolution = columns ? x + " " + y : y + " " + x;
        const Image image = decode(file(header(resolution), flat(stored)));
        ASSERT_EQ(image.width, kWidth) << resolution;
        ASSERT_EQ(image.height, kHeight) << resolution;
        for (int row = 0; row < kHeight; ++row)
          for (int column = 0; column < kWidth; ++column) {
            EXPECT_EQ(image.at(column, row)[0], float(column + 1)) << resolution;
            EXPECT_EQ(image.at(column, row)[1], float(row + 1)) << resolution;
          }
      }
}

TEST(HdrRead, OldRunsRepeatPixelsAndChainTheirBytes) {
  const Rgbe a{128, 0, 0, 129}, b{0, 128, 0, 129};
  // 1 + 3, then 1 + (5 + 256 * 1): 266 pixels.
  const Image image =
      decode(file(header("-Y 1 +X 266"), flat({a, {1, 1, 1, 3}, b, {1, 1, 1, 5}, {1, 1, 1, 1}})));
  for (int x = 0; x < 266; ++x) {
    EXPECT_EQ(image.at(x, 0)[0], x < 4 ? 1.0f : 0.0f) << x;
    EXPECT_EQ(image.at(x, 0)[1], x < 4 ? 0.0f : 1.0f) << x;
  }
  // A pixel between two runs starts counting anew.
  const Image second = decode(file(header("-Y 1 +X 8"), flat({a, {1, 1, 1, 2}, b, {1, 1, 1, 4}})));
  EXPECT_EQ(second.at(2, 0)[0], 1.0f);
  EXPECT_EQ(second.at(3, 0)[1], 1.0f);
  EXPECT_EQ(second.at(7, 0)[1], 1.0f);
}

TEST(HdrRead, NewRunsCodeChannelsApart) {
  Bytes pixels{2, 2, 0, 10};
  const Bytes red{128 + 10, 128}, green{10, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
      blue{128 + 4, 7, 2, 1, 2, 128 + 4, 9};
  const Bytes exponent{128 + 10, 136};
  for (const Bytes* part : {&red, &green, &blue, &exponent})
    pixels.insert(pixels.end(), part->begin(), part->end());
  const Image image = decode(file(header("-Y 1 +X 10"), pixels));
  const std::vector<float> expected_blue{7, 7, 7, 7, 1, 2, 9, 9, 9, 9};
  for (int x = 0; x < 10; ++x) {
    EXPECT_EQ(image.at(x, 0)[0], 128.0f);
    EXPECT_EQ(image.at(x, 0)[1], float(x));
    EXPECT_EQ(image.at(x, 0)[2], expected_blue[std::size_t(x)]);
  }
}

TEST(HdrRead, ExposureAndColorCorrectionAreUndone) {
  const std::string variables =
      "EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR= 1 2 0.5\nVIEW= -vtv\nFORMAT=32-bit_rle_rgbe\n";
  const Image image = decode(file(header("-Y 1 +X 1", variables), flat({{128, 128, 128, 129}})));
  EXPECT_FLOAT_EQ(image.pixels[0], 1.0f / 8.0f);
  EXPECT_FLOAT_EQ(image.pixels[1], 1.0f / 16.0f);
  EXPECT_FLOAT_EQ(image.pixels[2], 1.0f / 4.0f);
}

TEST(HdrRead, XyzeBecomesRec709) {
  // D65 white of luminance 1 in XYZ is white; Y alone has the colour of the matrix's middle column.
  const auto code = [](double value) { return std::uint8_t(std::lround(value * 128.0)); };
  const Image image = decode(file(header("-Y 1 +X 2", "FORMAT=32-bit_rle_xyze\n"),
                                  flat({{code(0.9505), code(1.0), code(1.089), 129}, {0, 128, 0, 129}})));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[std::size_t(c)], 1.0f, 0.012f) << c;
  EXPECT_NEAR(image.pixels[3], -1.5372f, 2e-3f);
  EXPECT_NEAR(image.pixels[4], 1.8760f, 2e-3f);
  EXPECT_NEAR(image.pixels[5], -0.2040f, 2e-3f);
}

TEST(HdrRead, OtherPrimariesKeepGreyGrey) {
  const std::string radiance = "PRIMARIES= 0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333\n";
  const Image image =
      decode(file(header("-Y 1 +X 2", radiance), flat({{128, 128, 128, 129}, {0, 128, 0, 129}})));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[std::size_t(c)], 1.0f, 1e-3f) << c;
  EXPECT_GT(std::abs(image.pixels[3]) + std::abs(image.pixels[5]), 0.005f) << "green is another green";
  const std::string rec709 = "PRIMARIES= 0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290\n";
  EXPECT_EQ(decode(file(header("-Y 1 +X 1", rec709), flat({{0, 128, 0, 129}}))).pixels,
            (std::vector<float>{0, 1, 0}));
}

TEST(HdrRead, HeadersComeInManyForms) {
  const Bytes white = flat({{128, 128, 128, 129}});
  for (const char* text : {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", "#?RADIANCE\n\n-Y 1 +X 1\n",
                           "#?AUTOPANO\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n",
                           "#?RADIANCE\n\tpcomp -n a.hdr\nEXPOSURE=1\n#EXPOSURE=9\n\n-Y 1 +X 1\n"})
    EXPECT_EQ(decode(file(text, white)).pixels, (std::vector<float>{1, 1, 1})) << text;
}

class HdrBroken : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(HdrBroken, IsOneLine) {
  const auto& [text, expected] = GetParam();
  const std::string error = errorOf([&] { decode(Bytes(text.begin(), text.end())); });
  EXPECT_EQ(error.compare(0, 5, "a.hdr"), 0) << error;
  EXPECT_NE(error.find(expected), std::string::npos) << error;
}

std::string pixels(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += char(byte);
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Forms, HdrBroken,
    testing::Values(
        std::pair{std::string("RADIANCE\n\n-Y 1 +X 1\nabcd"), "starts with '#?"},
        std::pair{std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"), "the file ends before"},
        std::pair{header("-Y 1 +X 1", "FORMAT=16-bit\n") + "abcd", "FORMAT"},
        std::pair{header("-Y 1 +X 1", "EXPOSURE=0\n") + "abcd", "EXPOSURE: a positive"},
        std::pair{header("-Y 1 +X 1", "EXPOSURE=-1\n") + "abcd", "EXPOSURE: a positive"},
        std::pair{header("-Y 1 +X 1", "EXPOSURE=1e-30\nEXPOSURE=1e-30\n") + "abcd", "EXPOSURE: a positive"},
        std::pair{header("-Y 1 +X 1", "EXPOSURE=bright\n") + "abcd", "EXPOSURE: 1 numbers"},
        std::pair{header("-Y 1 +X 1", "COLORCORR=1 2\n") + "abcd", "COLORCORR: 3 numbers"},
        std::pair{header("-Y 1 +X 1", "PRIMARIES=0 0 0 0 0 0 0 0\n") + "abcd", "PRIMARIES"},
        std::pair{header("-Y 1 +X"), "resolution"}, std::pair{header("-Y 1 +Y 1") + "abcd", "resolution"},
        std::pair{header("+Z 1 +X 1") + "abcd", "resolution"},
        std::pair{header("-Y 1 +X 1 1") + "abcd", "resolution"},
        std::pair{header("-Y 0 +X 1") + "abcd", "at least 1 x 1"},
        std::pair{header("-Y -4 +X 1") + "abcd", "at least 1 x 1"},
        std::pair{header("-Y 100000 +X 100000") + "abcd", "at most 268435456"},
        std::pair{header("-Y 9999999999999999 +X 1") + "abcd", "resolution"},
        std::pair{header("-Y 16384 +X 16384") + "abcd", "cannot hold"},
        std::pair{header("-Y 3 +X 2") + "abcdabcd", "cannot hold 3 scanlines"},
        std::pair{header("-Y 2 +X 1") + "abcdabc", "cannot hold 2 scanlines"},
        std::pair{header("-Y 1 +X 2") + "abcdabc", "scanline 1 of 1: the file ends"},
        std::pair{header("-Y 1 +X 2") + pixels({1, 1, 1, 1, 9, 9, 9, 9}), "repeats no pixel"},
        std::pair{header("-Y 1 +X 2") + pixels({9, 9, 9, 9, 1, 1, 1, 2}), "a run of 2 where 1"},
        std::pair{header("-Y 1 +X 2") +
                      pixels({9, 9, 9, 9, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 1}),
                  "a run of"},
        std::pair{header("-Y 1 +X 8") + pixels({2, 2, 0, 9, 136, 1, 136, 1, 136, 1, 136, 1}),
                  "run lengths say 9"},
        std::pair{header("-Y 1 +X 8") + pixels({2, 2, 0, 8, 137, 1, 136, 1, 136, 1, 136, 1}),
                  "a run of 9 where 8"},
        std::pair{header("-Y 1 +X 8") + pixels({2, 2, 0, 8, 0, 1, 136, 1, 136, 1, 136, 1}),
                  "a run of 0 where 8"},
        std::pair{header("-Y 1 +X 8") + pixels({2, 2, 0, 8, 5, 1, 1, 1, 1, 1, 4, 1, 1, 1, 1}),
                  "a run of 4 where 3"},
        std::pair{header("-Y 1 +X 8") + pixels({2, 2, 0, 8, 136, 1, 136, 1, 136, 1, 136}), "the file ends"}));

class HdrFile : public FileTest {};

TEST_F(HdrFile, WrittenAndReadWithinHalfAStep) {
  for (const int width : {1, 7, 8, 300}) {
    Image image = test::samplePicture(width, 5, 3);
    if (width == 300) std::fill(image.pixels.begin() + 300, image.pixels.begin() + 1200, 0.75f);  // runs
    writeHdr(image, path("a.hdr"));
    const Image back = readImage(path("a.hdr"));
    ASSERT_EQ(back.width, width);
    ASSERT_EQ(back.height, 5);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const float* p = &image.pixels[i / 3 * 3];
      EXPECT_NEAR(back.pixels[i], image.pixels[i], std::max({p[0], p[1], p[2]}) / 255.0f);
    }
  }
}

TEST_F(HdrFile, ExactValuesStayExactAndOddOnesAreHeld) {
  Image image(4, 1, 3);
  const float inf = std::numeric_limits<float>::infinity();
  image.pixels = {1, 1, 1, 0, 0, 0, -3, std::nanf(""), 0.5f, inf, 1e-40f, 255.9999f};
  writeHdr(image, path("a.hdr"));
  const Image back = readImage(path("a.hdr"));
  const std::vector<float> first(back.pixels.begin(), back.pixels.begin() + 9);
  EXPECT_EQ(first, (std::vector<float>{1, 1, 1, 0, 0, 0, 0, 0, 0.5f}));
  EXPECT_GT(back.pixels[9], 1e38f);
  EXPECT_FALSE(firstNonFinite(back));
}

TEST_F(HdrFile, TruncatedAnywhereIsAnError) {
  writeHdr(test::samplePicture(9, 3, 3), path("a.hdr"));
  const Bytes whole = bytesOf(path("a.hdr"));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Bytes part(whole.begin(), whole.begin() + std::ptrdiff_t(length));
    const std::string error = errorOf([&] { readImage(put("b.hdr", part)); });
    EXPECT_NE(error.find("b.hdr: "), std::string::npos) << length << " of " << whole.size();
  }
}

}  // namespace
}  // namespace gloam
