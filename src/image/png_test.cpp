// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <cmath>

#include "image/color.h"
#include "image/test_files.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

using test::Bytes;
using test::errorOf;

class Png : public test::FileTest {};

TEST_F(Png, EightBitsSurviveInAllChannelCounts) {
  for (int channels = 1; channels <= 4; ++channels) {
    Image image(16, 16, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const bool alpha = (channels == 2 || channels == 4) && int(i % std::size_t(channels)) == channels - 1;
      const float code = float(i * 7 % 256) / 255.0f;
      image.pixels[i] = alpha ? code : srgbDecode(code);
    }
    writePng(image, path("a.png"));
    const Image back = readImage(path("a.png"));
    ASSERT_EQ(back.channels, channels);
    EXPECT_EQ(encodeSrgb8(back), encodeSrgb8(image));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) EXPECT_NEAR(back.pixels[i], image.pixels[i], 1e-6f);
  }
}

TEST_F(Png, RowsRunFromTheTop) {
  Image image(1, 2, 3);
  image.at(0, 1)[0] = 1.0f;
  writePng(image, path("a.png"));
  EXPECT_EQ(readImage(path("a.png")).pixels, (std::vector<float>{0, 0, 0, 1, 0, 0}));
}

TEST_F(Png, ValuesOutsideAreClamped) {
  Image image(4, 1, 1);
  image.pixels = {-1.0f, 2.0f, std::nanf(""), std::numeric_limits<float>::infinity()};
  EXPECT_EQ(encodeSrgb8(image), (Bytes{0, 255, 0, 255}));
}

TEST(Srgb, AgreesWithTheStandardAndItsInverse) {
  EXPECT_NEAR(srgbDecode(0.5f), 0.21404114f, 1e-6f);
  EXPECT_NEAR(srgbEncode(0.18f), 0.46135613f, 1e-6f);
  for (int i = 0; i <= 255; ++i)
    EXPECT_NEAR(srgbEncode(srgbDecode(float(i) / 255.0f)), float(i) / 255.0f, 2e-6f);
}

// A 2 x 1 picture with 16 bits a channel: zlib's stored form needs no compressor.
TEST_F(Png, SixteenBitsAreRead) {
  const Bytes bytes{0x89, 'P',  'N',  'G', 13,   10,   26,   10,   0,    0,    0,    13,   'I', 'H', 'D',
                    'R',  0,    0,    0,   2,    0,    0,    0,    1,    16,   0,    0,    0,   0,   0,
                    0,    0,    0,    0,   0,    0,    16,   'I',  'D',  'A',  'T',  0x78, 1,   1,   5,
                    0,    0xfa, 0xff, 0,   0x12, 0x34, 0xff, 0xff, 0x03, 0xc9, 0x02, 0x45, 0,   0,   0,
                    0,    0,    0,    0,   0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};
  const Image image = readImage(put("a.png", bytes));
  ASSERT_EQ(image.pixels.size(), 2u);
  EXPECT_NEAR(image.pixels[0], srgbDecode(float(0x1234) / 65535.0f), 1e-7f);
  EXPECT_EQ(image.pixels[1], 1.0f);
}

TEST_F(Png, TruncatedAnywhereIsAnError) {
  writePng(test::samplePicture(5, 4, 3), path("a.png"));
  const Bytes whole = bytesOf(path("a.png"));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Bytes part(whole.begin(), whole.begin() + std::ptrdiff_t(length));
    EXPECT_NE(errorOf([&] { readImage(put("b.png", part)); }), "") << length << " of " << whole.size();
  }
}

TEST_F(Png, FlippedBytesNeverCrash) {
  writePng(test::samplePicture(5, 4, 3), path("a.png"));
  const Bytes whole = bytesOf(path("a.png"));
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int value : {0x00, 0x7f, 0x80, 0xff}) {
      Bytes damaged = whole;
      damaged[at] = std::uint8_t(value);
      errorOf([&] { readImage(put("b.png", damaged)); });
    }
}

TEST_F(Png, SizesThatTheFileCannotHoldAreRefused) {
  writePng(test::samplePicture(5, 4, 3), path("a.png"));
  Bytes bytes = bytesOf(path("a.png"));
  bytes[16 + 2] = 0x40;  // width 16389
  bytes[20 + 2] = 0x3f;  // height 16132
  EXPECT_NE(errorOf([&] { readImage(put("b.png", bytes)); }).find("cannot hold that many"),
            std::string::npos);
}

// The smallest baseline JPEG there is: 8 x 8, one table of each kind, one block of middle grey.
Bytes smallJpeg() {
  Bytes bytes{0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
  bytes.insert(bytes.end(), 64, 1);
  const Bytes rest{
      0xff, 0xc0, 0,   11, 8,    0, 8, 0, 8,  1, 1, 0x11, 0,                             // frame
      0xff, 0xc4, 0,   20, 0,    1, 0, 0, 0,  0, 0, 0,    0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  // DC table
      0xff, 0xc4, 0,   20, 0x10, 1, 0, 0, 0,  0, 0, 0,    0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  // AC table
      0xff, 0xda, 0,   8,  1,    1, 0, 0, 63, 0,                                         // scan
      0x3f, 0xff, 0xd9};
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

TEST_F(Png, JpegIsReadAndItsTruncationsAreErrors) {
  const Bytes whole = smallJpeg();
  const Image image = readImage(put("a.jpg", whole));
  ASSERT_EQ(image.width, 8);
  ASSERT_EQ(image.channels, 1);
  for (const float value : image.pixels) EXPECT_NEAR(value, srgbDecode(128.0f / 255.0f), 1e-6f);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Bytes part(whole.begin(), whole.begin() + std::ptrdiff_t(length));
    EXPECT_NE(errorOf([&] { readImage(put("b.jpg", part)); }), "") << length << " of " << whole.size();
  }
}

}  // namespace
}  // namespace gloam
