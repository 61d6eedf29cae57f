// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A .glb as its two chunks: tests write one, bend it, and see what the reader says.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace gloam::test {

struct GlbChunks {
  nlohmann::json json;
  std::string binary;
};

inline GlbChunks readGlbChunks(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  return {nlohmann::json::parse(bytes.substr(20, length)), bytes.substr(20 + length + 8)};
}

inline void writeGlbChunks(const GlbChunks& glb, const std::filesystem::path& path) {
  std::string text = glb.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::ofstream file(path, std::ios::binary);
  const auto word = [&](std::size_t value) {
    const std::uint32_t w = std::uint32_t(value);
    file.write(reinterpret_cast<const char*>(&w), 4);
  };
  file.write("glTF", 4);
  word(2);
  word(12 + 8 + text.size() + 8 + glb.binary.size());
  word(text.size());
  file << "JSON" << text;
  word(glb.binary.size());
  file.write("BIN\0", 4);
  file << glb.binary;
}

}  // namespace gloam::test
