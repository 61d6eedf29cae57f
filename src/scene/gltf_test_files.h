// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// glTF files that tests write themselves: JSON that a test may bend as it likes, and one buffer.
#pragma once

#include <gloam/scene.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace gloam::test {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

/// A folder for the files of one test; gone afterwards.
class SceneFileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::string put(const std::string& name, const Bytes& bytes) const {
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path(name).string();
  }
  std::string put(const std::string& name, const std::string& text) const {
    return put(name, Bytes(text.begin(), text.end()));
  }

 private:
  const std::filesystem::path folder_ =
      (std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path()) /
      std::filesystem::path("gloam_scene_test_" + std::to_string(getpid()));
};

inline std::string base64(const Bytes& bytes) {
  const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k < bytes.size() + 1 ? alphabet[bits >> (18 - 6 * k) & 63] : '=');
  }
  return out;
}

/// Builds a file from its arrays on. json is the whole document; text() and glb() add the buffer to it.
struct GltfFile {
  Json json = {{"asset", {{"version", "2.0"}}}};
  Bytes buffer;

  template <typename T>
  int view(const std::vector<T>& values, int stride = 0) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride) view["byteStride"] = stride;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    buffer.insert(buffer.end(), bytes, bytes + values.size() * sizeof(T));
    return add("bufferViews", view);
  }
  template <typename T>
  static int componentType() {
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    return std::is_same_v<T, std::uint32_t> ? 5125 : 5126;
  }
  /// `type` is SCALAR, VEC3 …; the count follows from the number of values.
  template <typename T>
  int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const std::size_t n = type == "SCALAR"          ? 1
                          : type.starts_with("MAT") ? 16
                                                    : static_cast<std::size_t>(type[3] - '0');
    Json accessor = {{"bufferView", view(values)},
                     {"componentType", componentType<T>()},
                     {"count", values.size() / n},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return add("accessors", accessor);
  }
  int add(const char* array, const Json& value) {
    json[array].push_back(value);
    return static_cast<int>(json[array].size()) - 1;
  }
  /// A mesh of one primitive, shown by a node of its own in the scene.
  Json& primitive(const Json& attributes, int indices = kNone) {
    Json p = {{"attributes", attributes}};
    if (indices != kNone) p["indices"] = indices;
    const int mesh = add("meshes", {{"primitives", Json::array({p})}});
    show({{"mesh", mesh}});
    return json["meshes"].back()["primitives"][0];
  }
  int show(const Json& node) {
    const int index = add("nodes", node);
    json["scene"] = 0;
    json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  std::string text() const {
    Json whole = json;
    if (!buffer.empty()) {
      whole["buffers"][0]["byteLength"] = buffer.size();
      whole["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(buffer);
    }
    return whole.dump();
  }
  Bytes glb() const {
    Json whole = json;
    if (!buffer.empty()) whole["buffers"][0]["byteLength"] = buffer.size();
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    Bytes data = buffer;
    data.resize((data.size() + 3) / 4 * 4, 0);
    Bytes out;
    const auto word = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    word(0x46546c67), word(2), word(28 + text.size() + data.size());
    word(text.size()), word(0x4e4f534a), out.insert(out.end(), text.begin(), text.end());
    word(data.size()), word(0x004e4942), out.insert(out.end(), data.begin(), data.end());
    return out;
  }
};

/// A triangle (0,0,0) (1,0,0) (0,1,0) that faces +Z.
inline GltfFile triangleFile() {
  GltfFile file;
  const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int indices = file.accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
  file.primitive({{"POSITION", positions}}, indices);
  return file;
}

/// A unit square in the plane z = 0 that faces +Z, two triangles, with texture coordinates as glTF has them: u to the
/// right, v down.
inline GltfFile squareFile() {
  GltfFile file;
  const int positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  const int normals = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int uv = file.accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  const int indices = file.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  file.primitive({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}}, indices);
  return file;
}

/// A 2 x 1 PNG: a red pixel, then a half transparent green one. Written with stored (uncompressed) deflate.
inline Bytes tinyPng() {
  const auto crc = [](const std::string& data) {
    std::uint32_t c = 0xffffffffu;
    for (const char byte : data) {
      c ^= static_cast<unsigned char>(byte);
      for (int k = 0; k < 8; ++k) c = c & 1 ? c >> 1 ^ 0xedb88320u : c >> 1;
    }
    return ~c;
  };
  const auto word = [](std::uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                       static_cast<char>(v)};
  };
  std::string png = "\x89PNG\r\n\x1a\n";
  const auto chunk = [&](const std::string& name, const std::string& data) {
    png += word(static_cast<std::uint32_t>(data.size())) + name + data + word(crc(name + data));
  };
  chunk("IHDR", word(2) + word(1) + std::string{8, 6, 0, 0, 0});
  const std::string row = {0, '\xff', 0, 0, '\xff', 0, '\xff', 0, '\x80'};
  std::uint32_t a = 1, b = 0;
  for (const char byte : row) a = (a + static_cast<unsigned char>(byte)) % 65521, b = (b + a) % 65521;
  const auto length = static_cast<char>(row.size());
  chunk("IDAT",
        std::string{0x78, 0x01, 1, length, 0, static_cast<char>(~length), '\xff'} + row + word(b << 16 | a));
  chunk("IEND", "");
  return Bytes(png.begin(), png.end());
}

/// True where a warning of the scene contains the words.
inline bool warned(const Scene& scene, const std::string& words) {
  for (const std::string& line : scene.warnings)
    if (line.find(words) != line.npos) return true;
  return false;
}

/// The message of the Error that loading throws, "" where it throws none. Anything but one line fails the test.
inline std::string refusal(const std::string& path) {
  try {
    loadScene(path);
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    EXPECT_FALSE(message.empty());
    return message;
  }
  return "";
}

}  // namespace gloam::test
