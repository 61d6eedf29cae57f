// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "shader_watch.h"

#include <fmt/core.h>
#include <gloam/error.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "gpu/shader_reload.h"
#include "image/child_process.h"

namespace gloam::view {
namespace {

namespace fs = std::filesystem;

/// The file, and all that it includes by `#include "room/name"`.
void addWithIncludes(const fs::path& folder, const fs::path& file, std::set<fs::path>& found) {
  if (!found.insert(file).second) return;
  std::ifstream in(folder / file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("#include")) continue;
    const std::size_t first = line.find('"'), last = line.rfind('"');
    if (first == last) continue;
    const fs::path included = line.substr(first + 1, last - first - 1);
    if (fs::exists(folder / included)) addWithIncludes(folder, included, found);
  }
}

/// A folder that goes with this object.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "gloam-shaders-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(name, std::error_code(errno, std::generic_category()).message());
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<std::uint32_t> readWords(const fs::path& file) {
  std::vector<std::uint32_t> words(fs::file_size(file) / sizeof(std::uint32_t));
  std::ifstream(file, std::ios::binary)
      .read(reinterpret_cast<char*>(words.data()), std::streamsize(words.size() * sizeof(std::uint32_t)));
  return words;
}

/// "comp" of "frame/frame_shade.comp.glsl".
std::string stageOf(const fs::path& source) {
  return source.stem().extension().string().substr(1);
}

}  // namespace

ShaderWatch::ShaderWatch(fs::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty() && !fs::is_directory(folder_ / "gpu"))
    throw Error(folder_.string(), "expected the src folder of gloam's source tree (--watch-shaders)");
}

const std::set<fs::path>& ShaderWatch::filesOf(const gpu::ShaderCode& code) {
  auto& files = files_[&code];
  if (files.empty()) addWithIncludes(folder_, code.source, files);
  return files;
}

std::vector<const gpu::ShaderCode*> ShaderWatch::changed() {
  std::vector<const gpu::ShaderCode*> stale;
  if (folder_.empty()) return stale;
  std::set<fs::path> newer;
  for (const gpu::ShaderCode* code : gpu::shadersInUse()) {
    if (code->source == nullptr) continue;
    for (const fs::path& file : filesOf(*code)) {
      std::error_code gone;  // while an editor exchanges it
      const auto time = fs::last_write_time(folder_ / file, gone);
      if (gone) continue;
      const auto [known, first] = times_.try_emplace(file, time);
      if (known->second != time) newer.insert(file);
      known->second = time;
    }
  }
  if (newer.empty()) return stale;
  for (auto& [code, files] : files_) {
    const bool uses = std::ranges::any_of(files, [&](const fs::path& file) { return newer.contains(file); });
    if (!uses) continue;
    stale.push_back(code);
    files.clear();  // it may include others now
  }
  return stale;
}

void ShaderWatch::reload(const fs::path& folder, const gpu::ShaderCode& code) {
  const Scratch scratch;
  const fs::path words = scratch.path() / "words.spv";
  try {
    ChildProcess compiler({"glslc", "-O", "-g", "--target-env=vulkan1.3",
                           "-fshader-stage=" + stageOf(code.source), "-Werror", "-I" + folder.string(), "-o",
                           words.string(), (folder / code.source).string()});
    if (compiler.wait() != 0) throw Error(code.source, compiler.firstWords());
  } catch (const std::system_error& error) {
    throw Error("glslc",
                fmt::format("cannot be started ({}): install the package glslc", error.code().message()));
  }
  gpu::replaceShader(code, readWords(words));
}

}  // namespace gloam::view
