// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/volume_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "image/limits.h"
#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"
#include "scene/volume_places.h"

namespace gloam {
namespace {

static_assert(std::endian::native == std::endian::little, "raw grids are read as they lie in memory");

constexpr float kLongest = 2.0f;  // metres, unless `longest` says otherwise
constexpr float kDepth =
    12.0f;  // optical depth of full density along the longest side, unless `density` does

std::string pathOf(const std::string& name) {
  return name.substr(0, name.find('?'));
}

std::string extensionOf(const std::string& name) {
  std::string extension = std::filesystem::path(pathOf(name)).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

VolumeFile parseName(const std::string& name) {
  VolumeFile file{pathOf(name), {}};
  for (std::size_t at = file.path.size(); at < name.size();) {
    const std::size_t end = std::min(name.find('&', at + 1), name.size());
    const std::string part = name.substr(at + 1, end - at - 1);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(name, fmt::format("'{}'; expected key=value, apart by &", part));
    if (!file.values.emplace(part.substr(0, equals), part.substr(equals + 1)).second)
      throw Error(name, fmt::format("{} stands twice", part.substr(0, equals)));
    at = end;
  }
  return file;
}

/// Takes values out one by one; what is left at the end nobody knows.
class Values {
 public:
  explicit Values(VolumeFile file) : file_(std::move(file)) {}
  const std::string& path() const { return file_.path; }

  std::string text(const char* key, const std::string& otherwise) {
    known_.emplace_back(key);
    const auto found = file_.values.find(key);
    if (found == file_.values.end()) return otherwise;
    std::string value = found->second;
    file_.values.erase(found);
    return value;
  }
  float number(const char* key, float otherwise, double low, double high) {
    const std::string value = text(key, "");
    if (value.empty()) return otherwise;
    double parsed = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), parsed);
    if (error != std::errc() || end != value.data() + value.size() || !(parsed >= low && parsed <= high))
      fail(key, value, fmt::format("a number from {} to {}", low, high));
    return float(parsed);
  }
  glm::ivec3 size() {
    const std::string value = text("size", "");
    glm::ivec3 size(0);
    const char* at = value.data();
    const char* end = at + value.size();
    for (int c = 0; c < 3; ++c) {
      const auto [next, error] = std::from_chars(at, end, size[c]);
      const bool last = c == 2;
      if (error != std::errc() || size[c] < 2 || size[c] > 4096 ||
          (last ? next != end : next == end || *next != 'x'))
        fail("size", value, "voxels along x, y and z, 2 to 4096 each: size=64x64x64");
      at = next + (last ? 0 : 1);
    }
    return size;
  }
  void finish() const {
    if (!file_.values.empty())
      throw Error(path(), fmt::format("'{}' is not known; there are {}", file_.values.begin()->first,
                                      fmt::join(known_, ", ")));
  }
  [[noreturn]] void fail(const std::string& key, const std::string& value,
                         const std::string& expected) const {
    throw Error(path(), fmt::format("{}: '{}'; expected {}", key, oneLine(value), expected));
  }

 private:
  VolumeFile file_;
  std::vector<std::string> known_;
};

template <class T>
void convert(const std::vector<std::uint8_t>& bytes, float scale, std::vector<float>& density) {
  for (std::size_t i = 0; i < density.size(); ++i) {
    T value;
    std::memcpy(&value, &bytes[i * sizeof(T)], sizeof(T));
    density[i] = scale * float(value);
  }
}

/// Densities from 0 to 1 as integers have them, floats as they are.
Volume readRaw(Values& values) {
  Volume volume;
  volume.size = values.size();
  const std::string type = values.text("type", "u8");
  if (type != "u8" && type != "u16" && type != "f32") values.fail("type", type, "u8, u16 or f32");
  const std::size_t each = type == "u8" ? 1 : type == "u16" ? 2 : 4;
  std::uint64_t bytes = 0;
  openForReading(values.path(), &bytes);
  if (bytes != volume.voxels() * each)
    throw Error(values.path(),
                fmt::format("{} bytes; {} x {} x {} voxels of type {} are {}", bytes, volume.size.x,
                            volume.size.y, volume.size.z, type, volume.voxels() * each));
  const std::vector<std::uint8_t> data = readBytes(values.path());
  volume.density.resize(volume.voxels());
  if (each == 1) convert<std::uint8_t>(data, 1.0f / 255.0f, volume.density);
  if (each == 2) convert<std::uint16_t>(data, 1.0f / 65535.0f, volume.density);
  if (each == 4) convert<float>(data, 1.0f, volume.density);
  volume.bounds_max = glm::vec3(volume.size);
  return volume;
}

}  // namespace

bool namesVolumeFile(const std::string& name) {
  const std::string extension = extensionOf(name);
  return extension == ".raw" || extension == ".vdb";
}

Scene volumeScene(const std::string& name, Volume volume, float above, float cell) {
  const glm::vec3 side = volume.bounds_max - volume.bounds_min;
  const float longest = std::max({side.x, side.y, side.z}), unit = longest / 2.0f;
  const glm::vec3 middle = 0.5f * (volume.bounds_min + volume.bounds_max);
  SceneBuilder builder(name);
  builder.place("ground", shapes::slab(2.4f * unit, 1.8f * unit, 0.2f * unit, 0.05f * unit, cell * unit),
                builder.diffuse("ground", {0.36f, 0.38f, 0.33f}));
  const int node = builder.node(volume.name, kNone, {-middle.x, above - volume.bounds_min.y, -middle.z});
  builder.at(node).volume = std::make_shared<Volume>(std::move(volume));
  // Floor and volume fill the picture's height.
  const float half = 0.5f * (above + side.y), away = 1.25f * half / std::tan(glm::radians(17.0f));
  builder.camera({0.26f * away, 0.95f * half + 0.05f * away, 0.96f * away}, {0.0f, 0.95f * half, 0.0f}, 34);
  builder.sky("preetham?elevation=35&azimuth=-60");
  return builder.finish();
}

Scene readVolumeScene(const std::string& name, const Progress& progress) {
  Values values(parseName(name));
  const bool vdb = extensionOf(name) == ".vdb";
  progress.report(0.0, "reading");
  Volume volume;
  if (vdb) {
    const std::string grid = values.text("grid", "");
    const int cells = int(values.number("cells", 64, 4, 1024));
    volume = readVdb(values.path(), grid, cells);
  } else {
    volume = readRaw(values);
  }
  const std::filesystem::path path(values.path());
  volume.name = path.stem().string();
  const glm::vec3 side = volume.bounds_max - volume.bounds_min;
  const float was = std::max({side.x, side.y, side.z});
  const float longest = values.number("longest", kLongest, 1e-3, 1e6);
  const float density = values.number("density", kDepth / longest, 0, 1e6);
  volume.bounds_max = side * (longest / was);
  volume.bounds_min = glm::vec3(0.0f);
  volume.albedo = glm::vec3(values.number("albedo", 0.99f, 0, 1));
  volume.asymmetry = values.number("g", 0.6f, -0.95, 0.95);
  values.finish();
  float most = 1.0f;  // of integers
  if (vdb && !volume.density.empty()) most = std::max(1e-30f, *std::ranges::max_element(volume.density));
  for (float& d : volume.density) d *= density / most;
  checkVolume(volume, values.path());
  const bool empty = std::ranges::all_of(volume.density, [](float d) { return d == 0.0f; });
  Scene scene = volumeScene(volume.name, std::move(volume), 0.25f * longest, 0.05f);
  if (empty) scene.warnings.emplace_back("every voxel's density is 0: nothing of the volume will be seen");
  return scene;
}

}  // namespace gloam
