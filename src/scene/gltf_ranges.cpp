// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the schema cannot say: how much a file asks for, and whether the ranges in it lie in one another.
#include <fmt/format.h>

#include "scene/gltf_accessors.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_document.h"

namespace gloam {

using Json = nlohmann::json;

void GltfDocument::chargeObjects() {
  // "{}," is three bytes in the file and about a thousand in memory, taken together in all structures that hold it.
  const auto charge = [&](const char* name, std::uint64_t bytes, const char* inside = nullptr) {
    std::uint64_t count = array(name).size();
    for (const Json& object : array(name))
      if (inside) count += object[inside].size();
    budget.charge(count, bytes, name);
  };
  charge("nodes", 1500), charge("materials", 4000), charge("accessors", 600), charge("bufferViews", 400);
  charge("meshes", 1500, "primitives"), charge("animations", 1500, "channels"), charge("textures", 600);
  charge("cameras", 1000), charge("skins", 600), charge("scenes", 400), charge("samplers", 400);
}

void GltfDocument::checkRanges() {
  for (std::size_t i = 0; i < array("cameras").size(); ++i) {
    const Json& camera = json["cameras"][i];
    const auto& type = camera["type"].get_ref<const std::string&>();
    if (!camera.contains(type)) fail(fmt::format("cameras[{}].{}", i, type), "missing");
  }
  for (std::size_t i = 0; i < array("bufferViews").size(); ++i) {
    const Json& view = json["bufferViews"][i];
    const std::string where = fmt::format("bufferViews[{}]", i);
    if (view.contains("byteStride") && view["byteStride"].get<int>() % 4 != 0)
      fail(where + ".byteStride",
           fmt::format("a multiple of 4 was expected, found {}", view["byteStride"].get<int>()));
    const Json* meshopt = extension(view, "EXT_meshopt_compression");
    if (meshopt) checkMeshoptView(*this, view, *meshopt, where);
    const Json& source = meshopt ? *meshopt : view;
    const std::uint64_t offset = source.value("byteOffset", std::uint64_t(0)), length = source["byteLength"];
    const int index = source["buffer"];
    const std::uint64_t available = json["buffers"][static_cast<std::size_t>(index)]["byteLength"];
    if (offset > available || length > available - offset)
      fail(where + ".byteLength", fmt::format("bytes {} to {} lie beyond buffers[{}] ({} bytes)", offset,
                                              offset + length, index, available));
  }
  for (std::size_t i = 0; i < array("accessors").size(); ++i)
    checkAccessor(*this, json["accessors"][i], fmt::format("accessors[{}]", i));
}

}  // namespace gloam
