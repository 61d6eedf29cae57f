// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numeric>

#include "image/exr_samples.h"
#include "image/formats.h"
#include "image/test_files.h"

namespace gloam {
namespace {

using test::Bytes;
using test::errorOf;
using test::ExrSample;
using test::sampleValue;
namespace fs = std::filesystem;

class Exr : public test::FileTest {};

TEST_F(Exr, PicturesSurviveInAllChannelCountsAndTypes) {
  for (int channels = 1; channels <= 4; ++channels)
    for (const ChannelType type : {ChannelType::kHalf, ChannelType::kFloat}) {
      const Image image = test::samplePicture(17, 33, channels);
      writeExr(image, path("a.exr"), type);
      const Image back = readImage(path("a.exr"));
      EXPECT_EQ(back.width, 17);
      EXPECT_EQ(back.height, 33);
      EXPECT_EQ(back.channels, channels);
      EXPECT_EQ(back.pixels, image.pixels);
    }
}

TEST_F(Exr, FloatsKeepEveryBitAndHalfsAreHeldInRange) {
  Image image(4, 1, 1);
  const float inf = std::numeric_limits<float>::infinity();
  image.pixels = {0.1f, 1e30f, -inf, std::nanf("")};
  writeExr(image, path("a.exr"), ChannelType::kFloat);
  Image back = readImage(path("a.exr"));
  EXPECT_EQ(back.pixels[0], 0.1f);
  EXPECT_EQ(back.pixels[1], 1e30f);
  EXPECT_EQ(back.pixels[2], -inf);
  EXPECT_TRUE(std::isnan(back.pixels[3]));
  const auto place = firstNonFinite(back);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x, 2);
  EXPECT_EQ(place->value, -inf);
  writeExr(image, path("a.exr"), ChannelType::kHalf);
  back = readImage(path("a.exr"));
  EXPECT_EQ(back.pixels[1], 65504.0f);
  EXPECT_EQ(back.pixels[2], -65504.0f);
  EXPECT_TRUE(std::isnan(back.pixels[3]));
}

TEST_F(Exr, LayersOfARenderSurvive) {
  LayeredImage render;
  const Image sum = test::samplePicture(5, 3, 4), direct = test::samplePicture(5, 3, 3);
  Image depth(5, 3, 1);
  std::iota(depth.pixels.begin(), depth.pixels.end(), 100000.125f);
  std::vector<std::uint32_t> ids(15);
  std::iota(ids.begin(), ids.end(), 0xfffffff0u);
  render.add("", {"R", "G", "B", "A"}, sum);
  render.add("direct", {"R", "G", "B"}, direct);
  render.add("normal", {"X", "Y", "Z"}, direct);
  render.add("depth", {"Z"}, depth, ChannelType::kFloat);
  render.addIds("object", "id", ids);
  writeExr(render, path("a.exr"));

  const LayeredImage back = readExr(path("a.exr"));
  EXPECT_EQ(back.width, 5);
  EXPECT_EQ(back.height, 3);
  EXPECT_EQ(back.layers.size(), 5u);
  EXPECT_EQ(back.image("", {"R", "G", "B", "A"}, "a").pixels, sum.pixels);
  EXPECT_EQ(back.image("direct", {"R", "G", "B"}, "a").pixels, direct.pixels);
  EXPECT_EQ(back.image("normal", {"X", "Y", "Z"}, "a").pixels, direct.pixels);
  EXPECT_EQ(back.image("depth", {"Z"}, "a").pixels, depth.pixels);
  ASSERT_TRUE(back.find("object"));
  EXPECT_EQ(back.find("object")->type, ChannelType::kUint);
  EXPECT_EQ(back.find("object")->ids, ids);
  EXPECT_EQ(back.find("depth")->type, ChannelType::kFloat);
  EXPECT_EQ(back.find("normal")->type, ChannelType::kHalf);
  EXPECT_EQ(back.find("nothing"), nullptr);
  EXPECT_EQ(back.find("")->channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(readImage(path("a.exr")).pixels, sum.pixels) << "the picture is the sum";
  EXPECT_NE(errorOf([&] { back.image("direct", {"A"}, "a.exr"); }).find("a.exr: channel direct.A is missing"),
            std::string::npos);
}

TEST_F(Exr, AttributesTravelAlong) {
  LayeredImage image;
  image.add("", {"R", "G", "B"}, test::samplePicture(3, 2, 3));
  image.attributes = {{"gloam.bounces", "1"},
                      {"empty", ""},
                      {"a name of more than thirty-one characters", "x"},
                      {"lines", std::string("a\nb\x1b[31m\0c", 9)}};
  writeExr(image, path("a.exr"));
  EXPECT_EQ(readExr(path("a.exr")).attributes, image.attributes);
  EXPECT_EQ(readImage(path("a.exr")).pixels, image.layers[0].pixels);

  // What the format calls so, and what would not come back, is not written.
  const auto refused = [&](const std::string& name, const std::string& value) {
    LayeredImage other = image;
    other.attributes[name] = value;
    return errorOf([&] { writeExr(other, path("b.exr")); });
  };
  for (const char* name : {"channels", "compression", "dataWindow", "chromaticities", "type", "tiles", ""})
    EXPECT_NE(refused(name, "x").find("taken"), std::string::npos) << name;
  EXPECT_NE(refused(std::string(256, 'n'), "x").find("too long"), std::string::npos);
  EXPECT_NE(refused("long", std::string(4097, 'x')).find("4097 bytes"), std::string::npos);
  EXPECT_EQ(refused("long", std::string(4096, 'x')), "");
  for (int i = 0; i < 300; ++i) image.attributes["n" + std::to_string(i)] = "x";
  EXPECT_NE(errorOf([&] { writeExr(image, path("c.exr")); }).find("304 attributes"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("c.exr")));
}

TEST_F(Exr, AttributesOfOthersAreHeldInBounds) {
  ExrSample sample;
  sample.attributes = {{"owner", "someone"}, {"long", std::string(100000, 'x')}};
  for (int i = 0; i < 400; ++i) sample.attributes["z" + std::to_string(i)] = "x";
  test::writeSample(sample, path("a.exr"));
  const auto attributes = readExr(path("a.exr")).attributes;
  EXPECT_EQ(attributes.at("owner"), "someone");
  EXPECT_EQ(attributes.count("long"), 0u);
  EXPECT_EQ(attributes.size(), 256u);
  // The first flat part's, without its own name and type.
  sample.attributes = {{"owner", "someone"}};
  test::writeSeveralParts(sample, path("b.exr"));
  EXPECT_EQ(readExr(path("b.exr")).attributes, sample.attributes);
}

TEST_F(Exr, EveryCompressionIsRead) {
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
    for (const char* type : {"half", "float"})
      for (const int tile : {0, 8}) {
        const ExrSample sample{.width = 19,
                               .height = 40,
                               .compression = Imf::Compression(compression),
                               .type = type,
                               .tile = tile};
        test::writeSample(sample, path("a.exr"));
        const Image image = readImage(path("a.exr"));
        ASSERT_EQ(image.channels, 3);
        const float tolerance = compression >= Imf::B44_COMPRESSION ? 2.0f : 0.0f;  // lossy
        for (int y = 0; y < 40; ++y)
          for (int x = 0; x < 19; ++x)
            for (int c = 0; c < 3; ++c)
              ASSERT_NEAR(image.at(x, y)[c], sampleValue(c, x, y), tolerance) << compression << type << tile;
      }
}

TEST_F(Exr, ThePictureIsTheDisplayWindow) {
  // Data from (-2, 3), 9 x 7; shown from (0, 0), 4 x 12: cut off at the left and right, empty above and below.
  ExrSample sample{.data_x = -2, .data_y = 3, .display_width = 4, .display_height = 12};
  test::writeSample(sample, path("a.exr"));
  const Image image = readImage(path("a.exr"));
  ASSERT_EQ(image.width, 4);
  ASSERT_EQ(image.height, 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 4; ++x) {
      const bool inside = y >= 3 && y < 10;
      EXPECT_EQ(image.at(x, y)[1], inside ? sampleValue(1, x + 2, y - 3) : 0.0f) << x << ", " << y;
    }
  EXPECT_EQ(readExr(path("a.exr")).width, 4);
  sample.display_x = 100;
  test::writeSample(sample, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("do not overlap"), std::string::npos);
  sample.display_x = 0;
  sample.display_width = sample.display_height = 16000;
  test::writeSample(sample, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("out of proportion"), std::string::npos);
}

TEST_F(Exr, TheFirstFlatPartOfSeveralIsRead) {
  test::writeSeveralParts({}, path("a.exr"));
  const Image image = readImage(path("a.exr"));
  ASSERT_EQ(image.width, 9);
  EXPECT_EQ(image.at(3, 2)[2], sampleValue(2, 3, 2));
}

TEST_F(Exr, OtherChannelsAreUnderstoodOrNamed) {
  test::writeSample({.channels = {"Y"}}, path("a.exr"));
  EXPECT_EQ(readImage(path("a.exr")).channels, 1);
  test::writeSample({.channels = {"A", "Y"}}, path("a.exr"));
  const Image grey = readImage(path("a.exr"));
  ASSERT_EQ(grey.channels, 2);
  EXPECT_EQ(grey.at(1, 1)[0], sampleValue(1, 1, 1)) << "luminance stands first";
  test::writeSample({.channels = {"R", "G", "B"}, .type = "uint"}, path("a.exr"));
  EXPECT_EQ(readImage(path("a.exr")).at(4, 5)[2], sampleValue(2, 4, 5));
  test::writeSample({.channels = {"R", "B"}}, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("channel G is missing; the file has B, R"),
            std::string::npos);
  test::writeSample({.channels = {"view.R", "view.G", "view.B"}}, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("channel R is missing"), std::string::npos);
  EXPECT_EQ(readExr(path("a.exr")).image("view", {"G"}, "").at(2, 2)[0], sampleValue(1, 2, 2));
  test::writeSample({.channels = {"BY", "RY", "Y"}}, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("luminance and chroma"), std::string::npos);
}

TEST_F(Exr, DeepAndSubsampledAreRefused) {
  test::writeDeep(path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("deep"), std::string::npos);
  test::writeSample({.width = 8, .height = 8, .channels = {"R", "G", "B"}, .sampling = 2}, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("channel B is subsampled"), std::string::npos);
  EXPECT_NE(errorOf([&] { readExr(path("a.exr")); }).find("channel B is subsampled"), std::string::npos);
}

TEST_F(Exr, OtherPrimariesAreConverted) {
  // ACES AP0: white stays white, and a colour within Rec. 709 comes back after being taken there.
  const Imf::Chromaticities ap0({0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});
  ExrSample sample{.chromaticities = ap0};
  test::writeSample(sample, path("a.exr"));
  const Image stored = readExr(path("a.exr")).image("", {"R", "G", "B"}, ""),
              image = readImage(path("a.exr"));
  // Published AP0 to linear sRGB (Bradford), row of red: 2.5217, -1.1341, -0.3876.
  const float* s = stored.at(2, 3);
  EXPECT_NEAR(image.at(2, 3)[0], 2.5217f * s[0] - 1.1341f * s[1] - 0.3876f * s[2], 0.02f);
  sample.chromaticities = Imf::Chromaticities();  // Rec. 709 with the library's D65
  test::writeSample(sample, path("a.exr"));
  EXPECT_EQ(readImage(path("a.exr")).at(2, 3)[0], sampleValue(0, 2, 3));
  sample.chromaticities = Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0});
  test::writeSample(sample, path("a.exr"));
  EXPECT_NE(errorOf([&] { readImage(path("a.exr")); }).find("chromaticities"), std::string::npos);
}

TEST_F(Exr, WhatIsNoPictureIsNotWritten) {
  EXPECT_THROW(writeExr(Image(), path("a.exr")), Error);
  LayeredImage layers;
  EXPECT_THROW(writeExr(layers, path("a.exr")), Error);
  layers.add("a", {"R"}, Image(2, 2, 1));
  EXPECT_THROW(layers.add("b", {"R"}, Image(2, 3, 1)), Error);
  EXPECT_THROW(layers.add("b", {"R"}, Image(2, 2, 2)), Error);
  EXPECT_THROW(layers.addIds("b", "id", {1, 2, 3}), Error);
  layers.add("a", {"R"}, Image(2, 2, 1));
  EXPECT_NE(errorOf([&] { writeExr(layers, path("a.exr")); }).find("stands twice"), std::string::npos);
  EXPECT_EQ(filesInFolder(), 0u);
}

// Real light probes, DWAB-compressed, where blender-data is installed.
TEST_F(Exr, RealProbesAreRead) {
  const fs::path folder = "/usr/share/blender/datafiles/studiolights/world";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "blender-data is not installed";
  int probes = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".exr") continue;
    const Image probe = readImage(entry.path());
    EXPECT_EQ(probe.width, 2 * probe.height) << entry.path();
    EXPECT_GE(probe.channels, 3);
    EXPECT_FALSE(firstNonFinite(probe)) << entry.path();
    double sum = 0.0;
    for (const float value : probe.pixels) sum += value;
    EXPECT_GT(sum, 0.0);
    ++probes;
  }
  EXPECT_GT(probes, 0);
}

}  // namespace
}  // namespace gloam
