// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Opening a glTF file: container, JSON, pre-pass, tinygltf's structures; bytes are fetched when they are asked for.
#include "scene/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "image/limits.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_schema.h"

namespace gloam {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kRead[] = {"KHR_lights_punctual",
                                      "KHR_texture_transform",
                                      "KHR_mesh_quantization",
                                      "KHR_draco_mesh_compression",
                                      "KHR_materials_emissive_strength",
                                      "KHR_materials_pbrSpecularGlossiness",
                                      "KHR_materials_specular",
                                      "KHR_materials_unlit",
                                      "KHR_node_visibility",
                                      "EXT_meshopt_compression",
                                      "EXT_mesh_gpu_instancing",
                                      "EXT_lights_image_based",
                                      "GLOAM_precomputed_transfer",
                                      "GLOAM_neighbourhood_transfer",
                                      "GLOAM_volume",
                                      "KHR_materials_variants"};  // the default variant is shown
/// They say nothing about the picture.
constexpr std::string_view kSilent[] = {"KHR_xmp", "KHR_xmp_json_ld", "KHR_texture_basisu"};

bool contains(const auto& list, std::string_view word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

/// The readers that follow recurse over JSON; a file must not choose how deep.
bool nestedTooDeep(std::string_view text) {
  constexpr int kDeepest = 100;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

/// Extensions are read from our own JSON; tinygltf would make a large value of every number in them.
void stripExtensions(Json& value) {
  if (value.is_object())
    for (const char* name : {"extensions", "extras"}) value.erase(name);
  if (value.is_structured())
    for (Json& member : value) stripExtensions(member);
}

/// nlohmann's messages without "[json.exception.parse_error.101] ".
std::string withoutPrefix(const std::string& message) {
  const std::size_t end = message.starts_with("[json.exception") ? message.find("] ") : std::string::npos;
  return end == std::string::npos ? message : message.substr(end + 2);
}

}  // namespace

GltfDocument::GltfDocument(const std::filesystem::path& path)
    : budget(path.string()), place_(path.string()), folder_(path.parent_path()) {
  file_ = readBytes(path);
  budget.addInput(file_.size());
  if (std::string_view(reinterpret_cast<const char*>(file_.data()), std::min<std::size_t>(4, file_.size())) ==
      "glTF") {
    const GlbChunks chunks = splitGlb(file_, place_, warnings_);
    binary_chunk_ = chunks.binary;
    parse(chunks.json);
  } else {
    parse({reinterpret_cast<const char*>(file_.data()), file_.size()});
    Bytes().swap(file_);
  }
  checkVersionAndExtensions();
  checkAgainstSchema(json, place_);
  chargeObjects();
  checkRanges();
  buildModel();
}

void GltfDocument::fail(const std::string& where, const std::string& message) const {
  throw Error(place_, where + ": " + message);
}

void GltfDocument::warn(const std::string& line) {
  const std::string clean = oneLine(line);
  if (!contains(warnings_, clean)) warnings_.push_back(clean);
}

const Json* GltfDocument::extension(const Json& object, const char* name) {
  const auto all = object.find("extensions");
  if (all == object.end()) return nullptr;
  const auto found = all->find(name);
  return found == all->end() ? nullptr : &*found;
}

const Json& GltfDocument::array(const char* name) const {
  static const Json empty = Json::array();
  const auto found = json.find(name);
  return found == json.end() ? empty : *found;
}

void GltfDocument::parse(std::string_view text) {
  while (!text.empty() && text.back() == '\0')
    text.remove_suffix(1);  // some writers pad the chunk with zeros
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string_view::npos || text[first] != '{')
    throw Error(place_,
                "neither .glb (it would start with 'glTF') nor a JSON object (it would start with '{')");
  if (nestedTooDeep(text)) throw Error(place_, "JSON: nested deeper than 100 levels");
  try {
    json = Json::parse(text.begin(), text.end());
  } catch (const Json::exception& error) {
    throw Error(place_, "JSON: " + oneLine(withoutPrefix(error.what())));
  }
}

void GltfDocument::checkVersionAndExtensions() {
  const auto asset = json.find("asset");
  if (asset == json.end() || !asset->is_object()) fail("asset", "missing: this is not a glTF file");
  const auto versionOf = [&](const char* field, const std::string& otherwise) {
    const auto found = asset->find(field);
    return found != asset->end() && found->is_string() ? found->get<std::string>() : otherwise;
  };
  const std::string version = versionOf("version", ""), least = versionOf("minVersion", "2.0");
  if (!version.starts_with("2."))
    fail("asset.version", "glTF 2.0 is read, found \"" + oneLine(version) + "\"");
  if (least != "2.0") fail("asset.minVersion", "glTF 2.0 is read, found \"" + oneLine(least) + "\"");

  for (const Json& name : array("extensionsRequired")) {
    if (!name.is_string()) continue;  // the schema tells
    const std::string& word = name.get_ref<const std::string&>();
    if (word == "KHR_texture_basisu")
      fail("extensionsRequired", "KHR_texture_basisu: KTX2 pictures are not read");
    if (!contains(kRead, word) && !contains(kSilent, word))
      fail("extensionsRequired", oneLine(word) + " is not supported");
  }
  for (const Json& name : array("extensionsUsed"))
    if (name.is_string() && !contains(kRead, name.get<std::string>()) &&
        !contains(kSilent, name.get<std::string>()))
      warn("extension " + oneLine(name.get<std::string>()) + " is left out");
}

void GltfDocument::buildModel() {
  // tinygltf insists on loading buffers and pictures, and refuses two valid things: indices without a buffer view (Draco)
  // and channels without a node. It is shown a copy without the former and with stand-ins for the latter.
  Json buffers = std::move(json["buffers"]), images = std::move(json["images"]);
  Json copy = json;
  json["buffers"] = buffers.is_array() ? std::move(buffers) : Json::array();
  json["images"] = images.is_array() ? std::move(images) : Json::array();
  for (const char* name : {"buffers", "images"}) copy.erase(name);
  stripExtensions(copy);
  const std::size_t views = array("bufferViews").size();
  copy["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
  if (copy.contains("accessors"))
    for (Json& accessor : copy["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = views;
  if (copy.contains("animations"))
    for (Json& animation : copy["animations"])
      for (Json& channel : animation["channels"])
        if (!channel["target"].contains("node")) channel["target"]["node"] = kNone;

  const std::string text = copy.dump();
  if (text.size() > 0xffffffffu) fail("JSON", "longer than 4 GB");
  std::string error, warning;
  gloam_tinygltf::TinyGLTF loader;
  if (!loader.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                  "", gloam_tinygltf::NO_REQUIRE))
    throw Error(place_, oneLine(error));
  model.bufferViews.pop_back();
}

ByteSpan GltfDocument::range(ByteSpan bytes, std::uint64_t offset, std::uint64_t length,
                             const std::string& where) const {
  if (offset > bytes.size() || length > bytes.size() - offset)
    fail(where, fmt::format("bytes {} to {} lie beyond the {} bytes of its buffer", offset, offset + length,
                            bytes.size()));
  return bytes.subspan(offset, length);
}

ByteSpan GltfDocument::uriBytes(const std::string& uri, const std::string& where, std::uint64_t at_most,
                                Bytes& storage) {
  if (uri.starts_with("data:")) {
    storage = decodeDataUri(uri, place_, where);
  } else if (uri.find("://") != std::string::npos) {
    fail(where, "only files and data URIs are read, found \"" + oneLine(uri.substr(0, 60)) + "\"");
  } else {
    std::error_code ignored;
    std::filesystem::path path = folder_ / percentDecoded(uri);
    if (!std::filesystem::exists(path, ignored)) {  // names that were never escaped, or that Windows wrote
      std::string plain = uri;
      std::replace(plain.begin(), plain.end(), '\\', '/');
      if (std::filesystem::exists(folder_ / plain, ignored)) path = folder_ / plain;
    }
    try {
      storage = readBytes(path);
    } catch (const Error& error) {
      fail(where, error.what());
    }
    budget.addInput(std::min<std::uint64_t>(storage.size(), at_most));
  }
  return storage;
}

ByteSpan GltfDocument::buffer(int index) {
  const std::string where = fmt::format("buffers[{}]", index);
  const Json& buffer = json["buffers"][static_cast<std::size_t>(index)];
  const std::uint64_t length = buffer["byteLength"];
  ByteSpan bytes;
  if (const auto known = buffers_.find(index); known != buffers_.end()) {
    bytes = known->second;
  } else if (buffer.contains("uri")) {
    bytes = uriBytes(buffer["uri"], where + ".uri", length, buffers_[index]);
  } else if (index == 0 && binary_chunk_) {
    bytes = *binary_chunk_;
  } else {
    fail(where + ".uri", "missing, and there is no binary chunk for it");
  }
  if (bytes.size() < length)
    fail(where + ".byteLength", fmt::format("{} bytes were expected, {} are there", length, bytes.size()));
  return bytes.first(length);
}

ByteSpan GltfDocument::view(int index) {
  const Json& view = json["bufferViews"][static_cast<std::size_t>(index)];
  const std::string where = fmt::format("bufferViews[{}]", index);
  const auto bytesOf = [&](const Json& source) {
    return range(buffer(source["buffer"]), source.value("byteOffset", std::uint64_t(0)), source["byteLength"],
                 where);
  };
  const Json* meshopt = extension(view, "EXT_meshopt_compression");
  if (!meshopt) return bytesOf(view);
  const auto known = decompressed_.find(index);
  if (known != decompressed_.end()) return known->second;
  return decompressed_[index] = decodeMeshopt(*this, bytesOf(*meshopt), *meshopt, where);
}

ByteSpan GltfDocument::image(int index) {
  const Json& image = json["images"][static_cast<std::size_t>(index)];
  const std::string where = fmt::format("images[{}]", index);
  if (image.contains("bufferView")) return view(image["bufferView"]);
  if (image.contains("uri")) return uriBytes(image["uri"], where + ".uri", UINT64_MAX, images_[index]);
  fail(where, "neither uri nor bufferView");
}

}  // namespace gloam
