// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Vertices and triangles of glTF files: every way of storing them gives the same mesh.
#include "scene/gltf_test_files.h"

namespace gloam::test {
namespace {

using GltfGeometry = SceneFileTest;

const std::vector<glm::vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST_F(GltfGeometry, EveryIndexTypeGivesTheSameTriangle) {
  for (int type = 0; type < 4; ++type) {
    GltfFile file;
    const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int indices = type == 0   ? kNone
                        : type == 1 ? file.accessor<std::uint8_t>({0, 1, 2}, "SCALAR")
                        : type == 2 ? file.accessor<std::uint16_t>({0, 1, 2}, "SCALAR")
                                    : file.accessor<std::uint32_t>({0, 1, 2}, "SCALAR");
    file.primitive({{"POSITION", positions}}, indices);
    for (const bool binary : {false, true}) {
      const Scene scene = loadScene(binary ? put("a.glb", file.glb()) : put("a.gltf", file.text()));
      ASSERT_EQ(scene.meshes.size(), 1u);
      EXPECT_EQ(scene.meshes[0].positions, kTriangle);
      EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
      EXPECT_TRUE(scene.warnings.empty());
    }
  }
}

TEST_F(GltfGeometry, MagicDecidesBeforeTheExtension) {
  EXPECT_EQ(loadScene(put("binary.gltf", triangleFile().glb())).meshes.size(), 1u);
  EXPECT_EQ(loadScene(put("text.glb", triangleFile().text())).meshes.size(), 1u);
  EXPECT_EQ(loadScene(put("noextension", triangleFile().glb())).meshes.size(), 1u);
}

TEST_F(GltfGeometry, ReadsBuffersFromFilesWithEscapedNames) {
  GltfFile file = triangleFile();
  put("my data.bin", file.buffer);
  file.json["buffers"][0] = {{"byteLength", file.buffer.size()}, {"uri", "my%20data.bin"}};
  EXPECT_EQ(loadScene(put("a.gltf", file.json.dump())).meshes[0].positions, kTriangle);
}

TEST_F(GltfGeometry, QuantisedAttributesAreDequantised) {
  GltfFile file;
  const int positions =
      file.accessor<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}, "VEC4", true);
  file.json["accessors"][0]["type"] = "VEC3";  // 16-bit positions are padded to a stride of 8
  file.json["accessors"][0]["count"] = 3;
  file.json["bufferViews"][0]["byteStride"] = 8;
  const int normals = file.accessor<std::int8_t>({0, 0, 127, 0, 0, 0, -128, 0, 0, 127, 0, 0}, "VEC4", true);
  file.json["accessors"][1]["type"] = "VEC3";
  file.json["bufferViews"][1]["byteStride"] = 4;
  const int uv = file.accessor<std::uint16_t>({0, 0, 65535, 13107, 0, 65535}, "VEC2", true);
  const int uv_plain = file.accessor<std::uint8_t>({0, 0, 0, 0, 4, 2, 0, 0, 1, 3, 0, 0}, "VEC4");
  file.json["accessors"][3]["type"] = "VEC2";
  file.json["bufferViews"][3]["byteStride"] = 4;
  const int colors = file.accessor<std::uint8_t>({255, 0, 51, 255, 0, 255, 0, 102, 0, 0, 0, 0}, "VEC4", true);
  file.primitive({{"POSITION", positions},
                  {"NORMAL", normals},
                  {"TEXCOORD_0", uv},
                  {"TEXCOORD_1", uv_plain},
                  {"COLOR_0", colors}});
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, -1}, {0, 1, 0}}));  // -128 counts as -1
  ASSERT_EQ(mesh.uv_sets.size(), 2u);
  EXPECT_FLOAT_EQ(mesh.uv_sets[0][1].y, 0.2f);
  EXPECT_EQ(mesh.uv_sets[1][1], glm::vec2(4, 2));
  EXPECT_FLOAT_EQ(mesh.colors[0].b, 0.2f);
  EXPECT_FLOAT_EQ(mesh.colors[1].a, 0.4f);
}

TEST_F(GltfGeometry, InterleavedAttributesAreTakenApart) {
  GltfFile file;
  std::vector<float> vertices;
  for (const glm::vec3& p : kTriangle) vertices.insert(vertices.end(), {p.x, p.y, p.z, 0, 0, 1});
  const int view = file.view(vertices, 24);
  const Json accessor = {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
  const int positions = file.add("accessors", accessor), normals = file.add("accessors", accessor);
  file.json["accessors"][1]["byteOffset"] = 12;
  file.primitive({{"POSITION", positions}, {"NORMAL", normals}});
  const Mesh mesh = loadScene(put("a.gltf", file.text())).meshes.at(0);
  EXPECT_EQ(mesh.positions, kTriangle);
  EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
}

TEST_F(GltfGeometry, SparseAccessorsWithAndWithoutABase) {
  for (const bool base : {true, false}) {
    GltfFile file;
    int positions;
    if (base)
      positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    else
      positions = file.add("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    const int at = file.view<std::uint8_t>({1, 2});
    const int values = file.view<float>({3, 0, 0, 0, 5, 0});
    file.json["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", at}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", values}}}};
    file.primitive({{"POSITION", positions}});
    const Mesh mesh = loadScene(put("a.gltf", file.text())).meshes.at(0);
    EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {3, 0, 0}, {0, 5, 0}})) << base;
  }
}

TEST_F(GltfGeometry, StripsAndFansBecomeTrianglesOfTheSameWinding) {
  GltfFile file;
  const int strip = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  const int fan = file.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  file.primitive({{"POSITION", strip}})["mode"] = 5;
  file.primitive({{"POSITION", fan}})["mode"] = 6;
  const Scene scene = loadScene(put("a.gltf", file.text()));
  ASSERT_EQ(scene.meshes.size(), 2u);
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_EQ(mesh.triangleCount(), 2u);
    EXPECT_EQ(mesh.vertexCount(), 4u);  // coplanar: shared although normals are flat
    for (const glm::vec3& normal : mesh.normals) EXPECT_NEAR(normal.z, 1.0f, 1e-6f);
  }
}

TEST_F(GltfGeometry, PointsAndLinesAreLeftOutWithOneRemark) {
  GltfFile file = triangleFile();
  for (const int mode : {0, 1, 3}) file.primitive({{"POSITION", 0}})["mode"] = mode;
  const Scene scene = loadScene(put("a.gltf", file.text()));
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "3 primitives are points or lines and are left out");
}

TEST_F(GltfGeometry, PrimitivesKeepOnlyTheVerticesTheyUse) {
  GltfFile file;
  std::vector<float> many;
  for (int i = 0; i < 1000; ++i) many.insert(many.end(), {float(i), float(i % 7), float(i % 3)});
  const int positions = file.accessor(many, "VEC3");
  const int indices = file.accessor<std::uint32_t>({999, 3, 500}, "SCALAR");
  file.primitive({{"POSITION", positions}}, indices);
  const Mesh mesh = loadScene(put("a.gltf", file.text())).meshes.at(0);
  ASSERT_EQ(mesh.vertexCount(), 3u);
  EXPECT_EQ(mesh.positions[mesh.indices[0]], glm::vec3(999, 999 % 7, 0));
  EXPECT_EQ(mesh.positions[mesh.indices[1]].x, 3.0f);
}

TEST_F(GltfGeometry, MissingNormalsAreFlat) {
  GltfFile file;  // a tetrahedron with four shared corners
  const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  const int indices = file.accessor<std::uint8_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR");
  file.primitive({{"POSITION", positions}}, indices);
  const Mesh mesh = loadScene(put("a.gltf", file.text())).meshes.at(0);
  EXPECT_EQ(mesh.vertexCount(), 12u);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                    c = mesh.positions[mesh.indices[i + 2]];
    const glm::vec3 flat = glm::normalize(glm::cross(b - a, c - a));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(glm::dot(flat, mesh.normals[mesh.indices[i + k]]), 1.0f, 1e-6f);
  }
  EXPECT_EQ(mesh.tangents.size(), mesh.vertexCount());
}

TEST_F(GltfGeometry, BadNormalsAreComputedAndTrianglesWithoutAreaDropped) {
  GltfFile file;
  const float nan = std::nanf("");
  const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 2, 0}, "VEC3");
  const int normals = file.accessor<float>({0, 0, 0, nan, 0, 0, 0, 0, 3, 0, 0, 1}, "VEC3");
  const int indices = file.accessor<std::uint8_t>({0, 1, 2, 1, 1, 2, 0, 0, 0, 1, 2, 1}, "SCALAR");
  file.primitive({{"POSITION", positions}, {"NORMAL", normals}}, indices);
  const Scene scene = loadScene(put("a.gltf", file.text()));
  EXPECT_EQ(scene.meshes[0].triangleCount(), 1u);
  for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_TRUE(warned(scene, "3 triangles without area are left out"));
  EXPECT_TRUE(warned(scene, "2 normals were zero or not finite"));
}

TEST_F(GltfGeometry, TangentsFollowTheTextureAndItsMirror) {
  GltfFile file = squareFile();
  // The same square again to its left, with the picture mirrored: both share the edge x = 0.
  const int positions =
      file.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0, 0, -1, 1, 0}, "VEC3");
  const int normals = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int uv = file.accessor<float>({0, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0}, "VEC2");
  const int indices = file.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3, 4, 0, 3, 4, 3, 5}, "SCALAR");
  Json& primitive =
      file.primitive({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}}, indices);
  primitive["material"] = 0;
  file.json["images"][0] = {{"mimeType", "image/png"}, {"bufferView", file.view(tinyPng())}};
  file.json["textures"][0]["source"] = 0;
  file.json["materials"][0]["normalTexture"]["index"] = 0;
  const Scene scene = loadScene(put("a.gltf", file.text()));
  const Mesh& mesh = scene.meshes.at(1);
  EXPECT_EQ(mesh.vertexCount(), 8u);  // the two vertices of the seam are split
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t v = mesh.indices[i];
    const bool mirrored = i >= 6;
    EXPECT_NEAR(mesh.tangents[v].x, mirrored ? -1.0f : 1.0f, 1e-6f);
    // The bitangent points up in the picture, against v, on both.
    EXPECT_NEAR((glm::cross(mesh.normals[v], glm::vec3(mesh.tangents[v])) * mesh.tangents[v].w).y, 1.0f,
                1e-6f);
  }
}

TEST_F(GltfGeometry, MissingTextureCoordinatesAreFilled) {
  GltfFile file = triangleFile();
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["images"][0] = {{"bufferView", file.view(tinyPng())}, {"mimeType", "image/png"}};
  file.json["textures"][0]["source"] = 0;
  file.json["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 2}};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  EXPECT_EQ(scene.meshes[0].uv_sets.size(), 3u);
  EXPECT_TRUE(warned(scene, "texture coordinates that materials want are missing"));
}

TEST_F(GltfGeometry, EightInfluencesAreReadAndNormalised) {
  GltfFile file = triangleFile();
  const int j0 = file.accessor<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 9}, "VEC4");
  const int j1 = file.accessor<std::uint16_t>({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  const int w0 = file.accessor<float>({1, 1, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  const int w1 = file.accessor<std::uint8_t>({255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", true);
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.update({{"JOINTS_0", j0}, {"JOINTS_1", j1}, {"WEIGHTS_0", w0}, {"WEIGHTS_1", w1}});
  file.show({{"name", "a"}}), file.show({{"name", "b"}});
  file.json["skins"][0]["joints"] = {1, 2};
  file.json["nodes"][0]["skin"] = 0;
  const Scene scene = loadScene(put("a.gltf", file.text()));
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.influences, 8);
  EXPECT_EQ(mesh.weights[0], 0.25f);
  EXPECT_EQ(mesh.weights[7], 0.25f);
  EXPECT_EQ(mesh.joints[4], 1);
  EXPECT_EQ(mesh.weights[8], 1.0f);
  EXPECT_EQ(mesh.joints[16 + 3], 0);  // joint 9 does not exist, but has no weight
  EXPECT_TRUE(warned(scene, "1 vertices had no joint weights"));
  EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));  // skins without normals are common
  EXPECT_EQ(scene.nodes[0].skin, 0);
}

TEST_F(GltfGeometry, MorphTargetsMayBeSparse) {
  GltfFile file = triangleFile();
  const int at = file.view<std::uint16_t>({2});
  const int value = file.view<float>({0, 0, 7});
  const int sparse = file.add("accessors", {{"componentType", 5126},
                                            {"count", 3},
                                            {"type", "VEC3"},
                                            {"sparse",
                                             {{"count", 1},
                                              {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                              {"values", {{"bufferView", value}}}}}});
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", sparse}}, {{"POSITION", 0}}};
  file.json["meshes"][0]["weights"] = {0.5};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  ASSERT_EQ(scene.meshes[0].morph_targets.size(), 2u);
  EXPECT_EQ(scene.meshes[0].morph_targets[0].positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 0}, {0, 0, 7}}));
  EXPECT_EQ(scene.nodes[0].morph_weights, (std::vector<float>{0.5f, 0.0f}));
}

}  // namespace
}  // namespace gloam::test
