// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Files compressed by the tests themselves, with the libraries' encoders.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>

#include "scene/gltf_test_files.h"

namespace gloam::test {
namespace {

using GltfCompression = SceneFileTest;

/// A bumpy grid of 20 x 20 vertices.
struct Grid {
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;
  Grid() {
    constexpr std::uint32_t n = 20;
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t x = 0; x < n; ++x) {
        positions.insert(positions.end(), {x * 0.5f, y * 0.5f, std::sin(0.3f * x) * std::cos(0.2f * y)});
        const glm::vec3 normal = glm::normalize(glm::vec3(x * 0.1f - 1.0f, y * 0.05f, 2.0f));
        normals.insert(normals.end(), {normal.x, normal.y, normal.z, 0.0f});
        if (x + 1 < n && y + 1 < n) {
          const std::uint32_t i = y * n + x;
          indices.insert(indices.end(), {i, i + 1, i + n, i + 1, i + n + 1, i + n});
        }
      }
  }
  std::size_t vertexCount() const { return positions.size() / 3; }
};

Bytes encodeVertices(const void* data, std::size_t count, std::size_t stride) {
  Bytes out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), data, count, stride));
  return out;
}

/// Adds a compressed view whose plain form would lie in a fallback buffer without any data.
int meshoptView(GltfFile& file, const Bytes& compressed, std::size_t count, std::size_t stride,
                const char* mode, const char* filter = nullptr) {
  const int source = file.view(compressed);
  Json extension = file.json["bufferViews"][static_cast<std::size_t>(source)];
  extension.update({{"byteStride", stride}, {"count", count}, {"mode", mode}});
  if (filter) extension["filter"] = filter;
  file.json["buffers"][1] = {{"byteLength", 1000000},
                             {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
  return file.add("bufferViews", {{"buffer", 1},
                                  {"byteLength", count * stride},
                                  {"extensions", {{"EXT_meshopt_compression", extension}}}});
}

GltfFile meshoptFile(const Grid& grid, bool filters) {
  GltfFile file;
  const std::size_t n = grid.vertexCount();
  std::vector<float> exponential(grid.positions.size());
  meshopt_encodeFilterExp(exponential.data(), n, 12, 24, grid.positions.data());
  std::vector<std::int8_t> octahedral(4 * n);
  meshopt_encodeFilterOct(octahedral.data(), n, 4, 8, grid.normals.data());
  const Bytes positions = encodeVertices(filters ? exponential.data() : grid.positions.data(), n, 12);
  Bytes triangles(meshopt_encodeIndexBufferBound(grid.indices.size(), n));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), grid.indices.data(),
                                             grid.indices.size()));
  const int p = meshoptView(file, positions, n, 12, "ATTRIBUTES", filters ? "EXPONENTIAL" : nullptr);
  const int i = meshoptView(file, triangles, grid.indices.size(), 4, "TRIANGLES");
  const int o = meshoptView(file, encodeVertices(octahedral.data(), n, 4), n, 4, "ATTRIBUTES", "OCTAHEDRAL");
  file.json["bufferViews"][static_cast<std::size_t>(o)]["byteStride"] = 4;
  file.json["accessors"] = {
      {{"bufferView", p}, {"componentType", 5126}, {"count", n}, {"type", "VEC3"}},
      {{"bufferView", i}, {"componentType", 5125}, {"count", grid.indices.size()}, {"type", "SCALAR"}},
      {{"bufferView", o}, {"componentType", 5120}, {"count", n}, {"type", "VEC3"}, {"normalized", true}}};
  file.primitive({{"POSITION", 0}, {"NORMAL", 2}}, 1);
  file.json["extensionsUsed"] =
      file.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  return file;
}

TEST_F(GltfCompression, MeshoptViewsWithAndWithoutFilters) {
  const Grid grid;
  for (const bool filters : {false, true}) {
    const Mesh mesh = loadScene(put("a.glb", meshoptFile(grid, filters).glb())).meshes.at(0);
    ASSERT_EQ(mesh.vertexCount(), grid.vertexCount());
    ASSERT_EQ(mesh.indices.size(), grid.indices.size());
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mesh.positions[i][c], grid.positions[3 * i + static_cast<std::size_t>(c)],
                    filters ? 1e-5f : 0.0f);
        EXPECT_NEAR(mesh.normals[i][c], grid.normals[4 * i + static_cast<std::size_t>(c)], 0.02f);
      }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)  // the coder may turn triangles round
      EXPECT_EQ(mesh.indices[i] + mesh.indices[i + 1] + mesh.indices[i + 2],
                grid.indices[i] + grid.indices[i + 1] + grid.indices[i + 2]);
  }
}

TEST_F(GltfCompression, MeshoptIndexSequences) {
  const Grid grid;
  GltfFile file;
  const int positions = file.accessor(grid.positions, "VEC3");
  Bytes sequence(meshopt_encodeIndexSequenceBound(grid.indices.size(), grid.vertexCount()));
  sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), grid.indices.data(),
                                              grid.indices.size()));
  const int view = meshoptView(file, sequence, grid.indices.size(), 2, "INDICES");
  const int indices = file.add(
      "accessors",
      {{"bufferView", view}, {"componentType", 5123}, {"count", grid.indices.size()}, {"type", "SCALAR"}});
  file.primitive({{"POSITION", positions}}, indices);
  EXPECT_EQ(loadScene(put("a.glb", file.glb())).meshes.at(0).triangleCount(), grid.indices.size() / 3);
}

TEST_F(GltfCompression, CorruptMeshoptDataIsRefused) {
  const GltfFile good = meshoptFile(Grid(), true);
  GltfFile file = good;
  file.buffer[0] ^= 0xff;
  EXPECT_NE(refusal(put("a.glb", file.glb())).find("bufferViews[1]: corrupt EXT_meshopt_compression data"),
            std::string::npos);
  const auto extensionOf = [](GltfFile& f, int view) -> Json& {
    return f.json["bufferViews"][static_cast<std::size_t>(view)]["extensions"]["EXT_meshopt_compression"];
  };
  const auto refused = [&](const char* member, const Json& value, const char* words) {
    GltfFile bent = good;
    extensionOf(bent, 1)[member] = value;
    EXPECT_NE(refusal(put("a.glb", bent.glb())).find(words), std::string::npos)
        << member << ": " << refusal(put("a.glb", bent.glb()));
  };
  refused("count", 99999999, "EXT_meshopt_compression.count");
  refused("byteStride", 300, "byteStride");
  refused("byteLength", 4000000000u, "lie beyond buffers[0]");
  refused("mode", "ZIP", "one of ATTRIBUTES TRIANGLES INDICES");
  refused("filter", "QUATERNION", "8 was expected for ATTRIBUTES QUATERNION");
  GltfFile huge = good;  // consistent, and far more than the file can justify
  extensionOf(huge, 1)["count"] = 400000000;
  huge.json["bufferViews"][1]["byteLength"] = 4800000000;
  EXPECT_NE(refusal(put("a.glb", huge.glb())).find("would need"), std::string::npos);
}

Bytes dracoBytes(const Grid& grid) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(grid.indices.size() / 3));
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  for (std::size_t t = 0; t < grid.indices.size() / 3; ++t) {
    const auto at = [&](const std::vector<float>& array, std::size_t corner, std::size_t stride) {
      return &array[stride * grid.indices[3 * t + corner]];
    };
    const draco::FaceIndex face(static_cast<std::uint32_t>(t));
    builder.SetAttributeValuesForFace(position, face, at(grid.positions, 0, 3), at(grid.positions, 1, 3),
                                      at(grid.positions, 2, 3));
    builder.SetAttributeValuesForFace(normal, face, at(grid.normals, 0, 4), at(grid.normals, 1, 4),
                                      at(grid.normals, 2, 4));
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

GltfFile dracoFile(const Grid& grid, const Bytes& data) {
  GltfFile file;
  const int view = file.view(data);
  const std::size_t n = grid.vertexCount();
  file.json["accessors"] = {{{"componentType", 5126}, {"count", n}, {"type", "VEC3"}},
                            {{"componentType", 5126}, {"count", n}, {"type", "VEC3"}},
                            {{"componentType", 5123}, {"count", grid.indices.size()}, {"type", "SCALAR"}}};
  file.primitive({{"POSITION", 0}, {"NORMAL", 1}}, 2)["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

TEST_F(GltfCompression, DracoPrimitives) {
  const Grid grid;
  const Mesh mesh = loadScene(put("a.glb", dracoFile(grid, dracoBytes(grid)).glb())).meshes.at(0);
  EXPECT_EQ(mesh.triangleCount(), grid.indices.size() / 3);
  ASSERT_EQ(mesh.vertexCount(), grid.vertexCount());
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {  // Draco reorders: find each by x and y
    const glm::vec3 p = mesh.positions[i];
    const auto at = static_cast<std::size_t>(std::lround(p.y * 2.0f) * 20 + std::lround(p.x * 2.0f));
    ASSERT_LT(at, grid.vertexCount());
    EXPECT_NEAR(p.z, grid.positions[3 * at + 2], 2e-3f);
    EXPECT_NEAR(mesh.normals[i].x, grid.normals[4 * at], 1e-2f);
  }
}

TEST_F(GltfCompression, CorruptDracoDataIsReadOrRefusedButNeverCrashes) {
  const Grid grid;
  const Bytes good = dracoBytes(grid);
  std::uint32_t random = 1;
  for (int i = 0; i < 300; ++i) {
    Bytes bad = good;
    for (int k = 0; k < 3; ++k) {
      random = random * 1664525u + 1013904223u;
      bad[random % bad.size()] = static_cast<std::uint8_t>(random >> 24);
    }
    if (i % 10 == 0) bad.resize(random % bad.size() + 1);
    refusal(put("a.glb", dracoFile(grid, bad).glb()));
  }
}

TEST_F(GltfCompression, DracoClaimsAreHeldAgainstTheFile) {
  const Grid grid;
  Bytes bad = dracoBytes(grid);
  // Behind the header of 11 bytes and the traversal's kind stand the counts; claim four billion vertices.
  for (std::size_t i = 12; i < 16; ++i) bad[i] = 0xff;
  bad[16] = 0x0f;
  EXPECT_NE(refusal(put("a.glb", dracoFile(grid, bad).glb())).find("would need"), std::string::npos);
  bad = dracoBytes(grid);
  bad[5] = 1;
  EXPECT_NE(refusal(put("a.glb", dracoFile(grid, bad).glb())).find("bitstream 2.2 was expected"),
            std::string::npos);
  GltfFile file = dracoFile(grid, dracoBytes(grid));
  file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
           ["NORMAL"] = 77;
  EXPECT_NE(refusal(put("a.glb", file.glb())).find("there is no attribute 77"), std::string::npos);
}

}  // namespace
}  // namespace gloam::test
