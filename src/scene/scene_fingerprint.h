// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// 128 bits that tell contents apart: which bake is kept, whether a checkpoint belongs to this work. Every struct of a scene
// is taken apart by a structured binding that names all its members: one more member, and scene_fingerprint.cpp does not
// compile until it counts too.
#pragma once

#include <gloam/scene.h>

#include <string>
#include <type_traits>

namespace gloam {

/// Two multiply-and-rotate lanes over 64-bit words with a final mix (the 64-bit finaliser of MurmurHash3); not meant
/// against an adversary. Plain data: it may be written to a file as it is.
struct Fingerprint {
  std::uint64_t words[2] = {0x243f6a8885a308d3u, 0x13198a2e03707344u};  // digits of pi
  /// The size counts: "ab", "c" is not "a", "bc".
  void addBytes(const void* data, std::size_t size);
  /// 32 hexadecimal digits.
  std::string text() const;
  bool operator==(const Fingerprint&) const = default;
};

/// Types whose bytes are their value: no padding, no pointers.
template <class T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, glm::vec2> ||
    std::is_same_v<T, glm::vec3> || std::is_same_v<T, glm::vec4> || std::is_same_v<T, glm::uvec3> ||
    std::is_same_v<T, glm::ivec3> || std::is_same_v<T, glm::quat> || std::is_same_v<T, glm::mat3> ||
    std::is_same_v<T, glm::mat4>;

template <PlainValue T>
void add(Fingerprint& print, const T& value) {
  print.addBytes(&value, sizeof value);
}
void add(Fingerprint& print, const std::string& value);
template <PlainValue T>
void add(Fingerprint& print, const std::vector<T>& values) {
  print.addBytes(values.data(), values.size() * sizeof(T));
}

/// All but its warnings and its environment, which not everything sees.
void add(Fingerprint& print, const Scene& scene);
/// All but its warnings.
void add(Fingerprint& print, const Environment& environment);
void add(Fingerprint& print, const PosedScene& posed);
void add(Fingerprint& print, const PosedCamera& camera);

template <class... Members>
void addAll(Fingerprint& print, const Members&... members) {
  (add(print, members), ...);
}

}  // namespace gloam
