// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// glTF 2.0 specification, sections 3.6 (buffers, accessors) and 4.4 (the .glb container).
#include "scene/glb_builder.h"

#include <fmt/format.h>
#include <gloam/error.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "image/atomic_file.h"
#include "scene/half_float.h"

namespace gloam {
namespace {

static_assert(std::endian::native == std::endian::little,
              "glTF's buffers are little-endian and copied as they are");

constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;

template <typename T>
std::span<const std::uint8_t> bytesOf(std::span<const T> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

const char* typeName(int components) {
  switch (components) {
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    case 16:
      return "MAT4";
    default:
      return "SCALAR";
  }
}

void writeWord(AtomicFile& file, std::uint32_t word) {
  file.write(&word, 4);
}

}  // namespace

int GlbBuilder::add(const char* array, nlohmann::json object) {
  nlohmann::json& list = root[array];
  list.push_back(std::move(object));
  return int(list.size()) - 1;
}

int GlbBuilder::addView(std::span<const std::uint8_t> bytes, Target target) {
  binary_.resize((binary_.size() + 3) / 4 * 4, 0);
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != Target::kNone) view["target"] = int(target);
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  return add("bufferViews", std::move(view));
}

int GlbBuilder::addAccessor(int view, int component_type, std::size_t count, int components) {
  return add("accessors", {{"bufferView", view},
                           {"componentType", component_type},
                           {"count", count},
                           {"type", typeName(components)}});
}

int GlbBuilder::addFloats(std::span<const float> values, int components, Target target, bool bounds) {
  const std::size_t n = std::size_t(components), count = values.size() / n;
  const int index = addAccessor(addView(bytesOf(values), target), kFloat, count, components);
  if (bounds && count > 0) {
    std::vector<float> low(values.begin(), values.begin() + std::ptrdiff_t(n)), high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % n] = std::min(low[i % n], values[i]);
      high[i % n] = std::max(high[i % n], values[i]);
    }
    // As exact doubles: a validator compares them with the data.
    root["accessors"].back()["min"] = low;
    root["accessors"].back()["max"] = high;
  }
  return index;
}

int GlbBuilder::addBytes(std::span<const std::uint8_t> values, int components, Target target) {
  return addAccessor(addView(values, target), kUnsignedByte, values.size() / std::size_t(components),
                     components);
}

int GlbBuilder::addShorts(std::span<const std::uint16_t> values, int components, Target target) {
  return addAccessor(addView(bytesOf(values), target), kUnsignedShort,
                     values.size() / std::size_t(components), components);
}

int GlbBuilder::addNumbers(std::span<const float> values, bool half_float) {
  if (!half_float) return addFloats(values, 1, Target::kNone);
  std::vector<std::uint16_t> halves(values.size());
  std::ranges::transform(values, halves.begin(), halfFromFloat);
  return addShorts(halves, 1, Target::kNone);
}

int GlbBuilder::addSharedNumbers(std::span<const float> values, bool half_float) {
  const auto [found, is_new] = shared_.try_emplace(values.data(), 0);
  if (is_new) found->second = addNumbers(values, half_float);
  return found->second;
}

int GlbBuilder::addIndices(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  // The greatest index of a type is reserved.
  if (vertex_count >= 0xffffu) {
    return addAccessor(addView(bytesOf(indices), Target::kIndices), kUnsignedInt, indices.size(), 1);
  }
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  return addAccessor(addView(bytesOf(std::span(narrow)), Target::kIndices), kUnsignedShort, narrow.size(), 1);
}

int GlbBuilder::addZeros(std::size_t count, int components, bool bounds) {
  nlohmann::json accessor = {{"componentType", kFloat}, {"count", count}, {"type", typeName(components)}};
  if (bounds) accessor["min"] = accessor["max"] = std::vector<int>(std::size_t(components), 0);
  return add("accessors", std::move(accessor));
}

void GlbBuilder::save(const std::filesystem::path& path) {
  root["asset"] = {{"version", "2.0"}, {"generator", "gloam"}};
  if (!extensions_.empty()) root["extensionsUsed"] = extensions_;
  binary_.resize((binary_.size() + 3) / 4 * 4, 0);
  if (!binary_.empty()) root["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string text = root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(path.string(), fmt::format("would take {} bytes; a .glb holds at most 4294967295", total));
  }
  AtomicFile file(path);
  for (const std::uint32_t word : {0x46546C67u, 2u, std::uint32_t(total)}) writeWord(file, word);
  writeWord(file, std::uint32_t(text.size()));
  file.write("JSON", 4);
  file.write(text.data(), text.size());
  if (!binary_.empty()) {
    writeWord(file, std::uint32_t(binary_.size()));
    file.write("BIN\0", 4);
    file.write(binary_.data(), binary_.size());
  }
  file.commit();
}

double tidy(float value) {
  return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

}  // namespace gloam
