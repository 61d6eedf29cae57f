// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What shaders ask for, and the errors for giving them something else.
#include "gpu/program.h"

#include <gtest/gtest.h>

#include <cstddef>

#include "gpu/frame_graph.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders/gpu_test_shared.h"
#include "shaders/gpu_test_shaders.h"

namespace gloam::gpu {
namespace {

using gpu_test::CountParams;
using gpu_test::FillParams;
using gpu_test::Inner;
using gpu_test::Record;

const BlockMember& member(const Binding& binding, const std::string& name) {
  for (const auto& candidate : binding.members) {
    if (candidate.name == name) return candidate;
  }
  throw Error(binding.name, "no member " + name);
}

TEST(Reflection, SharedStructsHaveTheOffsetsOfCpp) {
  const Interface interface = reflect(gpu_layout_spv);
  for (const std::string prefix : {"records[].", "one."}) {
    const Binding* binding = interface.find(prefix == "one." ? "uniform_record" : "Records");
    ASSERT_NE(binding, nullptr);
    EXPECT_EQ(member(*binding, prefix + "position").offset, offsetof(Record, position));
    EXPECT_EQ(member(*binding, prefix + "uv").offset, offsetof(Record, uv));
    EXPECT_EQ(member(*binding, prefix + "frame").offset, offsetof(Record, frame));
    EXPECT_EQ(member(*binding, prefix + "inner").offset, offsetof(Record, inner));
    EXPECT_EQ(member(*binding, prefix + "inner").array_stride, sizeof(Inner));
    EXPECT_EQ(member(*binding, prefix + "inner[].radius").offset, offsetof(Inner, radius));
    EXPECT_EQ(member(*binding, prefix + "inner[].ids").offset, offsetof(Inner, ids));
    EXPECT_EQ(member(*binding, prefix + "flags").offset, offsetof(Record, flags));
    EXPECT_EQ(member(*binding, prefix + "world_from_object").offset, offsetof(Record, world_from_object));
  }
  EXPECT_EQ(member(*interface.find("Records"), "records").array_stride, sizeof(Record));
  EXPECT_EQ(interface.find("uniform_record")->block_bytes, sizeof(Record));
}

TEST(Reflection, ReadsNamesKindsAndSizes) {
  const Interface fill = reflect(gpu_fill_spv);
  EXPECT_EQ(fill.local_size, (std::array<std::uint32_t, 3>{8, 8, 1}));
  EXPECT_EQ(fill.push_bytes, sizeof(FillParams));
  ASSERT_NE(fill.find("target"), nullptr);
  EXPECT_EQ(fill.find("target")->type, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  EXPECT_FALSE(fill.find("target")->readable);
  const Interface shapes = reflect(gpu_shapes_spv);
  EXPECT_EQ(shapes.find("cube")->view_type, VK_IMAGE_VIEW_TYPE_CUBE);
  EXPECT_EQ(shapes.find("volume")->view_type, VK_IMAGE_VIEW_TYPE_3D);
  EXPECT_EQ(shapes.find("shadow")->view_type, VK_IMAGE_VIEW_TYPE_2D_ARRAY);
  EXPECT_EQ(shapes.find("ids")->numbers, Numbers::kUint);
  EXPECT_TRUE(shapes.find("result")->writable);
  EXPECT_FALSE(reflect(gpu_gather_spv).find("Sums")->readable);
}

TEST(Reflection, VertexAttributesAreNotHandled) {
  EXPECT_EQ(errorOf([] {
              reflect(gpu_attribute_vert_spv);
            }).find("gpu_attribute.vert: reads the vertex attribute "),
            0u);
}

TEST(Reflection, RubbishIsAnError) {
  const std::uint32_t words[] = {1, 2, 3};
  EXPECT_EQ(errorOf([&] { reflect({"rubbish.comp", words, 3}); }).find("rubbish.comp: is not SPIR-V"), 0u);
}

/// Writes one frame down, runs it, and gives back the error.
template <class F>
std::string frameError(F&& write_down) {
  FrameGraph graph(testDevice());
  graph.begin();
  return errorOf([&] {
    write_down(graph);
    graph.execute();
  });
}

class Bindings : public testing::Test {
 protected:
  Image image{testDevice(), "image", {.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 8, .height = 8}};
  Image ids{testDevice(), "ids", {.format = VK_FORMAT_R32_UINT, .width = 8, .height = 8}};
  Image layered{testDevice(), "layered", {.width = 8, .height = 8, .layers = 2, .mips = 2}};
  Buffer buffer{testDevice(), "buffer", std::vector<float>(64)};
};

TEST_F(Bindings, AMissingOneIsNamed) {
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.gather", gpu_gather_spv).read("source", image).dispatchOver(image);
            }),
            "pass 'test.gather', binding 'Sums': nothing was given for a storage buffer of gpu_gather.comp");
}

TEST_F(Bindings, AnExtraOneIsNamed) {
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.fill", gpu_fill_spv)
                  .write("target", image)
                  .read("proxies", buffer)
                  .push(FillParams{})
                  .dispatchOver(image);
            }),
            "pass 'test.fill': binding 'proxies': gpu_fill.comp has no such binding or never uses it; its "
            "bindings: "
            "target");
}

TEST_F(Bindings, OneGivenTwiceIsNamed) {
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.fill", gpu_fill_spv)
                  .write("target", image)
                  .write("target", image)
                  .push(FillParams{})
                  .dispatchOver(image);
            }),
            "pass 'test.fill': binding 'target' was given twice");
}

TEST_F(Bindings, ATooLargeUniformBufferIsNamed) {
  const std::uint64_t most = testDevice().limits().max_uniform_bytes;
  if (most > 1 << 20) GTEST_SKIP() << "this device takes large uniform buffers";
  const Buffer large(testDevice(), "large", BufferDesc{.bytes = static_cast<std::size_t>(most) + 256});
  EXPECT_NE(frameError([&](FrameGraph& graph) {
              graph.compute("test.layout", gpu_layout_spv)
                  .read("Records", buffer)
                  .read("uniform_record", large)
                  .write("result", large)
                  .dispatch(1);
            }).find("as a uniform buffer at most " + std::to_string(most)),
            std::string::npos);
}

TEST_F(Bindings, APushBlockOfAnotherSizeIsNamed) {
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.fill", gpu_fill_spv)
                  .write("target", image)
                  .push(CountParams{})
                  .dispatchOver(image);
            }),
            "pass 'test.fill': the push block of gpu_fill.comp has 12 bytes; 8 were pushed");
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.fill", gpu_fill_spv).write("target", image).dispatchOver(image);
            }),
            "pass 'test.fill': the push block of gpu_fill.comp has 12 bytes; 0 were pushed");
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.gather", gpu_gather_spv)
                  .read("source", image)
                  .write("Sums", buffer)
                  .push(CountParams{})
                  .dispatchOver(image);
            }),
            "pass 'test.gather': gpu_gather.comp has no push block or never uses it; 8 bytes were pushed");
}

TEST_F(Bindings, WrongKindsAndUsesAreNamed) {
  const auto fill = [&](auto&& bind) {
    return frameError([&](FrameGraph& graph) {
      auto& pass = graph.compute("test.fill", gpu_fill_spv).push(FillParams{});
      bind(pass);
      pass.dispatchOver(8, 8);
    });
  };
  const std::string place = "pass 'test.fill', binding 'target': ";
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.write("target", buffer); }),
            place + "the shader has a storage image here, and buffer 'buffer' was given");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.sampler("target", kLinearClamp); }),
            place + "the shader has a storage image here, and a sampler alone was given");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.read("target", image); }),
            place +
                "is only read here, but the shader may write it: declare it readonly there or say write or "
                "readWrite here");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.readWrite("target", image); }),
            place + "is read here, but writeonly in the shader");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.sample("target", image); }),
            place + "is sampled here, but the shader has a storage image");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.write("target", ids); }),
            place + "the shader takes texels for floats, image 'ids' (R32_UINT) holds unsigned integers");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.write("target", ImageRef(layered).mip(0)); }),
            place + "the shader has a 2D image, image 'layered' is 2D with 2 layers here");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.write("target", ImageRef(layered).layer(0)); }),
            place + "image 'layered' has 2 mips here; name one with mip()");
  EXPECT_EQ(fill([&](ComputePass& pass) { pass.write("target", ImageRef()); }),
            place + "an empty reference was given");
}

TEST_F(Bindings, StorageFormatsAndBlockSizesAreChecked) {
  const Image single(testDevice(), "single", {.format = VK_FORMAT_R32_SFLOAT, .width = 8, .height = 8});
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.previous", gpu_previous_spv)
                  .read("previous", single)
                  .write("current", image)
                  .dispatchOver(8, 8);
            }),
            "pass 'test.previous', binding 'current': the shader has the format R32_SFLOAT, image 'image' is "
            "R32G32B32A32_SFLOAT");
  const Buffer other(testDevice(), "other", std::vector<float>(64));
  const Buffer small(testDevice(), "small", std::vector<float>(2));
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.layout", gpu_layout_spv)
                  .read("Records", buffer)
                  .read("uniform_record", small)
                  .write("result", other)
                  .dispatch(1);
            }),
            "pass 'test.layout', binding 'uniform_record': the shader's block has 172 bytes, buffer 'small' "
            "only 8");
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.add", gpu_add_spv)
                  .readWrite("Values", BufferRef(buffer).slice(4, 32))
                  .push(CountParams{})
                  .dispatchOver(8);
            }),
            "pass 'test.add', binding 'Values': buffer 'buffer' is bound at 4, not a multiple of 256");
}

TEST_F(Bindings, OneResourceTwiceInAPassIsAnErrorWhereOneWrites) {
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.compute("test.layout", gpu_layout_spv)
                  .read("Records", buffer)
                  .read("uniform_record", buffer)
                  .write("result", buffer)
                  .dispatch(1);
            }),
            "pass 'test.layout': 'buffer' is bound as 'Records' and as 'result', and one of them writes what "
            "the other "
            "touches");
}

TEST_F(Bindings, WhatNoPassWroteCannotBeRead) {
  EXPECT_EQ(
      frameError([&](FrameGraph& graph) {
        const ImageRef empty = graph.create("test.empty", image.desc());
        graph.compute("test.gather", gpu_gather_spv)
            .read("source", empty)
            .write("Sums", buffer)
            .dispatchOver(empty);
      }),
      "pass 'test.gather': reads 'test.empty' (source), which no pass before it has written in this frame");
}

TEST_F(Bindings, MistakesOfThePassAreNamed) {
  EXPECT_EQ(
      frameError([&](FrameGraph& graph) { graph.compute("test.fill", gpu_fill_spv).write("target", image); }),
      "pass 'test.fill': was never dispatched");
  EXPECT_EQ(frameError([&](FrameGraph& graph) { graph.compute("test.draw", gpu_draw_vert_spv); }),
            "pass 'test.draw': gpu_draw.vert is no compute shader");
  EXPECT_EQ(frameError([&](FrameGraph& graph) {
              graph.create("test.a", image.desc());
              graph.create("test.a", image.desc());
            }),
            "frame graph: two resources of one frame are called 'test.a'");
  EXPECT_NE(frameError([&](FrameGraph& graph) {
              graph.compute("test.constant", gpu_constant_spv)
                  .write("result", buffer)
                  .specialize("kNone", 1)
                  .dispatch(1);
            }).find("constant 'kNone'"),
            std::string::npos);
  EXPECT_NE(frameError([&](FrameGraph& graph) {
              graph.compute("test.count", gpu_count_spv).readWrite("counter", buffer).dispatch(1u << 31);
            }).find("work groups in one direction"),
            std::string::npos);
}

TEST(Program, SpecialisationConstantsByNameSetValuesAndGroupSize) {
  FrameGraph graph(testDevice());
  const auto run = [&](auto&& specialise) {
    graph.begin();
    const BufferRef result = graph.create("test.result", BufferDesc{.bytes = 256});
    graph.clear("test.clear", result);
    auto& pass = graph.compute("test.constant", gpu_constant_spv).write("result", result);
    specialise(pass);
    pass.dispatchOver(64);
    graph.execute();
    return result.buffer().download<float>();
  };
  const auto plain = run([](ComputePass&) {});
  EXPECT_EQ(plain[0], 3.5f + 32000.0f);
  EXPECT_EQ(plain[1], 3.5f + 32000.0f);  // 64 invocations in groups of 32
  EXPECT_EQ(plain[2], 0.0f);
  const auto special = run([](ComputePass& pass) {
    pass.specialize("kMode", 10u)
        .specialize("kScale", 2.0f)
        .specialize("kNegate", true)
        .specialize("kWidth", 64u);
  });
  EXPECT_EQ(special[0], -20.0f + 64000.0f);
  EXPECT_EQ(special[1], 0.0f);  // one group of 64
  EXPECT_EQ(run([](ComputePass&) {})[0], 3.5f + 32000.0f);
}

TEST(Program, IsMadeOnceADevice) {
  EXPECT_EQ(&programFor(testDevice(), {&gpu_fill_spv}), &programFor(testDevice(), {&gpu_fill_spv}));
  Program& program = programFor(testDevice(), {&gpu_constant_spv});
  EXPECT_EQ(program.computePipeline({{1, 5}}), program.computePipeline({{1, 5}}));
  EXPECT_NE(program.computePipeline({{1, 5}}), program.computePipeline({{1, 6}}));
}

}  // namespace
}  // namespace gloam::gpu
