// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// docs/formats/spheres.md.
#include <fmt/core.h>
#include <gloam/spheres.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/atomic_file.h"
#include "image/limits.h"
#include "spheres/objects.h"

namespace gloam {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "gloam spheres";
constexpr int kVersion = 1;
constexpr std::uint64_t kLargestFile = std::uint64_t(256) << 20;

/// 0.1f as 0.1, not as 0.10000000149011612; what is read back has the same bits.
Json shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

Json setJson(const SphereSet& set) {
  Json json{{"name", set.name}, {"meshes", set.meshes}, {"nodes", set.nodes}, {"geometry", set.geometry}};
  if (!set.receive_only.empty()) json["receive_only"] = set.receive_only;
  if (set.shape_from_object != glm::mat3(1.0f)) {
    for (int i = 0; i < 9; ++i)
      json["shape_from_object"].push_back(shortest(set.shape_from_object[i / 3][i % 3]));
  }
  json["spheres"] = Json::array();
  for (const Sphere& s : set.spheres) {
    json["spheres"].push_back(
        {shortest(s.center.x), shortest(s.center.y), shortest(s.center.z), shortest(s.radius)});
  }
  if (set.deforms) {
    json["anchors"] = Json::array();
    for (std::size_t s = 0; s < set.spheres.size(); ++s) {
      Json of_sphere = Json::array();
      for (std::uint32_t a = set.first_anchor[s]; a < set.first_anchor[s + 1]; ++a) {
        of_sphere.push_back({set.anchors[a].part, set.anchors[a].vertex});
      }
      json["anchors"].push_back(std::move(of_sphere));
    }
  }
  const SphereFigures& figures = set.figures;
  json["volume"] = figures.volume;
  json["outside_sum"] = figures.outside_sum;
  json["outside_union"] = figures.outside_union;
  json["coverage"] = figures.coverage;
  return json;
}

/// A value of the file, with its place for errors.
class Field {
 public:
  Field(const Json& json, std::string place) : json_(json), place_(std::move(place)) {}
  [[noreturn]] void fail(const std::string& expected) const { throw Error(place_, "expected " + expected); }

  bool has(const char* name) const { return json_.is_object() && json_.contains(name); }
  Field operator[](const char* name) const {
    if (!has(name)) Field(json_, fmt::format("{}: {}", place_, name)).fail("it to be there");
    return {json_[name], fmt::format("{}: {}", place_, name)};
  }
  std::vector<Field> list() const {
    if (!json_.is_array()) fail("a list");
    std::vector<Field> fields;
    for (std::size_t i = 0; i < json_.size(); ++i)
      fields.emplace_back(json_[i], fmt::format("{}[{}]", place_, i));
    return fields;
  }
  std::string text() const {
    if (!json_.is_string()) fail("a string");
    return json_.get<std::string>();
  }
  double number() const {
    if (!json_.is_number() || !std::isfinite(json_.get<double>())) fail("a number");
    return json_.get<double>();
  }
  float real() const {
    const double value = number();
    if (std::abs(value) > 3.4e38) fail("a number of at most 3.4e38");
    return float(value);
  }
  std::size_t index(std::size_t end) const {
    const double value = number();
    if (!(value >= 0.0 && value < double(end)) || value != std::floor(value)) {
      fail(fmt::format("a whole number from 0 to {}", end - (end > 0 ? 1 : 0)));
    }
    return std::size_t(value);
  }

 private:
  const Json& json_;
  std::string place_;
};

std::vector<int> indices(const Field& field, std::size_t end) {
  std::vector<int> values;
  for (const Field& item : field.list()) values.push_back(int(item.index(end)));
  if (values.empty()) field.fail("at least one index");
  return values;
}

void readAnchors(const Field& field, const Scene& scene, SphereSet& set) {
  const std::vector<Field> of_spheres = field.list();
  if (of_spheres.size() != set.spheres.size())
    field.fail(fmt::format("{} lists, one a sphere", set.spheres.size()));
  set.deforms = true;
  set.first_anchor.push_back(0);
  for (const Field& of_sphere : of_spheres) {
    for (const Field& anchor : of_sphere.list()) {
      const std::vector<Field> pair = anchor.list();
      if (pair.size() != 2) anchor.fail("[part, vertex]");
      const std::size_t part = pair[0].index(set.meshes.size());
      const Mesh& mesh = scene.meshes[std::size_t(set.meshes[part])];
      set.anchors.push_back({int(part), std::uint32_t(pair[1].index(mesh.vertexCount()))});
    }
    if (set.anchors.size() == set.first_anchor.back()) of_sphere.fail("at least one anchor");
    set.first_anchor.push_back(std::uint32_t(set.anchors.size()));
  }
}

SphereSet readSet(const Field& field, const Scene& scene) {
  SphereSet set;
  set.name = field["name"].text();
  set.meshes = indices(field["meshes"], scene.meshes.size());
  set.nodes = indices(field["nodes"], scene.nodes.size());
  for (const int n : set.nodes) {
    if (scene.nodes[std::size_t(n)].meshes != set.meshes)
      field["nodes"].fail("nodes that place these meshes: these spheres belong to another model");
  }
  set.geometry = field["geometry"].text();
  if (set.geometry != spheres::geometryOf(scene, set.meshes)) {
    field["geometry"].fail("the checksum of the scene's meshes: these spheres belong to another model");
  }
  if (field.has("receive_only")) set.receive_only = field["receive_only"].text();
  if (field.has("shape_from_object")) {
    const std::vector<Field> values = field["shape_from_object"].list();
    if (values.size() != 9) field["shape_from_object"].fail("nine numbers");
    for (int i = 0; i < 9; ++i) set.shape_from_object[i / 3][i % 3] = values[std::size_t(i)].real();
  }
  for (const Field& item : field["spheres"].list()) {
    const std::vector<Field> v = item.list();
    if (v.size() != 4) item.fail("[x, y, z, radius]");
    set.spheres.push_back({{v[0].real(), v[1].real(), v[2].real()}, v[3].real()});
    if (!(set.spheres.back().radius > 0.0f)) v[3].fail("a radius above 0");
  }
  if (!set.spheres.empty() && std::abs(glm::determinant(set.shape_from_object)) < 1e-12f) {
    field["shape_from_object"].fail("a matrix that has an inverse");
  }
  if (field.has("anchors")) readAnchors(field["anchors"], scene, set);
  set.figures = {field["volume"].number(), field["outside_sum"].number(), field["outside_union"].number(),
                 field["coverage"].number()};
  return set;
}

}  // namespace

void writeSpheres(const SceneSpheres& spheres, const std::filesystem::path& path) {
  Json json{{"format", kFormat}, {"version", kVersion}, {"sets", Json::array()}};
  for (const SphereSet& set : spheres.sets) json["sets"].push_back(setJson(set));
  json["warnings"] = spheres.warnings;
  const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

SceneSpheres readSpheres(const std::filesystem::path& path, const Scene& scene) {
  std::uint64_t size = 0;
  std::ifstream stream = openForReading(path, &size);
  if (size > kLargestFile)
    throw Error(path.string(), fmt::format("{} bytes: too large for a list of spheres", size));
  const Json json = Json::parse(stream, nullptr, false);
  const Field root(json, path.string());
  if (!json.is_object() || !root.has("format") || json["format"] != kFormat)
    root.fail("a file of `gloam bake spheres`");
  if (root["version"].number() != kVersion) root["version"].fail(fmt::format("version {}", kVersion));
  SceneSpheres spheres;
  for (const Field& set : root["sets"].list()) spheres.sets.push_back(readSet(set, scene));
  for (const Field& warning : root["warnings"].list()) spheres.warnings.push_back(warning.text());
  return spheres;
}

}  // namespace gloam
