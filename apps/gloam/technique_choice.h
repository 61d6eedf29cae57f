// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// --technique and the options of every technique, as their tables declare them.
#pragma once

#include <gloam/renderer.h>

#include <map>
#include <string>

#include "arguments.h"
#include "json.h"

namespace gloam::cli {

struct TechniqueChoice {
  std::string name;  ///< empty: chosen by the scene
  /// What was given of each technique's options: values["prt"]["order"] = "5".
  std::map<std::string, std::map<std::string, std::string>> values;
};

/// --technique NAME and a --NAME.OPTION for every option of every technique; values are checked at once.
void addTechniqueOptions(CLI::App& app, TechniqueChoice& choice);

/// The technique that was asked for; else `prt` for a scene that carries transfer; else `irradiance`.
const TechniqueInfo& chooseTechnique(const TechniqueChoice& choice, const Scene& scene);

/// The options of that technique with what was given for it.
Settings settingsFor(const TechniqueInfo& info, const TechniqueChoice& choice);

/// {"order": 5, "window": "auto"}: every option with its present value, in its own type.
Json settingsJson(const TechniqueInfo& info, const Settings& settings);

bool carriesTransfer(const Scene& scene);

}  // namespace gloam::cli
