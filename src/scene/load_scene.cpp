// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One door for all scenes: who reads what.
#include <fmt/format.h>
#include <gloam/scene.h>

#include <algorithm>
#include <fstream>
#include <new>

#include "image/limits.h"
#include "scene/assimp_read.h"
#include "scene/builtin_scenes.h"
#include "scene/gltf_read.h"
#include "scene/scene_check.h"
#include "scene/volume_files.h"

namespace gloam {
namespace {

constexpr std::string_view kBuiltin = "builtin:";

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

/// What the first bytes say: .glb, or JSON and so perhaps .gltf.
bool looksLikeGltf(const std::filesystem::path& path) {
  std::uint64_t size = 0;
  std::ifstream stream = openForReading(path, &size);
  char start[64] = {};
  stream.read(start, sizeof start);
  const std::string_view text(start, static_cast<std::size_t>(stream.gcount()));
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return text.starts_with("glTF") || (first != std::string_view::npos && text[first] == '{');
}

Scene readFile(const std::filesystem::path& path, const Progress& progress) {
  const bool gltf = looksLikeGltf(path);
  const std::string extension = lowerExtension(path);
  if (gltf || extension == ".gltf" || extension == ".glb") return readGltf(path, progress);
  if (assimpReads(extension)) return readWithAssimp(path, progress);
  throw Error(
      path.string(),
      fmt::format("not a scene that is read: .gltf, .glb, .obj, .ply, .off, .fbx, .3ds, .raw and .vdb are{}",
                  extension == ".hdr" || extension == ".exr" ? "; pass it as the environment" : ""));
}

/// Messages quote files, and files may quote anything.
std::string cleaned(std::string text) {
  constexpr std::size_t kLongest = 600;
  if (text.size() > kLongest) text.resize(kLongest);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace

Scene loadScene(const std::string& path_or_name, const Progress& progress) {
  if (path_or_name.starts_with(kBuiltin)) return makeBuiltinScene(path_or_name.substr(kBuiltin.size()));
  const std::filesystem::path path(path_or_name);
  try {
    Scene scene =
        namesVolumeFile(path_or_name) ? readVolumeScene(path_or_name, progress) : readFile(path, progress);
    checkScene(scene, path_or_name);
    if (scene.name.empty()) scene.name = path.stem().string();
    for (std::string& line : scene.warnings) line = cleaned(std::move(line));
    return scene;
  } catch (const Error& error) {
    throw Error(cleaned(error.what()));
  } catch (const Interrupted&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(cleaned(path_or_name), "there is not enough memory to read it");
  } catch (const std::exception& error) {  // a library's own: std::length_error and the like
    throw Error(cleaned(path_or_name), cleaned(error.what()));
  }
}

}  // namespace gloam
