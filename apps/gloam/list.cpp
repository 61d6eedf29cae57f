// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam list: techniques with their options, built-in scenes and skies, devices, and the rows that work.
#include <fmt/core.h>
#include <gloam/renderer.h>
#include <scene/coverage.h>

#include <algorithm>

#include "arguments.h"
#include "json.h"
#include "rows.h"
#include "verb.h"

namespace gloam::cli {
namespace {

struct ListOptions {
  bool techniques = false, scenes = false, skies = false, devices = false, rows = false, markdown = false;
  bool all() const { return !techniques && !scenes && !skies && !devices && !rows; }
};

std::string valueText(const OptionValue& value) {
  return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
}

std::string coverageText(const Coverage& covers) {
  std::string text = CLI::detail::join(coverageNames(covers), ", ");
  std::ranges::replace(text, '_', ' ');
  return text;
}

void printTechniques(Console& console) {
  console.print("Techniques");
  for (const TechniqueInfo& info : techniques()) {
    console.print(
        fmt::format("  {:<24}{}{}", info.name, info.summary, info.needs_bake ? " (baked scenes)" : ""));
    console.print(fmt::format("  {:<24}light: {}", "", coverageText(info.covers)));
    for (const Option& option : info.options) {
      const std::string flag = fmt::format("--{}.{}", info.name, option.name);
      console.print(fmt::format("    {:<34}{} [{}]", flag, option.help, valueText(option.default_value)));
    }
  }
}

void printNamed(Console& console, const char* title, const std::string& prefix,
                const std::vector<BuiltinScene>& entries) {
  console.print(title);
  for (const BuiltinScene& entry : entries) {
    console.print(fmt::format("  {:<24}{}", prefix + entry.name, entry.summary));
  }
}

void printDevices(Console& console, bool asked) {
  try {
    const std::vector<DeviceInfo> found = devices();
    console.print("Devices");
    for (const DeviceInfo& device : found) {
      console.print(fmt::format("  {}  {} ({}{})", device.index, device.name, device.driver,
                                device.software ? ", software" : ""));
    }
  } catch (const Error& error) {
    if (asked) throw;
    console.print(fmt::format("Devices\n  none: {}", error.what()));
  }
}

void printRows(Console& console) {
  for (const RowGroup& group : rowGroups()) {
    console.print(fmt::format("{}: {}", group.prefix, group.system));
    for (const Row& row : group.rows) {
      console.print(fmt::format("  {:<8}{:<9}{}", row.name, worksText(row.works), row.what));
    }
  }
}

Json coverageJson(const Coverage& covers) {
  Json json = Json::object();
  for (const CoverageMember& m : kCoverageMembers) json[m.name] = covers.*m.member;
  return json;
}

Json optionJson(const Option& option) {
  static constexpr const char* kTypes[] = {"bool", "integer", "number", "choice"};
  Json json = {{"name", option.name}, {"type", kTypes[option.default_value.index()]}};
  if (!option.choices.empty()) {
    json["range"] = option.choices;
  } else if (std::holds_alternative<int>(option.default_value)) {
    json["range"] = {int(option.minimum), int(option.maximum)};
  } else if (std::holds_alternative<float>(option.default_value)) {
    json["range"] = {option.minimum, option.maximum};
  } else {
    json["range"] = nullptr;
  }
  if (const float* number = std::get_if<float>(&option.default_value)) {
    json["default"] = shortest(*number);
  } else {
    std::visit([&](const auto& held) { json["default"] = held; }, option.default_value);
  }
  json["help"] = option.help;
  return json;
}

Json techniquesJson() {
  Json json = Json::array();
  for (const TechniqueInfo& info : techniques()) {
    Json options = Json::array();
    for (const Option& option : info.options) options.push_back(optionJson(option));
    json.push_back({{"name", info.name},
                    {"summary", info.summary},
                    {"coverage", coverageJson(info.covers)},
                    {"needs_bake", info.needs_bake},
                    {"options", std::move(options)}});
  }
  return json;
}

Json namedJson(const std::string& prefix, const std::vector<BuiltinScene>& entries) {
  Json json = Json::array();
  for (const BuiltinScene& entry : entries) {
    json.push_back({{"name", prefix + entry.name}, {"summary", entry.summary}});
  }
  return json;
}

Json devicesJson(bool asked) {
  Json json = Json::array();
  try {
    for (const DeviceInfo& device : devices()) {
      json.push_back({{"index", device.index},
                      {"name", device.name},
                      {"driver", device.driver},
                      {"software", device.software}});
    }
  } catch (const Error&) {
    if (asked) throw;
  }
  return json;
}

Json rowsJson() {
  Json json = Json::array();
  for (const RowGroup& group : rowGroups()) {
    for (const Row& row : group.rows) {
      if (row.works == Row::Works::kNotYet) continue;
      json.push_back({{"row", row.name},
                      {"what", row.what},
                      {"works", worksText(row.works)},
                      {"missing", row.missing},
                      {"command", row.command},
                      {"test", row.test}});
    }
  }
  return json;
}

void printJson(Console& console, const ListOptions& options) {
  Json json = Json::object();
  if (options.techniques || options.all()) json["techniques"] = techniquesJson();
  if (options.scenes || options.all()) json["scenes"] = namedJson("builtin:", builtinScenes());
  if (options.skies || options.all()) json["skies"] = namedJson("sky:", builtinSkies());
  if (options.devices || options.all()) json["devices"] = devicesJson(options.devices);
  if (options.rows || options.all()) json["rows"] = rowsJson();
  console.print(jsonText(json));
}

int runList(const ListOptions& options, Console& console) {
  if (options.markdown) {
    if (!options.rows) throw Error("--markdown", "is a form of --rows");
    fmt::print("{}", rowsMarkdown());
    return kDone;
  }
  if (console.json) {
    printJson(console, options);
    return kDone;
  }
  if (options.techniques || options.all()) printTechniques(console);
  if (options.scenes || options.all()) printNamed(console, "Scenes", "builtin:", builtinScenes());
  if (options.skies || options.all()) printNamed(console, "Skies", "sky:", builtinSkies());
  if (options.devices || options.all()) printDevices(console, options.devices);
  if (options.rows) printRows(console);
  return kDone;
}

std::function<int()> declareList(CLI::App& app, Console& console) {
  const auto options = std::make_shared<ListOptions>();
  app.add_flag("--techniques", options->techniques, "ways of lighting, with their options");
  app.add_flag("--scenes", options->scenes, "scenes made by code");
  app.add_flag("--skies", options->skies, "skies made by code");
  app.add_flag("--devices", options->devices, "what can render here");
  app.add_flag("--rows", options->rows, "what gloam is to do, and what of it works");
  app.add_flag("--markdown", options->markdown, "with --rows: docs/rows.md");
  addConsoleOptions(app, console, true);
  return [options, &console] { return runList(*options, console); };
}

}  // namespace

extern const Verb kListVerb;
const Verb kListVerb = {"list", "shows techniques, built-in scenes and skies, devices, and what works",
                        "gloam list | all but the rows\n"
                        "gloam list --devices | which GPUs and software drivers there are\n"
                        "gloam list --rows --json | rows that work, for programs\n",
                        declareList};

}  // namespace gloam::cli
