// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <cmath>

#include "image/color.h"
#include "image/raster.h"
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

Bytes bigEndian(std::uint32_t value) {
  return {std::uint8_t(value >> 24), std::uint8_t(value >> 16), std::uint8_t(value >> 8),
          std::uint8_t(value)};
}

// Length, name, data and the checksum that PNG wants (CRC-32).
void addChunk(Bytes& file, const std::string& name, const Bytes& data) {
  Bytes checked(name.begin(), name.end());
  checked.insert(checked.end(), data.begin(), data.end());
  std::uint32_t crc = 0xffffffffu;
  for (const std::uint8_t byte : checked) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  for (const Bytes& part : {bigEndian(std::uint32_t(data.size())), checked, bigEndian(~crc)})
    file.insert(file.end(), part.begin(), part.end());
}

// One row, in zlib's stored form, which needs no compressor.
Bytes pngOf(std::uint32_t width, std::uint32_t height, std::uint8_t bits, const Bytes& row) {
  Bytes file{0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  Bytes header = bigEndian(width);
  for (const std::uint8_t byte : bigEndian(height)) header.push_back(byte);
  for (const int byte : {int(bits), 0, 0, 0, 0}) header.push_back(std::uint8_t(byte));
  addChunk(file, "IHDR", header);
  Bytes raw{0};  // no filter
  raw.insert(raw.end(), row.begin(), row.end());
  std::uint32_t a = 1, b = 0;  // Adler-32
  for (const std::uint8_t byte : raw) b = (b + (a = (a + byte) % 65521u)) % 65521u;
  Bytes packed{0x78, 1, 1, std::uint8_t(raw.size()), 0, std::uint8_t(~raw.size()), 0xff};
  packed.insert(packed.end(), raw.begin(), raw.end());
  for (const std::uint8_t byte : bigEndian(b << 16 | a)) packed.push_back(byte);
  addChunk(file, "IDAT", packed);
  addChunk(file, "IEND", {});
  return file;
}

TEST_F(Png, SixteenBitsAreRead) {
  const Image image = readImage(put("a.png", pngOf(2, 1, 16, {0x12, 0x34, 0xff, 0xff})));
  ASSERT_EQ(image.pixels.size(), 2u);
  EXPECT_NEAR(image.pixels[0], srgbDecode(float(0x1234) / 65535.0f), 1e-7f);
  EXPECT_EQ(image.pixels[1], 1.0f);
}

TEST_F(Png, FewBitsAreSpreadOverTheRange) {
  const Image image = readImage(put("a.png", pngOf(4, 1, 2, {0x1b})));  // 0, 1, 2, 3 of 3
  EXPECT_EQ(encodeSrgb8(image), (Bytes{0, 85, 170, 255}));
}

TEST(RasterRead, TexturesGetFourChannels) {
  const Raster grey = decodeRaster(pngOf(2, 1, 16, {0x80, 0x80, 0xff, 0xff}), "a.png");
  EXPECT_EQ(rgba8(grey), (Bytes{128, 128, 128, 255, 255, 255, 255, 255}));
  const Raster colors{.width = 1, .height = 1, .channels = 4, .bytes = {1, 2, 3, 4}};
  EXPECT_EQ(rgba8(colors), (Bytes{1, 2, 3, 4}));
  const Raster transparent{.width = 1, .height = 1, .channels = 2, .bytes = {9, 7}};
  EXPECT_EQ(rgba8(transparent), (Bytes{9, 9, 9, 7}));
  EXPECT_NE(errorOf([] { decodeRaster({}, "a"); }).find("PNG or JPEG was expected"), std::string::npos);
  const auto refuse = [](std::int64_t width, std::int64_t) { throw Error("b", std::to_string(width)); };
  EXPECT_EQ(errorOf([&] { decodeRaster(pngOf(2, 1, 8, {1, 2}), "a", refuse); }), "b: 2");
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
  const auto error = [&](std::uint32_t width, std::uint32_t height) {
    return errorOf([&] { readImage(put("b.png", pngOf(width, height, 16, {0, 0}))); });
  };
  EXPECT_NE(error(16384, 16000).find("cannot hold that many"), std::string::npos);
  EXPECT_NE(error(100000, 100000).find("at most 268435456"), std::string::npos);
  EXPECT_NE(error(0, 1), "");
  EXPECT_NE(error(0xffffffff, 1), "");
}

// The smallest baseline JPEG there is: 8 x 8, one table of each kind, one block of middle grey.
Bytes smallJpeg() {
  Bytes bytes{0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
  bytes.resize(bytes.size() + 64, 1);
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
