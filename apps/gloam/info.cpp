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

std::string plain(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool isEmpty(const Json& value) {
  return value.is_null() || value.empty() || value == Json("");
}

/// "name a, size 4x4" for an object, "1, 2, 3" for a list, the value itself for anything else.
std::string inOneLine(const Json& value) {
  if (!value.is_structured()) return plain(value);
  std::string line;
  for (const auto& [name, inner] : value.items()) {
    if (isEmpty(inner)) continue;
    const std::string text = inner.is_structured() ? fmt::format("({})", inOneLine(inner)) : plain(inner);
    line += (line.empty() ? "" : ", ") + (value.is_object() ? name + " " + text : text);
  }
  return line;
}

bool holdsLists(const Json& object) {
  return std::ranges::any_of(object,
                             [](const Json& value) { return value.is_array() && value.front().is_object(); });
}

// {"cameras": [{"name": "a"}]} becomes indented lines; what is empty is left out.
void printTree(const Json& json, const std::string& indent, Console& console) {
  for (const auto& [key, value] : json.items()) {
    if (isEmpty(value)) continue;
    const bool list = value.is_array() && value.front().is_object();
    if (!list && !value.is_object()) {
      console.print(fmt::format("{}{}: {}", indent, key, inOneLine(value)));
      continue;
    }
    console.print(list ? fmt::format("{}{}: {}", indent, key, value.size())
                       : fmt::format("{}{}:", indent, key));
    if (!list) {
      printTree(value, indent + "  ", console);
      continue;
    }
    for (const Json& element : value) {
      if (holdsLists(element)) {
        printTree(element, indent + "  ", console);
      } else {
        console.print(fmt::format("{}  {}", indent, inOneLine(element)));
      }
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
  addName(app, "FILE", *name, "SCENE", "a scene, a picture, an environment, builtin:NAME or sky:NAME")
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
