// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The validation layer checks synchronisation in all of these tests: a missing barrier is a message, and a message fails.
#include "gpu/frame_graph.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "gpu/test_device.h"
#include "gpu/test_shaders/gpu_test_shared.h"
#include "shaders/gpu_test_shaders.h"

namespace gloam::gpu {
namespace {

using gpu_test::CountParams;
using gpu_test::FillParams;
using gpu_test::Record;

constexpr ImageDesc kFloats{.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 19, .height = 13};

TEST(FrameGraph, StructsArriveAsTheyWere) {
  std::vector<Record> records(2);
  const auto fill = [](Record& r, float seed) {
    r.position.z = seed;
    r.uv.y = seed + 1;
    r.frame[2].z = seed + 2;
    r.inner[1].radius = seed + 3;
    r.inner[1].ids.y = static_cast<std::uint32_t>(seed) + 4;
    r.flags = static_cast<std::uint32_t>(seed) + 5;
    r.world_from_object[3].w = 0.25f;
    return r.position.z + 10 * r.uv.y + 100 * r.frame[2].z + 1000 * r.inner[1].radius +
           10000 * static_cast<float>(r.inner[1].ids.y) + 100000 * static_cast<float>(r.flags) + 0.25f;
  };
  const float first = fill(records[0], 1), second = fill(records[1], 2);
  FrameGraph graph(testDevice());
  graph.begin();
  const auto result = graph.create("test.result", BufferDesc{.bytes = 12});
  graph.compute("test.layout", gpu_layout_spv)
      .read("Records", graph.upload("test.records", records))
      .read("uniform_record", graph.uploadOne("test.one", records[1]))
      .write("result", result)
      .dispatch(1);
  graph.execute();
  EXPECT_EQ(result.buffer().download<float>(), (std::vector<float>{first, second, second}));
}

/// fill -> gather -> add -> add -> copy: image to buffer to itself twice to another.
void recordChain(FrameGraph& graph, float offset) {
  const auto image = graph.create("test.image", kFloats);
  const auto sums = graph.create("test.sums", BufferDesc{.bytes = 19 * 13 * 4});
  const auto copied = graph.create("test.copied", BufferDesc{.bytes = 19 * 13 * 4});
  graph.compute("test.fill", gpu_fill_spv)
      .write("target", image)
      .push(FillParams{{1.0f, 100.0f}, offset})
      .dispatchOver(image);
  graph.compute("test.gather", gpu_gather_spv).read("source", image).write("Sums", sums).dispatchOver(image);
  for (const std::uint32_t add : {1u, 2u}) {
    graph.compute("test.add", gpu_add_spv)
        .readWrite("Values", sums)
        .push(CountParams{19 * 13, add})
        .dispatchOver(19 * 13);
  }
  graph.copy("test.copy", sums, copied);
}

float expectedOfChain(int x, int y, float offset) {
  const float sum = (static_cast<float>(x) + offset) + (100.0f * static_cast<float>(y) + offset);
  return (sum * 2.0f + 1.0f) * 2.0f + 2.0f;
}

TEST(FrameGraph, PassesSeeWhatThoseBeforeThemWrote) {
  FrameGraph graph(testDevice());
  for (int frame = 0; frame < 4; ++frame) {
    const auto offset = static_cast<float>(frame);
    graph.begin();
    recordChain(graph, offset);
    graph.execute();
    const auto values = graph.findBuffer("test.copied").buffer().download<float>();
    for (int y = 0; y < 13; ++y) {
      for (int x = 0; x < 19; ++x) {
        ASSERT_EQ(values[static_cast<std::size_t>(y * 19 + x)], expectedOfChain(x, y, offset))
            << x << " " << y;
      }
    }
  }
}

TEST(FrameGraph, FramesInFlightDoNotMix) {
  FrameGraph graph(testDevice());
  const Buffer total(testDevice(), "total", std::vector<float>(64, 0.0f));
  for (std::uint32_t frame = 0; frame < 8; ++frame) {
    graph.begin();
    // Uploads of consecutive frames lie in different memory: nobody waits between the frames.
    const auto params = graph.upload("test.values", std::vector<float>(64, static_cast<float>(frame)));
    graph.copy("test.copy", params, total);
    graph.compute("test.add", gpu_add_spv)
        .readWrite("Values", total)
        .push(CountParams{64, frame})
        .dispatchOver(64);
    graph.execute();
  }
  graph.wait();
  EXPECT_EQ(total.download<float>(), std::vector<float>(64, 7.0f * 2.0f + 7.0f));
}

TEST(FrameGraph, TransientResourcesArePooledByNameAndDescription) {
  FrameGraph graph(testDevice());
  const auto frame = [&](const ImageDesc& desc) {
    graph.begin();
    const auto image = graph.create("test.image", desc);
    graph.clear("test.clear", image);
    graph.execute();
    return image.image().handle();
  };
  const VkImage first = frame(kFloats);
  EXPECT_EQ(frame(kFloats), first);
  ImageDesc larger = kFloats;
  larger.width = 64;
  frame(larger);
  EXPECT_EQ(graph.find("test.image").width(), 64);
  const auto with_image = graph.memoryBytes();
  for (int i = 0; i < 20; ++i) {
    graph.begin();
    graph.execute();
  }
  EXPECT_LT(graph.memoryBytes(), with_image);
  EXPECT_FALSE(graph.find("test.image"));
}

TEST(FrameGraph, ImagesAreFoundByNameAfterTheFrame) {
  FrameGraph graph(testDevice());
  const Image elsewhere(testDevice(), "elsewhere", kFloats);
  graph.begin();
  recordChain(graph, 0.0f);
  graph.import("frame.elsewhere", elsewhere);
  graph.execute();
  EXPECT_EQ(graph.imageNames(), (std::vector<std::string>{"frame.elsewhere", "test.image"}));
  EXPECT_EQ(graph.find("test.image").image().downloadFloats()[4 * (19 * 2 + 3) + 2], 203.0f);
  EXPECT_FALSE(graph.find("test.nothing"));
}

TEST(FrameGraph, HistoryIsZeroAtFirstAndThenTheLastFrame) {
  FrameGraph graph(testDevice());
  const ImageDesc desc{.format = VK_FORMAT_R32_SFLOAT, .width = 9, .height = 5};
  const auto frame = [&](bool write) {
    graph.begin();
    const auto history = graph.history("test.history", desc);
    if (write) {
      graph.compute("test.previous", gpu_previous_spv)
          .read("previous", history.previous)
          .write("current", history.current)
          .dispatchOver(history.current);
    }
    graph.execute();
    return (write ? history.current : history.previous).image().downloadFloats();
  };
  EXPECT_EQ(frame(true), std::vector<float>(45, 1.0f));
  EXPECT_EQ(frame(true), std::vector<float>(45, 2.0f));
  EXPECT_EQ(frame(false), std::vector<float>(45, 2.0f));  // a frame that writes nothing leaves the past alone
  EXPECT_EQ(frame(true), std::vector<float>(45, 3.0f));
  graph.resetHistory();
  EXPECT_EQ(frame(true), std::vector<float>(45, 1.0f));
}

TEST(FrameGraph, BufferHistoryToo) {
  FrameGraph graph(testDevice());
  for (int i = 1; i <= 3; ++i) {
    graph.begin();
    const auto history = graph.history("test.history", BufferDesc{.bytes = 256});
    graph.copy("test.copy", history.previous, history.current);
    graph.compute("test.add", gpu_add_spv)
        .readWrite("Values", history.current)
        .push(CountParams{64, 1})
        .dispatchOver(64);
    graph.execute();
    const auto expected = static_cast<float>((1 << i) - 1);
    EXPECT_EQ(history.current.buffer().download<float>(), std::vector<float>(64, expected));
  }
}

/// Fills the kept image where it does not hold; what it then contains at its first texel.
float drawKept(FrameGraph& graph, const std::string& key, float offset, const ImageDesc& desc = kFloats) {
  graph.begin();
  const KeptImage kept = graph.keep("test.kept", desc, key);
  const FillParams fill{{1.0f, 100.0f}, offset};
  if (!kept.holds)
    graph.compute("test.fill", gpu_fill_spv).write("target", kept.image).push(fill).dispatchOver(kept.image);
  const auto sums = graph.create("test.sums", BufferDesc{.bytes = 19 * 13 * 4});
  graph.compute("test.gather", gpu_gather_spv).read("source", kept.image).write("Sums", sums).dispatch(1);
  graph.execute();
  return graph.find("test.kept").image().downloadFloats()[0];
}

TEST(FrameGraph, KeptImagesHoldAsLongAsTheirKeyStays) {
  FrameGraph graph(testDevice());
  EXPECT_EQ(drawKept(graph, "a", 1.0f), 1.0f);
  EXPECT_EQ(drawKept(graph, "a", 2.0f), 2.0f);  // nothing holds before setKeeps()
  graph.setKeeps(true);
  EXPECT_EQ(drawKept(graph, "a", 3.0f), 2.0f);
  EXPECT_EQ(drawKept(graph, "b", 4.0f), 4.0f);
  EXPECT_EQ(drawKept(graph, "", 5.0f), 5.0f);
  EXPECT_EQ(drawKept(graph, "", 6.0f), 6.0f);
  // Small sizes stand side by side.
  ImageDesc small = kFloats;
  small.width = 5;
  EXPECT_EQ(drawKept(graph, "c", 7.0f), 7.0f);
  EXPECT_EQ(drawKept(graph, "c", 8.0f, small), 8.0f);
  EXPECT_EQ(drawKept(graph, "c", 9.0f), 7.0f);
  EXPECT_EQ(drawKept(graph, "c", 9.0f, small), 8.0f);
  for (int i = 0; i < 20; ++i) drawKept(graph, "c", 0.0f, small);
  EXPECT_EQ(drawKept(graph, "c", 10.0f), 10.0f);  // nobody asked for it for long
  graph.setKeeps(false);
  EXPECT_EQ(drawKept(graph, "c", 11.0f), 11.0f);
}

TEST(FrameGraph, WhatAFrameDidNotWriteIsNotKept) {
  FrameGraph graph(testDevice());
  graph.setKeeps(true);
  graph.begin();
  EXPECT_FALSE(graph.keep("test.kept", kFloats, "a").holds);
  graph.execute();  // nothing wrote it
  EXPECT_EQ(drawKept(graph, "a", 1.0f), 1.0f);
  graph.begin();
  graph.keep("test.kept", kFloats, "b");  // and this frame never runs
  EXPECT_EQ(drawKept(graph, "b", 2.0f), 2.0f);
  EXPECT_EQ(drawKept(graph, "b", 3.0f), 2.0f);
}

TEST(FrameGraph, HostPassesRunBetweenGpuPasses) {
  for (const bool host_visible : {false, true}) {
    FrameGraph graph(testDevice());
    graph.setTimed(true);
    graph.begin();
    const auto values = graph.create("test.values", BufferDesc{.bytes = 256, .host_visible = host_visible});
    graph.clear("test.clear", values);
    graph.compute("test.add", gpu_add_spv)
        .readWrite("Values", values)
        .push(CountParams{64, 3})
        .dispatchOver(64);
    graph.host("test.host").read(values).write(values).run([&](HostAccess& host) {
      auto seen = host.download<float>(values);
      EXPECT_EQ(seen, std::vector<float>(64, 3.0f));
      std::iota(seen.begin(), seen.end(), 0.0f);
      if (host_visible) {
        const auto mapped = host.map<float>(values);
        std::copy(seen.begin(), seen.end(), mapped.begin());
      } else {
        host.upload(values, std::span<const float>(seen));
      }
    });
    graph.compute("test.add_again", gpu_add_spv)
        .readWrite("Values", values)
        .push(CountParams{64, 1})
        .dispatchOver(64);
    graph.execute();
    const auto result = values.buffer().download<float>();
    for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(result[i], 2.0f * static_cast<float>(i) + 1.0f);
    std::vector<std::string> names;
    for (const auto& time : graph.times()) names.push_back(time.name);
    EXPECT_EQ(names, (std::vector<std::string>{"test.clear", "test.add", "test.host", "test.add_again"}));
  }
}

TEST(FrameGraph, HostPassesTouchOnlyWhatTheyDeclared) {
  FrameGraph graph(testDevice());
  graph.begin();
  const auto image = graph.create("test.image", kFloats);
  const auto values = graph.create("test.values", BufferDesc{.bytes = 256});
  graph.clear("test.clear", values);
  graph.host("test.host").read(values).write(image).run([&](HostAccess& host) {
    host.uploadFloats(image, std::vector<float>(19 * 13 * 4, 0.5f));
    EXPECT_EQ(errorOf([&] { host.upload(values, std::span<const float>{}); }),
              "pass 'test.host': writes 'test.values' without having declared it");
    EXPECT_EQ(errorOf([&] { host.map<float>(values); }),
              "pass 'test.host': maps 'test.values', which is not host_visible");
    throw Interrupted("enough");
  });
  EXPECT_THROW(graph.execute(), Interrupted);
  // A frame that broke off does not harm the next.
  graph.begin();
  recordChain(graph, 0.0f);
  graph.execute();
  EXPECT_EQ(graph.findBuffer("test.copied").buffer().download<float>()[1], expectedOfChain(1, 0, 0.0f));
}

TEST(FrameGraph, IndirectDispatchTakesItsGroupsFromABuffer) {
  FrameGraph graph(testDevice());
  graph.begin();
  const auto arguments = graph.create("test.arguments", BufferDesc{.bytes = 12});
  const auto counter = graph.create("test.counter", BufferDesc{.bytes = 4});
  graph.clear("test.clear", counter);
  graph.compute("test.arguments", gpu_arguments_spv)
      .write("arguments", arguments)
      .push(CountParams{.count = 5})
      .dispatch(1);
  graph.compute("test.count", gpu_count_spv).readWrite("counter", counter).dispatchIndirect(arguments);
  graph.execute();
  EXPECT_EQ(counter.buffer().download<std::uint32_t>()[0], 5u * gpu_test::kGroupSize);
}

TEST(FrameGraph, MipsOfOneImageAreReadAndWrittenInTurn) {
  FrameGraph graph(testDevice());
  graph.begin();
  const auto image =
      graph.create("test.pyramid",
                   ImageDesc{.format = VK_FORMAT_R32G32_SFLOAT, .width = 16, .height = 16, .mips = kAllMips});
  std::vector<float> values(16 * 16 * 2);
  for (std::size_t i = 0; i < 256; ++i) values[2 * i] = values[2 * i + 1] = static_cast<float>(i * 37 % 256);
  graph.host("test.base").write(image.mip(0)).run([&](HostAccess& host) {
    host.uploadFloats(image.mip(0), values);
  });
  for (int mip = 1; mip < image.image().desc().mips; ++mip) {
    graph.compute("test.pyramid", gpu_pyramid_spv)
        .read("finer", image.mip(mip - 1))
        .sampler("nearest", kNearestClamp)
        .write("coarser", image.mip(mip))
        .dispatchOver(image.mip(mip));
  }
  graph.execute();
  EXPECT_EQ(image.image().downloadFloats(4), (std::vector<float>{0.0f, 255.0f}));
  const auto second = image.image().downloadFloats(1);
  EXPECT_EQ(second[0], std::min({values[0], values[2], values[32], values[34]}));
}

TEST(FrameGraph, CubesVolumesShadowArraysAndIntegersCanBeSampled) {
  FrameGraph graph(testDevice());
  graph.begin();
  const auto cube = graph.create("test.cube", ImageDesc{.width = 4, .height = 4, .layers = 6, .cube = true});
  for (int face = 0; face < 6; ++face) {
    graph.clear("test.face", cube.layer(face), {static_cast<float>(face), 0, 0, 0});
  }
  const auto volume = graph.create(
      "test.volume", ImageDesc{.format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .depth = 8});
  graph.compute("test.volume", gpu_volume_spv).write("volume", volume).dispatchOver(volume);
  const auto shadow = graph.create(
      "test.shadow", ImageDesc{.format = VK_FORMAT_D32_SFLOAT, .width = 4, .height = 4, .layers = 2});
  graph.clear("test.near", shadow.layer(0), {0.25f, 0, 0, 0});
  graph.clear("test.far", shadow.layer(1), {0.75f, 0, 0, 0});
  const auto ids = graph.create("test.ids", ImageDesc{.format = VK_FORMAT_R32_UINT});
  graph.clear("test.ids", ids, ClearColor::uints(4000000000u));
  const auto result = graph.create("test.result", BufferDesc{.bytes = 40});
  graph.compute("test.shapes", gpu_shapes_spv)
      .sample("cube", cube)
      .sample("volume", volume)
      .sample("shadow", shadow, kShadowLessOrEqual)
      .read("ids", ids)
      .write("result", result)
      .dispatch(1);
  graph.execute();
  EXPECT_EQ(result.buffer().download<float>(),
            (std::vector<float>{0, 1, 2, 3, 4, 5, 3.5f, 0, 1, 4000000000.0f}));
}

TEST(FrameGraph, MemoryCanBeReachedByAddress) {
  Device& device = testDevice();
  if (!device.features().buffer_device_address) GTEST_SKIP() << "this device has no buffer addresses";
  FrameGraph graph(device);
  graph.begin();
  const auto a = graph.create("test.a", BufferDesc{.bytes = 400});
  const auto b = graph.create("test.b", BufferDesc{.bytes = 400});
  graph.clear("test.clear", a);
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
    struct {
      std::uint32_t words[5];
    } push{};
    const std::uint64_t addresses[2] = {from.buffer().address(), to.buffer().address()};
    std::memcpy(push.words, addresses, sizeof addresses);
    push.words[4] = 100;
    graph.compute("test.address", gpu_address_spv)
        .readByAddress(from)
        .writeByAddress(to)
        .push(push)
        .dispatchOver(100);
  }
  graph.execute();
  EXPECT_EQ(a.buffer().download<float>(), std::vector<float>(100, 1.0f));
}

TEST(FrameGraph, CopiesScaleWhereSizesDiffer) {
  FrameGraph graph(testDevice());
  graph.begin();
  const auto large =
      graph.create("test.large", ImageDesc{.format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 2});
  const auto small =
      graph.create("test.small", ImageDesc{.format = VK_FORMAT_R16_SFLOAT, .width = 2, .height = 1});
  const auto same = graph.create("test.same", large.image().desc());
  graph.host("test.host").write(large).run([&](HostAccess& host) {
    host.uploadFloats(large, std::vector<float>{0, 2, 4, 6, 2, 4, 6, 8});
  });
  graph.copy("test.scale", large, small);
  graph.copy("test.copy", large, same);
  graph.execute();
  EXPECT_EQ(small.image().downloadFloats(), (std::vector<float>{2, 6}));
  EXPECT_EQ(same.image().downloadFloats(), (std::vector<float>{0, 2, 4, 6, 2, 4, 6, 8}));
}

TEST(FrameGraph, PixelsGoIntoBuffersAndBack) {
  FrameGraph graph(testDevice());
  graph.begin();
  const auto image =
      graph.create("test.image", ImageDesc{.format = VK_FORMAT_R32_SFLOAT, .width = 3, .height = 2});
  const auto same = graph.create("test.same", image.image().desc());
  const auto buffer = graph.create("test.buffer", BufferDesc{.bytes = 6 * 4, .host_visible = true});
  const auto small = graph.create("test.small", BufferDesc{.bytes = 5 * 4});
  graph.host("test.host").write(image).run([&](HostAccess& host) {
    host.uploadFloats(image, std::vector<float>{1, 2, 3, 4, 5, 6});
  });
  graph.copy("test.copy", image, buffer);
  graph.host("test.double").read(buffer).write(buffer).run([&](HostAccess& host) {
    for (float& value : host.map<float>(buffer)) value *= 2.0f;
  });
  graph.copy("test.copy", buffer, same);
  EXPECT_THROW(graph.copy("test.copy", image, small), Error);
  graph.execute();
  EXPECT_EQ(same.image().downloadFloats(), (std::vector<float>{2, 4, 6, 8, 10, 12}));
}

TEST(FrameGraph, TimersAreThereOnRequestAndSumByName) {
  FrameGraph graph(testDevice());
  graph.begin();
  recordChain(graph, 0.0f);
  graph.execute();
  EXPECT_TRUE(graph.times().empty());
  graph.setTimed(true);
  graph.begin();
  recordChain(graph, 0.0f);
  graph.execute();
  const auto times = graph.times();
  ASSERT_EQ(times.size(), 4u);  // the two test.add are one row
  EXPECT_EQ(times[0].name, "test.fill");
  EXPECT_EQ(times[2].name, "test.add");
  if (testDevice().limits().timestamp_ns == 0.0) GTEST_SKIP() << "this device has no clock";
  for (const auto& time : times) {
    EXPECT_GT(time.milliseconds, 0.0) << time.name;
    EXPECT_LT(time.milliseconds, 60000.0) << time.name;
  }
}

TEST(FrameGraph, EverythingGoesWhileTheDeviceStillWorks) {
  // Destruction right after submission: the validation layer would tell of objects in use and of leaks.
  const auto device = Device::create();
  const auto before = validationMessages();
  for (int i = 0; i < 3; ++i) {
    const Image target(*device, "target", kFloats);
    FrameGraph graph(*device);
    graph.setTimed(true);
    graph.begin();
    graph.compute("test.fill", gpu_fill_spv).write("target", target).push(FillParams{}).dispatchOver(target);
    recordChain(graph, 0.0f);
    graph.execute();
  }
  EXPECT_EQ(validationMessages(), before);
}

TEST(FrameGraph, NothingRunsOutsideAFrame) {
  FrameGraph graph(testDevice());
  EXPECT_EQ(errorOf([&] { graph.execute(); }), "frame graph: execute() without begin()");
  EXPECT_EQ(errorOf([&] { graph.host("test.host"); }),
            "pass 'test.host': stands outside a frame: begin() comes first");
}

}  // namespace
}  // namespace gloam::gpu
