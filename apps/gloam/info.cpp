// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam info: what a scene, a baked scene, a light or a picture holds.
#include <fmt/core.h>

#include <filesystem>
#include <fstream>

#include "info.h"
#include "verb.h"

namespace gloam::cli {
namespace {

enum class FileKind { kScene, kExr, kPicture, kSky };

// By the first bytes, since names lie; what is no picture is a scene, whose reader says what is wrong with it.
FileKind kindOf(const std::string& name) {
  if (name.starts_with("sky:")) return FileKind::kSky;
  if (name.starts_with("builtin:")) return FileKind::kScene;
  std::string head(16, '\0');
  std::ifstream in(name, std::ios::binary);
  in.read(head.data(), std::streamsize(head.size()));
  using namespace std::string_view_literals;
  if (head.starts_with("\x76\x2f\x31\x01"sv)) return FileKind::kExr;
  for (const auto magic : {"#?RADIANCE"sv, "#?RGBE"sv, "\x89PNG"sv, "\xff\xd8\xff"sv}) {
    if (head.starts_with(magic)) return FileKind::kPicture;
  }
  const std::string extension = std::filesystem::path(name).extension().string();
  if (extension == ".exr") return FileKind::kExr;
  if (extension == ".hdr" || extension == ".png" || extension == ".jpg" || extension == ".jpeg")
    return FileKind::kPicture;
  return FileKind::kScene;
}

Json describe(const std::string& name, Console& console) {
  switch (kindOf(name)) {
    case FileKind::kExr:
      return describeLayers(name);
    case FileKind::kPicture:
      return describePicture(name);
    case FileKind::kSky:
      return describeSky(name);
    case FileKind::kScene:
      break;
  }
  return describeScene(name, console);
}

// {"cameras": [{"name": "a"}]} becomes indented lines; what is empty is left out.
void printTree(const Json& json, const std::string& indent, Console& console) {
  for (const auto& [key, value] : json.items()) {
    if (value.empty() || value.is_null()) continue;
    if (!value.is_structured()) {
      console.print(
          fmt::format("{}{}: {}", indent, key, value.is_string() ? value.get<std::string>() : value.dump()));
    } else if (value.is_array() && !value.front().is_structured()) {
      std::string line;
      for (const Json& element : value) {
        line +=
            (line.empty() ? "" : ", ") + (element.is_string() ? element.get<std::string>() : element.dump());
      }
      console.print(fmt::format("{}{}: {}", indent, key, line));
    } else if (value.is_array()) {
      console.print(fmt::format("{}{}: {}", indent, key, value.size()));
      for (const Json& element : value) {
        std::string line;
        for (const auto& [name, inner] : element.items()) {
          if (inner.empty() || inner == Json("")) continue;
          line += fmt::format("{}{} {}", line.empty() ? "" : ", ", name,
                              inner.is_string() ? inner.get<std::string>() : inner.dump());
        }
        console.print(fmt::format("{}  {}", indent, line));
      }
    } else {
      console.print(fmt::format("{}{}:", indent, key));
      printTree(value, indent + "  ", console);
    }
  }
}

int runInfo(const std::string& name, Console& console) {
  const Json json = describe(name, console);
  if (console.json) {
    console.print(jsonText(json));
  } else {
    printTree(json, "", console);
  }
  return kDone;
}

std::function<int()> declareInfo(CLI::App& app, Console& console) {
  const auto name = std::make_shared<std::string>();
  addText(app, "FILE", *name, "SCENE", "a scene, a picture, an environment, builtin:NAME or sky:NAME")
      ->required();
  addConsoleOptions(app, console, true);
  return [name, &console] { return runInfo(*name, console); };
}

}  // namespace

extern const Verb kInfoVerb;
const Verb kInfoVerb = {"info", "tells what a scene, a bake, a picture or a light probe holds",
                        "gloam info model.glb | triangles, materials, cameras, transfer\n"
                        "gloam info probe.exr --json | layers, range and mean, for programs\n",
                        declareInfo};

}  // namespace gloam::cli
