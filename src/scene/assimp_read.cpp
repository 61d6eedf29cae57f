// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/assimp_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "image/limits.h"
#include "scene/mesh_file_claims.h"
#include "scene/mesh_repair.h"
#include "scene/read_budget.h"
#include "scene/scene_check.h"
#include "scene/texture_decode.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

/// Where a picture may lie: as the file says, or beside the model (paths of the author's machine are common).
fs::path findPicture(const fs::path& model, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  std::error_code ignored;
  for (const fs::path& candidate :
       {model.parent_path() / name, model.parent_path() / fs::path(name).filename()})
    if (fs::is_regular_file(candidate, ignored)) return candidate;
  return {};
}

/// Decodes a texture that is still a name or encoded bytes; a white texel and a warning where that fails.
void decodeImported(Texture& texture, const fs::path& model, ReadBudget& budget, Warnings& warnings) {
  if (texture.width > 0) return;
  const std::string name = oneLine(texture.name);
  try {
    std::vector<std::uint8_t> bytes = std::move(texture.rgba);
    if (bytes.empty()) {
      const fs::path path = findPicture(model, texture.name);
      if (path.empty()) throw Error("there is no such file");
      bytes = readBytes(path);
      budget.addInput(bytes.size());
    }
    texture = decodeTexture(bytes, name, name, "picture", budget);
  } catch (const Error& error) {
    warnings.push_back(fmt::format("texture '{}' is drawn white: {}", name, error.what()));
    texture = Texture{name, 1, 1, {255, 255, 255, 255}};
  }
}

}  // namespace

bool assimpReads(const std::string& extension) {
  constexpr std::array<std::string_view, 5> kExtensions = {".obj", ".ply", ".off", ".fbx", ".3ds"};
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

void finishImport(Scene& scene, const fs::path& path) {
  checkScene(scene, path.string(), SceneStage::kImported);
  ReadBudget budget(path.string());
  std::error_code ignored;
  budget.addInput(fs::file_size(path, ignored));
  for (Texture& texture : scene.textures) decodeImported(texture, path, budget, scene.warnings);

  MeshRepairs repairs;
  std::vector<int> kept(scene.meshes.size(), kNone);
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    Mesh& mesh = scene.meshes[i];
    const std::string label = fmt::format("mesh {} ('{}')", i, oneLine(mesh.name));
    checkPositions(mesh, {}, path.string(), label);
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (!finishMesh(mesh, material, kSmoothCreaseRad, label, repairs)) continue;
    kept[i] = static_cast<int>(count);
    if (count != i) scene.meshes[count] = std::move(mesh);
    ++count;
  }
  scene.meshes.resize(count);
  for (std::string& line : repairs.lines()) scene.warnings.push_back(std::move(line));
  for (Node& node : scene.nodes) {
    for (int& mesh : node.meshes) mesh = kept[static_cast<std::size_t>(mesh)];
    std::erase(node.meshes, kNone);
  }
}

#if GLOAM_HAS_ASSIMP

Scene readWithAssimp(const fs::path& path, const Progress& progress) {
  progress.report(0.0, "reading " + path.filename().string());
  std::uint64_t size = 0;
  openForReading(path, &size);
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension == ".off") checkOffFile(path);
  if (extension == ".ply") checkPlyFile(path);
  const double seconds = 5.0 + static_cast<double>(size) / 1e6;
  const std::uint64_t bytes = (std::uint64_t(640) << 20) + 100 * size;
  Scene scene = importInChild(path, seconds, bytes, progress, importWithAssimp);
  progress.report(0.7, "computing what " + path.filename().string() + " lacks");
  finishImport(scene, path);
  progress.report(1.0, "reading " + path.filename().string());
  return scene;
}

#else

Scene readWithAssimp(const fs::path& path, const Progress&) {
  throw Error(path.string(), "gloam was built without assimp, which reads " + path.extension().string() +
                                 " (Debian: libassimp-dev); .gltf and .glb need nothing more");
}

#endif

}  // namespace gloam
