// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A .glb under construction: its JSON and its one buffer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gloam {

class GlbBuilder {
 public:
  enum class Target { kNone = 0, kVertices = 34962, kIndices = 34963 };

  nlohmann::json root = nlohmann::json::object();

  /// Appends to a top-level array ("materials") and returns the index.
  int add(const char* array, nlohmann::json object);
  /// Notes an extension in extensionsUsed.
  void use(const std::string& extension) { extensions_.insert(extension); }

  /// Copies bytes into the buffer, aligned to 4.
  int addView(std::span<const std::uint8_t> bytes, Target target = Target::kNone);
  /// `components` 1, 2, 3, 4 or 16 (a matrix); `bounds` adds min and max, which glTF asks for of positions and key times.
  int addFloats(std::span<const float> values, int components, Target target, bool bounds = false);
  int addBytes(std::span<const std::uint8_t> values, int components, Target target);
  int addShorts(std::span<const std::uint16_t> values, int components, Target target);
  /// Single numbers that no primitive uses, as floats or as 16-bit floats (of which 65504 is the largest) in shorts.
  int addNumbers(std::span<const float> values, bool half_float);
  /// The same, and the same accessor when these values, which stay where they are until save(), come again.
  int addSharedNumbers(std::span<const float> values, bool half_float);
  /// 16 bits an index where that suffices.
  int addIndices(std::span<const std::uint32_t> indices, std::size_t vertex_count);
  /// Zeros, which take no bytes.
  int addZeros(std::size_t count, int components, bool bounds);

  /// Writes header, JSON and buffer, beside the target first. Throws Error where that fails or the file would exceed 4 GiB.
  void save(const std::filesystem::path& path);

 private:
  int addAccessor(int view, int component_type, std::size_t count, int components);

  std::vector<std::uint8_t> binary_;
  std::set<std::string> extensions_;
  std::map<const float*, int> shared_;
};

/// The double that prints as shortly as the float and reads back as it.
double tidy(float value);
template <typename Vector>
nlohmann::json tidyArray(const Vector& v, int count) {
  nlohmann::json array = nlohmann::json::array();
  for (int i = 0; i < count; ++i) array.push_back(tidy(v[i]));
  return array;
}

}  // namespace gloam
