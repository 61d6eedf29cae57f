// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_time.h"

#include <image/atomic_file.h>

#include <fstream>

#include "json.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

fs::path timeFile(const fs::path& bake) {
  return fs::path(bake).replace_extension(".time.json");
}

}  // namespace

BakeTime readBakeTime(const fs::path& bake) {
  std::ifstream in(timeFile(bake), std::ios::binary);
  const Json json = Json::parse(in, nullptr, false);
  if (json.is_object() && json.contains("bake_seconds") && json["bake_seconds"].is_number()) {
    return {json["bake_seconds"].get<double>(), ""};
  }
  return {std::nullopt, "taken from the cache, which does not tell how long it took"};
}

void writeBakeTime(const BakeTime& time, const fs::path& bake) {
  std::error_code ignored;
  fs::remove(timeFile(bake), ignored);
  if (!time.seconds) return;
  const std::string text = Json{{"bake_seconds", *time.seconds}}.dump() + "\n";
  AtomicFile file(timeFile(bake));
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace gloam::cli
