// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "technique_choice.h"

#include <fmt/core.h>
#include <gloam/volume.h>

namespace gloam::cli {
namespace {

std::string kindText(const Option& option) {
  if (!option.choices.empty()) {
    std::vector<std::string> choices(option.choices.begin(), option.choices.end());
    return CLI::detail::join(choices, "|");
  }
  if (std::holds_alternative<bool>(option.default_value)) return "true|false";
  return fmt::format("{}..{}", option.minimum, option.maximum);
}

void addTechniqueOption(CLI::App& app, TechniqueChoice& choice, const TechniqueInfo& info,
                        const Option& option) {
  const std::string flag = fmt::format("--{}.{}", info.name, option.name);
  const auto set = [&choice, &info, flag, name = std::string(option.name)](const std::string& text) {
    Settings settings(info.options);
    try {
      settings.set(name, text);
    } catch (const Error& error) {  // "option 'order': …": here options have longer names
      const std::string message = error.what();
      throw Error(flag, message.substr(std::min(message.find(": ") + 2, message.size())));
    }
    choice.values[info.name][name] = text;
  };
  app.add_option_function<std::string>(flag, set, option.help)
      ->type_name(kindText(option))
      ->default_str(
          std::visit([](const auto& held) { return fmt::format("{}", held); }, option.default_value))
      ->group(fmt::format("Technique {}", info.name));
}

}  // namespace

void addTechniqueOptions(CLI::App& app, TechniqueChoice& choice) {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : techniques()) names.emplace_back(info.name);
  const auto setName = [&choice, names](const std::string& text) {
    if (std::ranges::find(names, text) == names.end()) {
      throw Error("--technique",
                  fmt::format("'{}'{}: expected {}", text, didYouMean(text, names), listed(names)));
    }
    choice.name = text;
  };
  app.add_option_function<std::string>("--technique", setName,
                                       fmt::format("way of lighting: {}; by default prt where the scene "
                                                   "carries transfer or a volume, else irradiance",
                                                   listed(names)))
      ->type_name("TECHNIQUE");
  for (const TechniqueInfo& info : techniques()) {
    for (const Option& option : info.options) addTechniqueOption(app, choice, info, option);
  }
}

const TechniqueInfo& chooseTechnique(const TechniqueChoice& choice, const Scene& scene) {
  if (!choice.name.empty()) return technique(choice.name);
  return technique(carriesTransfer(scene) || carriesVolumes(scene) ? "prt" : "irradiance");
}

Settings settingsFor(const TechniqueInfo& info, const TechniqueChoice& choice) {
  Settings settings(info.options);
  const auto given = choice.values.find(info.name);
  if (given == choice.values.end()) return settings;
  for (const auto& [name, text] : given->second) settings.set(name, text);
  return settings;
}

Json settingsJson(const TechniqueInfo& info, const Settings& settings) {
  Json json = Json::object();
  for (const Option& option : info.options) {
    if (std::holds_alternative<bool>(option.default_value)) {
      json[option.name] = settings.flag(option.name);
    } else if (std::holds_alternative<int>(option.default_value)) {
      json[option.name] = settings.integer(option.name);
    } else if (std::holds_alternative<float>(option.default_value)) {
      json[option.name] = shortest(settings.number(option.name));
    } else {
      json[option.name] = settings.choice(option.name);
    }
  }
  return json;
}

bool carriesTransfer(const Scene& scene) {
  return std::ranges::any_of(scene.meshes, [](const Mesh& mesh) { return mesh.transfer != nullptr; });
}

}  // namespace gloam::cli
