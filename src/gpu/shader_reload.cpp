// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/shader_reload.h"

#include <deque>
#include <map>
#include <mutex>

namespace gloam::gpu {
namespace {

struct Replacement {
  std::vector<std::uint32_t> words;
  ShaderCode code;
};

struct Shaders {
  std::mutex mutex;
  std::vector<const ShaderCode*> used;
  std::map<const ShaderCode*, const ShaderCode*> current;
  std::deque<Replacement> replacements;  // programs point into them
};

Shaders& shaders() {
  static Shaders all;
  return all;
}

}  // namespace

std::vector<const ShaderCode*> shadersInUse() {
  Shaders& all = shaders();
  const std::lock_guard lock(all.mutex);
  return all.used;
}

void replaceShader(const ShaderCode& code, std::vector<std::uint32_t> words) {
  Shaders& all = shaders();
  const std::lock_guard lock(all.mutex);
  Replacement& made = all.replacements.emplace_back(Replacement{std::move(words), code});
  made.code.words = made.words.data();
  made.code.word_count = made.words.size();
  all.current[&code] = &made.code;
}

const ShaderCode& currentShader(const ShaderCode& code) {
  Shaders& all = shaders();
  const std::lock_guard lock(all.mutex);
  const auto [entry, first] = all.current.try_emplace(&code, &code);
  if (first) all.used.push_back(&code);
  return *entry->second;
}

}  // namespace gloam::gpu
