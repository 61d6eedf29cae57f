// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A glTF file that has been taken apart and checked: JSON, structures, bytes.
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/read_budget.h"
#include "scene/tinygltf_unit.h"

namespace gloam {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// A file that passed the pre-pass. `model` holds the core of the format, `json` the same plus extensions: only members
/// that we know, all of the right type, all indices in range. Indices are the file's own. `model` has no buffers and no
/// images: bytes come from here. A model's `bufferView` of kNone or beyond json["bufferViews"] means "none".
class GltfDocument {
 public:
  explicit GltfDocument(const std::filesystem::path& path);

  nlohmann::json json;
  gloam_tinygltf::Model model;
  ReadBudget budget;

  const std::string& place() const { return place_; }
  /// Throws Error(file, "where: message"). `where` is a JSON path: accessors[3].count.
  [[noreturn]] void fail(const std::string& where, const std::string& message) const;
  /// Keeps a remark; the same one is kept once.
  void warn(const std::string& line);
  Warnings takeWarnings() { return std::move(warnings_); }

  /// The bytes of a buffer view, decompressed where it is EXT_meshopt_compression. They live as long as the document.
  ByteSpan view(int index);
  /// The encoded picture of images[index]: its view, data URI or file.
  ByteSpan image(int index);
  /// The named member of an object's "extensions", or null.
  static const nlohmann::json* extension(const nlohmann::json& object, const char* name);
  /// json[array], an empty array where the file has none.
  const nlohmann::json& array(const char* name) const;

 private:
  void readFile(const std::filesystem::path& path);
  void parse(std::string_view text);
  void checkVersionAndExtensions();
  void chargeObjects();
  void checkRanges();
  void buildModel();
  ByteSpan buffer(int index);
  ByteSpan uriBytes(const std::string& uri, const std::string& where, std::uint64_t at_most, Bytes& storage);
  ByteSpan range(ByteSpan bytes, std::uint64_t offset, std::uint64_t length, const std::string& where) const;

  std::string place_;
  std::filesystem::path folder_;
  Bytes file_;
  std::optional<ByteSpan> binary_chunk_;
  std::map<int, Bytes> buffers_, decompressed_, images_;
  Warnings warnings_;
};

/// Bytes of a "data:…;base64,…" or plain data URI. Throws Error(place, "where: …").
Bytes decodeDataUri(const std::string& uri, const std::string& place, const std::string& where);
/// %20 and the like as bytes.
std::string percentDecoded(const std::string& uri);

/// The two chunks of a .glb.
struct GlbChunks {
  std::string_view json;
  std::optional<ByteSpan> binary;
};
/// Throws Error. `warn` gets a line about what is ignored.
GlbChunks splitGlb(ByteSpan file, const std::string& place, Warnings& warnings);

}  // namespace gloam
