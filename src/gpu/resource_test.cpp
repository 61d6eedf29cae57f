// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <numeric>

#include "gpu/buffer.h"
#include "gpu/format.h"
#include "gpu/image.h"
#include "gpu/refs.h"
#include "gpu/test_device.h"

namespace gloam::gpu {
namespace {

TEST(Buffer, GivesBackWhatWasUploaded) {
  std::vector<std::uint32_t> values(1001);
  std::iota(values.begin(), values.end(), 7u);
  for (const bool host_visible : {false, true}) {
    Buffer buffer(testDevice(), "values", BufferDesc{.bytes = 4004, .host_visible = host_visible});
    buffer.upload(values);
    EXPECT_EQ(buffer.download<std::uint32_t>(), values);
    buffer.upload(std::vector<std::uint32_t>{1, 2}, 8);
    values[2] = 1;
    values[3] = 2;
    EXPECT_EQ(buffer.download<std::uint32_t>(), values);
    EXPECT_EQ(buffer.mapped() != nullptr, host_visible);
  }
}

TEST(Buffer, MayBeEmpty) {
  const Buffer buffer(testDevice(), "nothing", std::vector<float>{});
  EXPECT_TRUE(buffer);
  EXPECT_EQ(buffer.bytes(), 0u);
  EXPECT_TRUE(buffer.download<float>().empty());
}

TEST(Buffer, TooLargeATransferIsAnError) {
  Buffer buffer(testDevice(), "small", BufferDesc{.bytes = 8});
  EXPECT_EQ(errorOf([&] { buffer.upload(std::vector<float>(3)); }),
            "small: an upload of 12 bytes at 0 does not fit into its 8");
  std::vector<std::byte> bytes(8);
  EXPECT_EQ(errorOf([&] { buffer.downloadBytes(bytes, 4); }),
            "small: a read-back of 8 bytes at 4 does not fit into its 8");
  EXPECT_EQ(errorOf([&] { buffer.downloadBytes(bytes, ~std::size_t{0}); }).substr(0, 6), "small:");
}

TEST(Buffer, TooLargeForABindingIsAnErrorWithItsSize) {
  Device& device = testDevice();
  const std::uint64_t limit = device.limits().max_storage_bytes;
  if (limit >= 0xffffffffu) GTEST_SKIP() << "this device binds 4 GiB at once";
  const std::string message = errorOf(
      [&] { Buffer(device, "scene.everything", BufferDesc{.bytes = static_cast<std::size_t>(limit) + 1}); });
  EXPECT_EQ(message.substr(0, 18), "scene.everything: ");
  EXPECT_NE(message.find(std::to_string(limit + 1)), std::string::npos) << message;
}

TEST(Buffer, MoreMemoryThanThereIsIsAnError) {
  Device& device = testDevice();
  if (!device.features().buffer_device_address) GTEST_SKIP() << "this device has no buffer addresses";
  const std::string message = errorOf([&] {
    Buffer(device, "scene.everything", BufferDesc{.bytes = std::size_t{1} << 45, .by_address = true});
  });
  EXPECT_EQ(message.substr(0, 18), "scene.everything: ");
}

TEST(Buffer, MovesLeaveNothingBehind) {
  Buffer a(testDevice(), "a", std::vector<float>{1.0f});
  Buffer b = std::move(a);
  EXPECT_FALSE(a);  // NOLINT: that is the question
  a = Buffer(testDevice(), "c", std::vector<float>{2.0f});
  a = std::move(b);
  EXPECT_EQ(a.name(), "a");
  EXPECT_EQ(a.download<float>(), std::vector<float>{1.0f});
}

TEST(Image, GivesBackWhatWasUploaded) {
  for (const VkFormat format : {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16_SFLOAT,
                                VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32_UINT, VK_FORMAT_D32_SFLOAT}) {
    const auto channels = static_cast<std::size_t>(channelCount(format));
    Image image(testDevice(), "image", {.format = format, .width = 5, .height = 3, .layers = 2, .mips = 2});
    std::vector<float> first(15 * channels, 1.0f), second(15 * channels), small(2 * channels, 1.0f);
    for (std::size_t i = 0; i < second.size(); ++i) second[i] = static_cast<float>(i % 2);
    image.uploadFloats(first, 0, 0);
    image.uploadFloats(second, 0, 1);
    image.uploadFloats(small, 1, 1);
    EXPECT_EQ(image.downloadFloats(0, 0), first);
    EXPECT_EQ(image.downloadFloats(0, 1), second);
    EXPECT_EQ(image.downloadFloats(1, 1), small);
  }
}

TEST(Image, BadDescriptionsAreErrorsThatNameIt) {
  Device& device = testDevice();
  const auto error = [&](const ImageDesc& desc) { return errorOf([&] { Image(device, "picture", desc); }); };
  for (const ImageDesc& desc :
       {ImageDesc{.width = 0}, ImageDesc{.width = 1 << 20}, ImageDesc{.height = -4}, ImageDesc{.layers = 0},
        ImageDesc{.width = 4, .height = 4, .mips = 4},
        ImageDesc{.width = 4, .height = 4, .layers = 5, .cube = true},
        ImageDesc{.width = 4, .height = 2, .layers = 6, .cube = true}, ImageDesc{.depth = 2, .layers = 2},
        ImageDesc{.format = VK_FORMAT_UNDEFINED}}) {
    EXPECT_FALSE(error(desc).empty());
  }
  EXPECT_EQ(error({.width = 0}).substr(0, 9), "picture: ");
  Image image(device, "picture", {.width = 4, .height = 4});
  EXPECT_EQ(errorOf([&] { image.uploadFloats(std::vector<float>(4)); }),
            "picture: mip 0 holds 128 bytes a layer, not 8");
}

TEST(Image, MipsAreBoxesOfTheOneBefore) {
  Image image(testDevice(), "image",
              {.format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .mips = kAllMips});
  EXPECT_EQ(image.desc().mips, 3);
  std::vector<float> values(16);
  std::iota(values.begin(), values.end(), 0.0f);
  image.uploadFloats(values);
  image.generateMips();
  EXPECT_EQ(image.downloadFloats(1), (std::vector<float>{2.5f, 4.5f, 10.5f, 12.5f}));
  EXPECT_EQ(image.downloadFloats(2), std::vector<float>{7.5f});
}

TEST(Refs, PartsStayInside) {
  const Image image(testDevice(), "image",
                    {.format = VK_FORMAT_R32_SFLOAT, .width = 8, .height = 4, .layers = 3, .mips = 3});
  const ImageRef part = ImageRef(image).layers(1, 2).mip(2);
  EXPECT_EQ(part.width(), 2);
  EXPECT_EQ(part.height(), 1);
  EXPECT_EQ(part.layer(1).range(), (ImageRange{2, 1, 2, 1}));
  EXPECT_EQ(errorOf([&] { part.layer(2); }), "image: layer 2 is not one of its 2");
  EXPECT_FALSE(errorOf([&] { part.mip(1); }).empty());
  const Buffer buffer(testDevice(), "buffer", std::vector<float>(4));
  EXPECT_EQ(BufferRef(buffer).slice(4, 8).slice(4, 4).offset(), 8u);
  EXPECT_EQ(errorOf([&] { BufferRef(buffer).slice(8, 12); }), "buffer: bytes 8 to 20 are not inside its 16");
}

}  // namespace
}  // namespace gloam::gpu
