// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam_read_one FILE: reads one scene or environment and answers in one line; exit 0 if it was read, 2 if it was refused.
// run_corpus calls it for every file of a folder, each in a process of its own.
#include <fmt/format.h>
#include <gloam/scene.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

namespace {

bool isPicture(const std::string& path) {
  for (const char* extension : {".hdr", ".exr", ".pic", ".HDR", ".EXR", ".PIC"})
    if (path.ends_with(extension)) return true;
  char start[4] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof start);
  const std::string magic(start, sizeof start);
  return magic == "\x76\x2f\x31\x01" || magic.starts_with("#?");
}

std::string readScene(const std::string& path) {
  const gloam::Scene scene = gloam::loadScene(path);
  std::size_t triangles = 0, vertices = 0;
  for (const gloam::Mesh& mesh : scene.meshes)
    triangles += mesh.triangleCount(), vertices += mesh.vertexCount();
  std::size_t drawn = 0;
  for (const float time_s :
       {0.0f, scene.duration_s() / 2.0f})  // what was read must also hold together in use
    drawn = gloam::pose(scene, time_s).instances.size();
  std::string warnings;
  for (const std::string& line : scene.warnings) warnings += "; " + line;
  return fmt::format("ok: {} triangles, {} vertices, {} instances, {} materials, {} textures{}", triangles,
                     vertices, drawn, scene.materials.size(), scene.textures.size(), warnings);
}

std::string readPicture(const std::string& path) {
  const gloam::Environment environment = gloam::loadEnvironment(path);
  std::string warnings;
  for (const std::string& line : environment.warnings) warnings += "; " + line;
  return fmt::format("ok: {} x {} pixels{}", environment.width, environment.height, warnings);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: gloam_read_one FILE\n", stderr);
    return 2;
  }
  const std::string path = arguments[1];
  try {
    std::puts((isPicture(path) ? readPicture(path) : readScene(path)).c_str());
    return 0;
  } catch (const gloam::Error& error) {
    std::puts(error.what());
    return 2;
  }  // anything else ends the process, and run_corpus counts it as a crash
}
