// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Broken files: each gets one line that names the field.
#include <limits>

#include "scene/gltf_test_files.h"

namespace gloam::test {
namespace {

using GltfBroken = SceneFileTest;

struct Case {
  const char* pointer;  ///< where in the JSON
  Json value;           ///< what stands there instead; null removes it
  const char* words;    ///< what the message must say
};

/// A file with one of everything.
GltfFile fullFile() {
  GltfFile file = squareFile();
  file.json["images"][0] = {
      {"mimeType", "image/png"}, {"bufferView", file.view(tinyPng())}, {"name", "paint"}};
  file.json["textures"][0] = {{"source", 0}, {"sampler", 0}};
  file.json["samplers"][0] = {{"wrapS", 10497}};
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["targets"][0]["POSITION"] = 0;
  primitive["attributes"]["JOINTS_0"] = file.accessor<std::uint8_t>(std::vector<std::uint8_t>(16, 0), "VEC4");
  primitive["attributes"]["WEIGHTS_0"] = file.accessor<float>(std::vector<float>(16, 0.25f), "VEC4");
  file.json["nodes"][0]["skin"] = 0;
  file.show({{"children", {2}}});
  file.add("nodes", {{"camera", 0}});
  std::vector<float> identity(16, 0.0f);
  for (std::size_t i = 0; i < 16; i += 5) identity[i] = 1.0f;
  file.json["skins"][0] = {{"joints", {1}}, {"inverseBindMatrices", file.accessor(identity, "MAT4")}};
  file.json["cameras"][0] = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}};
  const int times = file.accessor<float>({0, 1}, "SCALAR"),
            moves = file.accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");
  file.json["animations"][0] = {
      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
      {"samplers", {{{"input", times}, {"output", moves}}}}};
  file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "point";
  file.json["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  return file;
}

TEST_F(GltfBroken, EveryFieldIsCheckedAndNamed) {
  const Json huge = 4294967295u;
  const Case cases[] = {
      {"/asset", nullptr, "asset: missing"},
      {"/asset/version", "1.0", "asset.version: glTF 2.0 is read, found \"1.0\""},
      {"/accessors/0/count", huge,
       "accessors[0].count: 4294967295 elements from byte 0 on do not fit into bufferViews[0]"},
      {"/accessors/0/count", 5, "accessors[0].count: 5 elements"},
      {"/accessors/0/count", -1, "accessors[0].count: a whole number"},
      {"/accessors/0/count", 1.5, "accessors[0].count: a whole number"},
      {"/accessors/0/count", 1e300, "accessors[0].count: a whole number"},
      {"/accessors/0/count", "4",
       "accessors[0].count: a whole number from 0 to 9007199254740992 was expected, found \"4\""},
      {"/accessors/0/byteOffset", 1, "accessors[0].count: 4 elements from byte 1 on"},
      {"/accessors/0/byteOffset", 9007199254740992,
       "accessors[0].count: 4 elements from byte 9007199254740992"},
      {"/accessors/0/bufferView", 77,
       "accessors[0].bufferView: an index into bufferViews (0 to 9) was expected, found 77"},
      {"/accessors/0/bufferView", -1, "accessors[0].bufferView: an index"},
      {"/accessors/0/componentType", 5130, "accessors[0].componentType: one of"},
      {"/accessors/0/type", "VEC5", "accessors[0].type: one of"},
      {"/accessors/0/type", "VEC2",
       "attributes.POSITION: accessors[0] has 2 components an element, 3 were expected"},
      {"/accessors/1/count", 3, "attributes.NORMAL: accessors[1] has 3 elements, but POSITION has 4"},
      {"/accessors/3/componentType", 5122, "indices: accessors[3]: unsigned whole numbers were expected"},
      {"/accessors/0/sparse",
       {{"count", 9},
        {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
        {"values", {{"bufferView", 0}}}},
       "accessors[0].sparse.count: 9, but the accessor has 4 elements"},
      {"/accessors/0/sparse",
       {{"count", 1},
        {"indices", {{"bufferView", 1}, {"byteOffset", 8}, {"componentType", 5125}}},
        {"values", {{"bufferView", 0}}}},
       "accessors[0].sparse.indices: index 1065353216 at 0, but there are 4 elements"},
      {"/bufferViews/0/buffer", 1,
       "bufferViews[0].buffer: an index into buffers (0 to 0) was expected, found 1"},
      {"/bufferViews/0/byteLength", huge,
       "bufferViews[0].byteLength: bytes 0 to 4294967295 lie beyond buffers[0]"},
      {"/bufferViews/0/byteOffset", 9007199254740992, "bufferViews[0].byteLength: bytes"},
      {"/bufferViews/0/byteStride", 8,
       "accessors[0]: elements of 12 bytes do not fit into bufferViews[0].byteStride 8"},
      {"/bufferViews/0/byteStride", 13, "bufferViews[0].byteStride: a multiple of 4"},
      {"/bufferViews/0/byteStride", 3, "bufferViews[0].byteStride: a whole number from 4 to 252"},
      {"/meshes/0/primitives", Json::object(),
       "meshes[0].primitives: an array was expected, found an object"},
      {"/meshes/0/primitives/0/attributes/POSITION", 99,
       "meshes[0].primitives[0].attributes.POSITION: an index"},
      {"/meshes/0/primitives/0/attributes/POSITION", nullptr, "there are no triangles to draw"},
      {"/meshes/0/primitives/0/indices", 99, "meshes[0].primitives[0].indices: an index"},
      {"/meshes/0/primitives/0/material", 1,
       "meshes[0].primitives[0].material: an index into materials (0 to 0)"},
      {"/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode: one of"},
      {"/meshes/0/primitives/0/mode", 1, "there are no triangles to draw (1 primitives are points or lines"},
      {"/meshes/0/primitives/0/targets/0/POSITION", 2, "targets[0].POSITION: accessors[2] has 2 components"},
      {"/meshes/0/primitives/0/attributes/WEIGHTS_0", nullptr,
       "JOINTS_0 and WEIGHTS_0 were expected together"},
      {"/nodes/0/mesh", 5, "nodes[0].mesh: an index into meshes"},
      {"/nodes/1/children/0", 1, "nodes[1].children: the node is its own ancestor"},
      {"/nodes/2/children", {1}, "children: the node is its own ancestor"},
      {"/nodes/0/children", {2}, "children: node 2 has the parent 0 already"},
      {"/nodes/1/children", {2, 2}, "nodes[1].children: 2 twice"},
      {"/nodes/0/rotation",
       {0, 0, 1},
       "nodes[0].rotation: an array of 4 numbers was expected, found an array of 3"},
      {"/nodes/0/matrix", {1, 2}, "nodes[0].matrix: an array of 16 numbers"},
      {"/nodes/0/scale", {1, 1e39, 1}, "nodes[0].scale[1]: a number from"},
      {"/nodes/0/translation", {1, 1e20, 1}, "nodes[0].translation: 1e+20 lies beyond 1e12"},
      {"/nodes/2/extensions/KHR_lights_punctual/light", 3,
       "nodes[2].extensions.KHR_lights_punctual.light: an index into lights (0 to 0)"},
      {"/scene", 3, "scene: an index into scenes"},
      {"/scenes/0/nodes/0", 9, "scenes[0].nodes[0]: an index into nodes"},
      {"/scenes/0/nodes", Json::array(), "there are no triangles to draw"},
      {"/skins/0/joints", Json::array(), "skins[0].joints: at least one"},
      {"/skins/0/joints", {0, 1}, "skins[0].inverseBindMatrices: 1 matrices for 2 joints"},
      {"/skins/0/inverseBindMatrices", 0, "skins[0].inverseBindMatrices: accessors[0] has 3 components"},
      {"/cameras/0/perspective/yfov", 0, "cameras[0].perspective.yfov: a number from"},
      {"/cameras/0/perspective", nullptr, "cameras[0].perspective: missing"},
      {"/cameras/0/type", "pinhole", "cameras[0].type: one of"},
      {"/animations/0/channels/0/sampler", 4,
       "animations[0].channels[0].sampler: 4, but there are 1 samplers"},
      {"/animations/0/channels/0/target/node", 40, "animations[0].channels[0].target.node: an index"},
      {"/animations/0/samplers/0/interpolation", "SMOOTH", "animations[0].samplers[0].interpolation: one of"},
      {"/animations/0/samplers/0/interpolation", "CUBICSPLINE",
       "animations[0].samplers[0].output: 18 numbers were expected for 2 keys, found 6"},
      {"/animations/0/samplers/0/output", 0, "animations[0].samplers[0].output: 6 numbers were expected"},
      {"/animations/0/samplers/0/input", 1, "animations[0].samplers[0].input: accessors[1] has 3 components"},
      {"/textures/0/source", 2, "textures[0].source: an index into images"},
      {"/textures/0/sampler", 2, "textures[0].sampler: an index into samplers"},
      {"/samplers/0/wrapS", 3, "samplers[0].wrapS: one of"},
      {"/images/0/bufferView", 0, "images[0] ('paint'): "},
      {"/images/0",
       {{"uri", "data:image/png;base64,AAAA*AAA"}},
       "images[0].uri: character 4 of the base64 data is not base64"},
      {"/images/0", {{"uri", "data:image/png;base64,AAAAA"}}, "images[0].uri: base64 data is cut off"},
      {"/images/0", {{"uri", "data:image/png;base64"}}, "images[0].uri: data URI without a comma"},
      {"/images/0",
       {{"uri", "http://example.org/a.png"}},
       "images[0].uri: only files and data URIs are read"},
      {"/images/0", {{"uri", "/dev/zero"}}, "this is a device or a pipe"},
      {"/images/0", {{"name", "x"}}, "images[0]: neither uri nor bufferView"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 1,
       "baseColorTexture.index: an index into textures (0 to 0)"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor",
       {1, 1, 1},
       "baseColorFactor: an array of 4 numbers"},
      {"/materials/0/alphaMode", "GLASS",
       "materials[0].alphaMode: one of OPAQUE MASK BLEND was expected, found \"GLASS\""},
      {"/materials/0/doubleSided", 1, "materials[0].doubleSided: true or false was expected, found 1"},
  };
  EXPECT_EQ(refusal(put("a.gltf", fullFile().text())), "");
  for (const Case& c : cases) {
    GltfFile file = fullFile();
    const Json::json_pointer pointer(c.pointer);
    if (c.value.is_null())
      file.json[pointer.parent_pointer()].erase(pointer.back());
    else
      file.json[pointer] = c.value;
    const std::string message = refusal(put("a.gltf", file.text()));
    EXPECT_NE(message.find(c.words), std::string::npos)
        << c.pointer << " = " << c.value << "\n  says: " << message;
    EXPECT_TRUE(message.starts_with(path("a.gltf").string() + ": ")) << message;
  }
}

TEST_F(GltfBroken, ValuesInBuffersAreChecked) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const auto refusalOf = [&](std::vector<float> positions, std::vector<std::uint16_t> indices) {
    GltfFile file;
    const int p = file.accessor(positions, "VEC3"), i = file.accessor(indices, "SCALAR");
    file.primitive({{"POSITION", p}}, i);
    file.json["meshes"][0]["name"] = "Body";
    return refusal(put("a.glb", file.glb()));
  };
  EXPECT_NE(refusalOf({0, 0, 0, 1, 0, 0, 0, nan, 0}, {0, 1, 2})
                .find("('Body').primitives[0]: position of vertex 2 is not finite"),
            std::string::npos);
  EXPECT_NE(refusalOf({0, 0, 0, inf, 0, 0, 0, 1, 0}, {0, 1, 2}).find("vertex 1 is not finite"),
            std::string::npos);
  EXPECT_NE(refusalOf({0, 0, 0, 1e30f, 0, 0, 0, 1, 0}, {0, 1, 2}).find("vertex 1 lies beyond 1e12"),
            std::string::npos);
  EXPECT_EQ(refusalOf({0, 0, 0, 1, 0, 0, 0, 1, 0, nan, nan, nan}, {0, 1, 2}), "");  // no triangle uses it
  EXPECT_NE(refusalOf({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 3})
                .find("indices: index 3 at 2, but there are 3 vertices"),
            std::string::npos);
  EXPECT_NE(refusalOf({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 65535}).find("index 65535"), std::string::npos);
  EXPECT_NE(refusalOf({0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2})
                .find("no triangles to draw (1 triangles without area"),
            std::string::npos);
}

TEST_F(GltfBroken, JointsBeyondTheSkinAreRefused) {
  GltfFile file = fullFile();
  file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
      file.accessor<std::uint8_t>(std::vector<std::uint8_t>(16, 7), "VEC4");
  EXPECT_NE(refusal(put("a.gltf", file.text()))
                .find("nodes[0].skin: mesh 'mesh 0' uses joint 7, but skins[0] has 1"),
            std::string::npos);
}

TEST_F(GltfBroken, CountsWithoutAnyBytesBehindThemAreBounded) {
  for (const std::uint64_t count : {std::uint64_t(4294967295u), std::uint64_t(1) << 50}) {
    GltfFile file;
    file.json["accessors"][0] = {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}};
    file.primitive({{"POSITION", 0}});
    EXPECT_NE(refusal(put("a.gltf", file.text())).find("accessors[0].count: "), std::string::npos);
  }
}

TEST_F(GltfBroken, MillionsOfEmptyObjectsAreBounded) {
  std::string text = R"({"asset":{"version":"2.0"},"nodes":[{})";
  for (int i = 0; i < 1000000; ++i) text += ",{}";
  EXPECT_NE(refusal(put("a.gltf", text + "]}")).find("nodes: 1000001 elements would need"),
            std::string::npos);
}

TEST_F(GltfBroken, ManyPrimitivesOverOneArrayAreBounded) {
  GltfFile file = triangleFile();
  const int indices = file.accessor(std::vector<std::uint8_t>(300000, 1), "SCALAR");
  for (int i = 0; i < 3000; ++i) {
    file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"indices", indices}});
  }
  EXPECT_NE(refusal(put("a.glb", file.glb())).find("would need"), std::string::npos);
}

TEST_F(GltfBroken, Containers) {
  const Bytes good = triangleFile().glb();
  const auto bent = [&](std::size_t at, std::uint32_t value) {
    Bytes file = good;
    std::memcpy(&file[at], &value, 4);
    return refusal(put("a.glb", file));
  };
  EXPECT_NE(bent(0, 0x12345678).find("neither .glb"), std::string::npos);
  EXPECT_NE(bent(4, 1).find("header: version 1"), std::string::npos);
  EXPECT_NE(bent(8, 0xffffffff).find("header: length 4294967295, but the file ends after"),
            std::string::npos);
  EXPECT_NE(bent(8, 12).find("the JSON chunk is missing"), std::string::npos);
  EXPECT_NE(bent(12, 0xfffffff0).find("chunk 0: 4294967280 bytes are claimed"), std::string::npos);
  EXPECT_NE(bent(16, 0).find("chunk 0: the JSON chunk was expected first"), std::string::npos);
  for (std::size_t size = 1; size < good.size(); ++size)
    EXPECT_NE(refusal(put("a.glb", Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)))),
              "")
        << size;
  EXPECT_NE(refusal(put("a.glb", Bytes())).find("empty"), std::string::npos);
  EXPECT_NE(refusal(path("none.glb").string()).find("no such file"), std::string::npos);
  EXPECT_NE(refusal(path("").string()).find("folder"), std::string::npos);
  EXPECT_NE(refusal(put("a.blend", std::string("BLENDER")))
                .find(".gltf, .glb, .obj, .ply, .off, .fbx, .3ds, .raw and .vdb"),
            std::string::npos);
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_TRUE(warned(loadScene(put("a.glb", longer)), "1 bytes after the end"));
}

TEST_F(GltfBroken, Json) {
  EXPECT_NE(refusal(put("a.gltf", std::string("{ \"asset\": "))).find("JSON: parse error"),
            std::string::npos);
  EXPECT_NE(refusal(put("a.gltf", std::string("[]"))).find("neither .glb"), std::string::npos);
  EXPECT_NE(refusal(put("a.gltf", std::string("{}"))).find("asset: missing"), std::string::npos);
  EXPECT_NE(refusal(put("a.gltf", std::string(100000, '{'))).find("nested deeper"), std::string::npos);
  const std::string deep =
      "{\"asset\":{\"version\":\"2.0\"},\"x\":" + std::string(90000, '[') + std::string(90000, ']') + "}";
  EXPECT_NE(refusal(put("a.gltf", deep)).find("nested deeper"), std::string::npos);
  EXPECT_NE(refusal(put("a.gltf", std::string("{\"asset\":{\"version\":\"2\\n0\"}}"))).find("asset.version"),
            std::string::npos);
}

TEST_F(GltfBroken, ChainsOfNodesAreBounded) {
  GltfFile file = triangleFile();
  for (int i = 1; i <= 5000; ++i) file.add("nodes", i < 5000 ? Json{{"children", {i + 1}}} : Json::object());
  file.json["nodes"][0]["children"] = {1};
  EXPECT_NE(refusal(put("a.gltf", file.text())).find("more than 1000 levels deep"), std::string::npos);
}

TEST_F(GltfBroken, RandomDamageIsReadOrRefusedButNeverCrashes) {
  const Bytes good = fullFile().glb();
  std::uint32_t random = 7;
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    Bytes bad = good;
    for (int k = 0; k <= i % 4; ++k) {
      random = random * 1664525u + 1013904223u;
      bad[(random >> 4) % bad.size()] = static_cast<std::uint8_t>(random >> 24);
    }
    refused += refusal(put("a.glb", bad)) != "";
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace gloam::test
