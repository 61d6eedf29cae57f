// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/assimp_read.h"

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "scene/gltf_test_files.h"
#include "scene/mesh_laws.h"
#if GLOAM_HAS_ASSIMP
#include "scene/assimp_parts.h"
#endif

namespace gloam::test {
namespace {

class AssimpRead : public SceneFileTest {
 protected:
  void SetUp() override {
    SceneFileTest::SetUp();
#if !GLOAM_HAS_ASSIMP
    const std::string message = refusal(put("a.obj", std::string("v 0 0 0\n")));
    EXPECT_NE(message.find("libassimp-dev"), std::string::npos);
    GTEST_SKIP() << "built without assimp";
#endif
  }
};

const char* kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

TEST_F(AssimpRead, ObjWithoutNormalsKeepsItsEdges) {
  const Scene scene = loadScene(put("a.obj", std::string(kCube)));
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].triangleCount(), 12u);
  EXPECT_EQ(scene.meshes[0].vertexCount(), 24u);
  EXPECT_NEAR(mesh_laws::signedVolume(scene.meshes[0]), 1.0, 1e-6);
  EXPECT_TRUE(scene.materials.at(static_cast<std::size_t>(scene.meshes[0].material)).double_sided);
}

TEST_F(AssimpRead, FilesWithoutFacesAndWideTextGetPlainWords) {
  EXPECT_NE(refusal(put("a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n"))).find("expected faces"),
            std::string::npos);
  const std::string wide("\xff\xfev\0 \0", 6);
  EXPECT_NE(refusal(put("b.obj", wide)).find("UTF-16"), std::string::npos);
}

TEST_F(AssimpRead, ObjMaterialsAndTextures) {
  put("paint.png", tinyPng());
  put("a.mtl", std::string("newmtl wall\nKd 0.5 0.25 0.125\nKs 1 1 1\nNs 126\nmap_Kd paint.png\nnewmtl "
                           "floor\nKd 1 0 0\nmap_Kd none.png\n"));
  const Scene scene =
      loadScene(put("a.obj", std::string("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                         "usemtl wall\nf 1/1 2/2 3/3\nusemtl floor\nf 1/1 3/3 2/2\n")));
  const Material *wall = nullptr, *floor = nullptr;
  for (const Material& m : scene.materials)
    (m.name == "wall" ? wall : floor) = m.name == "wall" || m.name == "floor" ? &m : floor;
  ASSERT_TRUE(wall && floor);
  EXPECT_EQ(wall->base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
  EXPECT_EQ(wall->metallic, 0.0f);
  EXPECT_NEAR(2.0f / std::pow(wall->roughness, 4.0f) - 2.0f, 126.0f, 0.1f);
  ASSERT_TRUE(wall->base_color_map && floor->base_color_map);
  EXPECT_EQ(scene.textures[static_cast<std::size_t>(wall->base_color_map.texture)].width, 2);
  EXPECT_TRUE(warned(scene, "texture 'none.png' is drawn white"));
  for (const Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i)  // v is down here and up there
      EXPECT_FLOAT_EQ(mesh.uv_sets.at(0)[i].y, 1.0f - mesh.positions[i].y);
}

TEST_F(AssimpRead, PlyAndOff) {
  const Scene ply = loadScene(
      put("a.ply", std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nproperty uchar red\nproperty uchar green\n"
                               "property uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n"
                               "end_header\n0 0 0 255 0 0\n1 0 0 188 0 0\n0 1 0 0 0 0\n3 0 1 2\n")));
  const Mesh& mesh = ply.meshes.at(0);
  ASSERT_EQ(mesh.colors.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(mesh.colors[i].r,
                mesh.positions[i].x == 1.0f   ? 0.503f
                : mesh.positions[i].y == 1.0f ? 0.0f
                                              : 1.0f,
                0.002f);  // sRGB 188 is half the light
  EXPECT_EQ(ply.materials[static_cast<std::size_t>(mesh.material)].base_color, glm::vec4(1.0f));
  const Scene off = loadScene(put("a.off", std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")));
  EXPECT_EQ(off.meshes.at(0).normals.at(0), glm::vec3(0, 0, 1));
}

TEST_F(AssimpRead, BrokenFilesGetOneLine) {
  EXPECT_NE(refusal(put("a.obj", std::string("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))), "");
  EXPECT_NE(refusal(put("a.obj", std::string("v 0 0 0\nf 1 2 3\n"))), "");
  EXPECT_NE(refusal(put("a.ply",
                        std::string("ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\n"
                                    "property float x\nproperty float y\nproperty float z\nend_header\n"))),
            "");
  EXPECT_NE(refusal(put("a.off", std::string("OFF\n4000000000 4000000000 0\n"))), "");
  EXPECT_NE(refusal(put("a.fbx", std::string("Kaydara FBX Binary  \0\x1a", 22))), "");
  EXPECT_NE(refusal(put("a.3ds", Bytes{0x4d, 0x4d, 0xff, 0xff, 0xff, 0xff})), "");
}

TEST_F(AssimpRead, OffFilesMustHoldWhatTheyClaim) {
  const std::string points = "0 0 0\n1 0 0 # to the right\n\n0 1 0\n";
  const auto says = [&](const std::string& text, const char* words) {
    const std::string message = refusal(put("a.off", text));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  says("OFF\n3 1 0\n" + points + "3 0 1 7\n", "face 0 names vertex 7, there are 3");
  says("OFF\n3 1 0\n" + points + "3 0 1 -1\n", "face 0 names vertex -1");
  says("OFF 3 2 0\n" + points + "3 0 1 2\n", "claims 2 faces, holds 1");
  says("OFF\n3 1 0\n" + points + "3 0 1\n", "face 0 holds 2 of its 3 vertices");
  says("OFF\n4000000000 1 0\n0 0 0\n", "claims 4000000000 vertices, holds 1");
  for (const char* header :
       {"OFF\n3 1 0\n", "OFF3 1 0\n", "# a comment\nOFF\n# another\n3 1 0\n", "OFF 3 1 0\n"})
    EXPECT_EQ(refusal(put("a.off", header + points + "3 0 1 2 255 0 0\n")), "") << header;
}

TEST_F(AssimpRead, PlyHeadersCannotClaimMoreThanTheFile) {
  const auto file = [](const char* format, const char* vertices, const char* faces) {
    return std::string("ply\nformat ") + format + " 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
  };
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* count : {"4294967295", "4000000000", "99999999999999999999999"}) {
      const std::string message = refusal(put("a.ply", file(format, count, "1")));
      EXPECT_NE(message.find("elements 'vertex', more than a file of"), std::string::npos) << message;
    }
    const std::string message = refusal(put("a.ply", file(format, "0", "4000000000")));
    EXPECT_NE(message.find("claims 4000000000 elements 'face'"), std::string::npos) << message;
  }
}

TEST_F(AssimpRead, RandomDamageIsReadOrRefusedInBoundedTime) {
  std::uint32_t random = 3;
  for (int i = 0; i < 40; ++i) {
    std::string bad = kCube;
    for (int k = 0; k < 4; ++k) {
      random = random * 1664525u + 1013904223u;
      bad[(random >> 4) % bad.size()] = static_cast<char>(random >> 24);
    }
    refusal(put("a.obj", bad));
  }
}

// ---- The child process: whatever happens there, this one goes on ------------------------------------------------------

Scene crash(const std::filesystem::path&) {
  std::abort();
}
Scene runForever(const std::filesystem::path&) {
  for (std::atomic<int> i = 0;; ++i) {
  }
}
Scene takeAllMemory(const std::filesystem::path&) {
  std::vector<std::vector<char>> blocks;
  for (;;) blocks.emplace_back(64 << 20, 'x');
}
Scene refuse(const std::filesystem::path& path) {
  throw Error(path.string(), "field 3: not a number");
}
Scene succeed(const std::filesystem::path& path) {
  Scene scene;
  scene.name = path.string();
  return scene;
}

std::string childRefusal(Scene (*work)(const std::filesystem::path&), double seconds = 5.0,
                         const Progress& progress = {}) {
  try {
    importInChild("file.obj", seconds, std::uint64_t(256) << 20, progress, work);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ImportInChild, GivesBackTheSceneOrTheError) {
  EXPECT_EQ(importInChild("file.obj", 5.0, 1 << 28, {}, succeed).name, "file.obj");
  EXPECT_EQ(childRefusal(refuse), "file.obj: field 3: not a number");
}

TEST(ImportInChild, CrashesTimeAndMemoryAreErrors) {
  EXPECT_EQ(childRefusal(crash),
            "file.obj: assimp crashed on it (signal " + std::to_string(SIGABRT) + "): the file is broken");
  EXPECT_NE(childRefusal(runForever, 1.0).find("was not done with it"), std::string::npos);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_NE(childRefusal(takeAllMemory).find("needed more than 268 MB"), std::string::npos);
#endif
  Progress stop;
  stop.should_stop = [] { return true; };
  EXPECT_THROW(importInChild("file.obj", 5.0, 1 << 28, stop, runForever), Interrupted);
}

#if GLOAM_HAS_ASSIMP
// 2 / DecayStart^2 with DecayStart 3000 cm, as the library hands it on: half of 30^2 candela, not of 3000^2.
TEST_F(AssimpRead, LampsFadeInMetresWhateverTheFileCountsIn) {
  aiScene source;
  source.mNumLights = 2;
  source.mLights = new aiLight*[2];
  for (unsigned i = 0; i < 2; ++i) {
    source.mLights[i] = new aiLight;
    source.mLights[i]->mType = aiLightSource_POINT;
    source.mLights[i]->mName = aiString(i == 0 ? "fades" : "does not");
    source.mLights[i]->mColorDiffuse = aiColor3D(1.0f, 1.0f, 1.0f);
    source.mLights[i]->mAttenuationQuadratic = i == 0 ? 2.0f / (3000.0f * 3000.0f) : 0.0f;
  }
  source.mMetaData = aiMetadata::Alloc(1);
  source.mMetaData->Set(0, "UnitScaleFactor", 1.0f);
  Scene scene;
  scene.nodes.resize(1);
  readAssimpCamerasAndLights(source, {}, scene);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_NEAR(scene.lights[0].intensity.x, 450.0f, 0.01f);
  EXPECT_EQ(scene.lights[1].intensity.x, 1.0f);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("'does not'"), std::string::npos);
}
#endif

}  // namespace
}  // namespace gloam::test
