// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The public renderer as programs use it.
#include <gloam/renderer.h>

#include <algorithm>
#include <utility>

#include "golden.h"
#include "gpu/test_device.h"

namespace gloam {
namespace {

using gpu::errorOf;

/// One for all tests: making one compiles shaders.
Renderer& renderer() {
  static Renderer renderer;
  return renderer;
}

PosedCamera cameraOf(const PosedScene& posed, float aspect = 1.0f) {
  return posed.cameras.empty() ? framingCamera(posed, aspect) : posed.cameras[0];
}

RenderedFrame draw(const Scene& scene, RenderOptions options = {.width = 96, .height = 96},
                   float time_s = 0.0f) {
  renderer().setScene(scene);
  const PosedScene posed = pose(scene, time_s);
  return renderer().render(posed, cameraOf(posed), options);
}

Image display(const RenderedFrame& frame) {
  return toDisplay(frame.layers, {});
}

TEST(Renderer, LayersAreTheOnesThatProgramsRead) {
  const RenderedFrame frame = draw(loadScene("builtin:cornell"), {.width = 40, .height = 24});
  EXPECT_EQ(frame.layers.width, 40);
  EXPECT_EQ(frame.layers.height, 24);
  const Image sum = frame.layers.image("", {"R", "G", "B", "A"}, "frame");
  const Image direct = frame.layers.image("direct", {"R", "G", "B"}, "frame");
  const Image indirect = frame.layers.image("indirect", {"R", "G", "B"}, "frame");
  for (std::size_t i = 0; i < sum.pixelCount(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(sum.pixels[4 * i + c], direct.pixels[3 * i + c] + indirect.pixels[3 * i + c],
                  2e-3f * sum.pixels[4 * i + c]);
  }
  EXPECT_EQ(frame.layers.image("normal", {"X", "Y", "Z"}, "frame").channels, 3);
  EXPECT_EQ(frame.layers.image("albedo", {"R", "G", "B"}, "frame").channels, 3);
  EXPECT_GT(frame.layers.image("depth", {"Z"}, "frame").at(20, 12)[0], 0.5f);
  ASSERT_NE(frame.layers.find("object"), nullptr);
  EXPECT_GT(frame.layers.find("object")->ids[12 * 40 + 20], 0u);
  EXPECT_GT(frame.memory_bytes, 10000u);

  const RenderedFrame few = draw(loadScene("builtin:cornell"), {.width = 40, .height = 24, .layers = false, .parts = false});
  EXPECT_EQ(few.layers.layers.size(), 1u);
  EXPECT_EQ(few.layers.image("", {"R"}, "frame").pixels, frame.layers.image("", {"R"}, "frame").pixels);
}

TEST(Renderer, SameFrameSameBits) {
  const Scene scene = loadScene("builtin:lamp");
  const RenderedFrame first = draw(scene);
  draw(loadScene("builtin:textured"));
  const RenderedFrame second = draw(scene);
  ASSERT_EQ(first.layers.layers.size(), second.layers.layers.size());
  for (std::size_t i = 0; i < first.layers.layers.size(); ++i) {
    EXPECT_EQ(first.layers.layers[i].pixels, second.layers.layers[i].pixels) << first.layers.layers[i].name;
    EXPECT_EQ(first.layers.layers[i].ids, second.layers.layers[i].ids);
  }
}

bool has(const RenderedFrame& frame, const std::string& pass) {
  return std::ranges::any_of(frame.passes, [&](const PassTime& time) { return time.name == pass; });
}

/// Techniques, options and light change neither what the camera nor what the lamps see.
TEST(Renderer, WhatStillStandsIsNotDrawnAgain) {
  const Scene scene = loadScene("builtin:cornell?detail=0.25");
  renderer().setScene(scene);
  PosedScene posed = pose(scene, 0.0f);
  PosedCamera camera = cameraOf(posed);
  RenderOptions options{.width = 48, .height = 32, .timings = true};
  const auto expect = [&](bool gbuffer, bool shadow_maps) {
    const RenderedFrame frame = renderer().render(posed, camera, options);
    EXPECT_EQ(has(frame, "frame.gbuffer"), gbuffer);
    EXPECT_EQ(has(frame, "frame.shadow_maps"), shadow_maps);
    return frame;
  };
  const RenderedFrame first = expect(true, true);
  expect(true, true);  // asked for twice: it is measured
  options.technique = "splatting", options.settings = Settings(technique("splatting").options);
  expect(false, false);
  expect(true, true);
  renderer().setEnvironment(loadEnvironment("sky:noon"));
  expect(false, false);
  options.settings.set("vpls", "64");
  expect(false, false);
  options.width = 24;  // another size stands beside it
  expect(true, false);
  const PosedCamera there = std::exchange(camera, framingCamera(posed, 1.0f));
  expect(true, false);
  camera = there;
  renderer().setEnvironment(scene.environment);
  options = {.width = 48, .height = 32, .timings = true};
  const RenderedFrame again = expect(false, false);
  for (std::size_t i = 0; i < first.layers.layers.size(); ++i) {
    EXPECT_EQ(first.layers.layers[i].pixels, again.layers.layers[i].pixels) << first.layers.layers[i].name;
    EXPECT_EQ(first.layers.layers[i].ids, again.layers.layers[i].ids);
  }
  posed.instances[0].world_from_object[3].y += 0.01f;
  expect(true, true);
}

/// What lamps see and reflect does not hang on the camera, but on the lamps and on all that stands.
TEST(Renderer, ReflectiveMapsStandWhileLampsAndSceneDo) {
  const Scene scene = loadScene("builtin:cornell?detail=0.25");
  renderer().setScene(scene);
  PosedScene posed = pose(scene, 0.0f);
  const PosedCamera camera = cameraOf(posed);
  RenderOptions options{.width = 32, .height = 32, .technique = "splatting", .timings = true};
  options.settings = Settings(technique("splatting").options);
  float angle_rad = 0.0f;
  const auto expect = [&](bool drawn) {
    const RenderedFrame frame = renderer().render(posed, orbit(camera, posed, angle_rad += 0.1f), options);
    EXPECT_EQ(has(frame, "vpls.maps"), drawn);
    EXPECT_EQ(has(frame, "vpls.reflect"), drawn);
    return frame;
  };
  expect(true);
  const RenderedFrame kept = expect(false);
  renderer().setScene(scene);
  angle_rad -= 0.1f;
  EXPECT_EQ(expect(true).layers.image("indirect", {"R"}, "frame").pixels,
            kept.layers.image("indirect", {"R"}, "frame").pixels);
  posed.instances[0].world_from_object[3].y += 0.01f;
  expect(true);
  expect(false);
  ASSERT_FALSE(posed.lights.empty());
  posed.lights[0].light.intensity *= 0.5f;
  expect(true);
  posed.lights[0].position.x += 0.01f;
  expect(true);
  expect(false);
  options.show = "vpls.diffuse";  // what they are made from is made again
  expect(true);
}

/// Vertices of what bends come anew every frame, in two places by turns: what counts is whether they are others.
TEST(Renderer, WhatBendsStandsWhileItsVerticesDo) {
  const Scene scene = loadScene("builtin:walker?detail=0.25");
  renderer().setScene(scene);
  const PosedCamera camera = cameraOf(pose(scene, 0.0f));
  RenderOptions options{.width = 24, .height = 24, .timings = true};
  const auto draw = [&](float time_s, const char* order) {
    options.settings = Settings(technique("irradiance").options);
    options.settings.set("order", order);
    return renderer().render(pose(scene, time_s), camera, options);
  };
  const RenderedFrame first = draw(0.0f, "2");
  EXPECT_TRUE(has(first, "frame.gbuffer"));
  EXPECT_FALSE(has(draw(0.0f, "3"), "frame.gbuffer"));
  EXPECT_FALSE(has(draw(0.0f, "4"), "frame.gbuffer"));
  EXPECT_EQ(draw(0.0f, "2").layers.image("", {"R"}, "frame").pixels,
            first.layers.image("", {"R"}, "frame").pixels);
  EXPECT_TRUE(has(draw(0.1f, "3"), "frame.gbuffer"));
  EXPECT_TRUE(has(draw(0.2f, "4"), "frame.gbuffer"));
}

TEST(Renderer, ManyFramesTakeNoMoreMemory) {
  const Scene scene = loadScene("builtin:walker");
  renderer().setScene(scene);
  std::size_t memory = 0;
  for (int i = 0; i < 60; ++i) {
    const PosedScene posed = pose(scene, 0.08f * float(i));
    const RenderedFrame frame =
        renderer().render(posed, cameraOf(posed), {.width = 24, .height = 24, .layers = i % 2 == 0});
    if (i == 20) memory = frame.memory_bytes;
    if (i > 20) {
      ASSERT_LE(frame.memory_bytes, memory + 4096) << "frame " << i;
    }
  }
}

TEST(Renderer, ScenesCanBeSwapped) {
  const RenderedFrame cornell = draw(loadScene("builtin:cornell"));
  std::size_t memory = 0;
  for (int i = 0; i < 6; ++i) {
    draw(loadScene("builtin:mobile"), {.width = 32, .height = 32}, 1.0f);
    const RenderedFrame again = draw(loadScene("builtin:cornell"));
    EXPECT_EQ(again.layers.layers[0].pixels, cornell.layers.layers[0].pixels);
    if (i == 2) memory = again.memory_bytes;
    if (i > 2) {
      EXPECT_LE(again.memory_bytes, memory + 4096);
    }
  }
}

// A thing that moves shows where it is; one pose after another, with one setScene.
TEST(Renderer, AnimationMoves) {
  const Scene scene = loadScene("builtin:walker");
  const RenderedFrame first = draw(scene);
  const PosedScene later = pose(scene, 2.0f);
  const RenderedFrame second = renderer().render(later, cameraOf(later), {.width = 96, .height = 96});
  EXPECT_NE(first.layers.find("object")->ids, second.layers.find("object")->ids);
  EXPECT_EQ(draw(scene).layers.layers[0].pixels, first.layers.layers[0].pixels);
}

TEST(Renderer, EnvironmentReplacesTheScenesOwn) {
  const Scene scene = loadScene("builtin:furnace");
  renderer().setScene(scene);
  const PosedScene posed = pose(scene, 0.0f);
  const auto middle = [&] {
    const RenderedFrame frame = renderer().render(posed, cameraOf(posed), {.width = 32, .height = 32});
    return frame.layers.image("", {"R"}, "frame").at(16, 16)[0];
  };
  EXPECT_NEAR(middle(), 1.0f, 0.002f);
  Environment dimmer = scene.environment;
  dimmer.intensity *= 0.25f;
  renderer().setEnvironment(dimmer);
  EXPECT_NEAR(middle(), 0.25f, 0.0005f);
  renderer().setEnvironment({});
  EXPECT_EQ(middle(), 0.0f);
}

TEST(Renderer, SupersamplingKeepsTheFurnaceWhite) {
  const RenderedFrame frame =
      draw(loadScene("builtin:furnace"), {.width = 48, .height = 32, .supersample = 3});
  for (const float value : frame.layers.image("", {"R", "G", "B", "A"}, "frame").pixels)
    ASSERT_NEAR(value, 1.0f, 0.002f);
}

TEST(Renderer, ClearBackgroundHasNoAlpha) {
  RenderOptions options{.width = 32, .height = 32, .background = false};
  const Image image = draw(loadScene("builtin:furnace"), options).layers.image("", {"R", "A"}, "frame");
  EXPECT_EQ(image.at(0, 0)[0], 0.0f);
  EXPECT_EQ(image.at(0, 0)[1], 0.0f);
  EXPECT_EQ(image.at(16, 16)[1], 1.0f);
}

TEST(Renderer, AnyImageOfTheFrameCanBeShown) {
  RenderOptions options{
      .width = 32, .height = 20, .supersample = 2, .timings = true, .show = "irradiance.irradiance"};
  const RenderedFrame frame = draw(loadScene("builtin:furnace"), options);
  EXPECT_NEAR(frame.layers.image("irradiance.irradiance", {"R"}, "frame").at(16, 10)[0], 3.1416f, 0.01f);
  const std::vector<std::string> names = renderer().imageNames();
  for (const char* name : {"frame.ids", "frame.depth", "frame.diffuse", "frame.normal", "frame.shadow_maps"})
    EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
  for (const std::string& name : names) {
    options.show = name;
    EXPECT_EQ(draw(loadScene("builtin:furnace"), options).layers.image(name, {"R", "G", "B"}, "frame").width,
              32)
        << name;
  }
  options.show = "frame.motion";  // drawn only where it is asked for
  EXPECT_NO_THROW(draw(loadScene("builtin:furnace"), options));
  options.technique = "radiance_filter";  // of what is on the way, pictures alone are named
  options.settings = Settings(technique("radiance_filter").options);
  options.show = "radiance_filter.X";
  const std::string listed = errorOf([&] { draw(loadScene("builtin:furnace"), options); });
  EXPECT_NE(listed.find("radiance_filter.raw_0"), std::string::npos) << listed;
  for (const char* inner : {"radiance_filter.values", "radiance_filter.filtered", "none"})
    EXPECT_EQ(listed.find(inner), std::string::npos) << listed;
  options.technique = "irradiance", options.settings = {};
  options.show = "prt.vertices";
  EXPECT_NE(errorOf([&] { draw(loadScene("builtin:furnace"), options); }).find("frame.depth"),
            std::string::npos);
  bool timed = false;
  for (const PassTime& pass : frame.passes) timed = timed || pass.name == "irradiance.evaluate";
  EXPECT_TRUE(timed);
}

TEST(Renderer, ErrorsNameTheOption) {
  const Scene scene = loadScene("builtin:furnace");
  const auto message = [&](RenderOptions options) { return errorOf([&] { draw(scene, options); }); };
  EXPECT_EQ(message({.width = 0}), "option 'width': 0 is not from 1 to 16384");
  EXPECT_EQ(message({.width = 8, .height = 100000}), "option 'height': 100000 is not from 1 to 16384");
  EXPECT_EQ(message({.width = 8, .height = 8, .supersample = 5}),
            "option 'supersample': 5 is not from 1 to 4");
  EXPECT_NE(message({.width = 16384, .height = 16384, .supersample = 4}).find("16384 x 16384"),
            std::string::npos);
  EXPECT_NE(message({.technique = "radiosity"}).find("there are: irradiance, prt"), std::string::npos);
  RenderOptions options{.width = 8, .height = 8, .settings = Settings(technique("prt").options)};
  EXPECT_EQ(message(options), "technique irradiance: has no option 'indirect'");
  EXPECT_NE(message({.width = 8, .height = 8, .technique = "prt"}).find("gloam bake"), std::string::npos);
  Renderer fresh;
  EXPECT_NE(errorOf([&] { fresh.render({}, {}, {.width = 8, .height = 8}); }).find("no scene"),
            std::string::npos);
  EXPECT_NE(errorOf([] { Renderer("no such device"); }).find("no such device"), std::string::npos);
}

// After an Error the renderer goes on as before.
TEST(Renderer, ErrorsLeaveItUsable) {
  const Scene scene = loadScene("builtin:furnace");
  const RenderedFrame before = draw(scene);
  EXPECT_THROW(draw(scene, {.width = 96, .height = 96, .technique = "prt"}), Error);
  const PosedScene posed = pose(scene, 0.0f);
  const RenderedFrame after = renderer().render(posed, cameraOf(posed), {.width = 96, .height = 96});
  EXPECT_EQ(after.layers.layers[0].pixels, before.layers.layers[0].pixels);
}

TEST(Renderer, SmallestPictureAndEmptyScene) {
  EXPECT_NEAR(draw(loadScene("builtin:furnace"), {.width = 1, .height = 1})
                  .layers.image("", {"R"}, "frame")
                  .pixels[0],
              1.0f, 0.002f);
  Scene empty;
  empty.materials.emplace_back();
  empty.meshes.emplace_back();  // no vertices, no triangles
  empty.nodes.push_back({.meshes = {0}});
  empty.roots = {0};
  empty.environment = loadEnvironment("sky:uniform");
  EXPECT_NEAR(draw(empty, {.width = 8, .height = 8}).layers.image("", {"R"}, "frame").pixels[0], 1.0f,
              0.002f);
}

TEST(Renderer, RunsOnAHostsDevice) {
  const Scene scene = loadScene("builtin:furnace");
  const RenderedFrame own = draw(scene, {.width = 32, .height = 32});
  gpu::Device& device = gpu::testDevice();
  HostDevice host;
  host.instance = device.instance();
  host.physical_device = device.physicalDevice();
  host.device = device.handle();
  host.queue = device.queue();
  host.queue_family = device.queueFamily();
  Renderer guest(host);
  guest.setScene(scene);
  const PosedScene posed = pose(scene, 0.0f);
  const RenderedFrame frame = guest.render(posed, cameraOf(posed), {.width = 32, .height = 32});
  EXPECT_EQ(frame.layers.layers[0].pixels, own.layers.layers[0].pixels);
}

TEST(Techniques, TableSaysWhatThereIs) {
  ASSERT_GE(techniques().size(), 2u);
  for (const TechniqueInfo& info : techniques()) {
    EXPECT_EQ(&technique(info.name).summary[0], &info.summary[0]);
    EXPECT_TRUE(info.covers.environment_direct || info.covers.local_direct || info.covers.local_indirect);
    for (const Option& option : info.options) {
      Settings settings(info.options);  // every default is a value that may be set
      const auto values = settings.list();
      for (const auto& [name, text] : values)
        EXPECT_NO_THROW(settings.set(name, text)) << info.name << ' ' << name;
      EXPECT_STRNE(option.help, "");
    }
  }
}

TEST(Devices, TheFirstIsTheOneThatIsTaken) {
  ASSERT_FALSE(devices().empty());
  EXPECT_EQ(devices()[0].name, renderer().device().name);
}

// Small pictures of the built-in scenes, as they looked when someone last looked at them.
TEST(Golden, BuiltInScenes) {
  for (const char* name : {"cornell", "lamp", "textured", "spheres"}) {
    const RenderedFrame frame =
        draw(loadScene(std::string("builtin:") + name), {.width = 96, .height = 96, .supersample = 2});
    EXPECT_EQ(
        test::compareWithGolden(display(frame), std::string("irradiance_") + name, {.max_difference = 3}),
        "");
  }
  const RenderedFrame walker =
      draw(loadScene("builtin:walker"), {.width = 96, .height = 96, .supersample = 2}, 1.3f);
  EXPECT_EQ(test::compareWithGolden(display(walker), "irradiance_walker", {.max_difference = 3}), "");
}

}  // namespace
}  // namespace gloam
