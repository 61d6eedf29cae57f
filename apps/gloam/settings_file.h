// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "arguments.h"

namespace gloam::cli {

/// --settings FILE.json: options of the verb by their long names ("size": "512x512", "exposure": "auto",
/// "env_rotation": 90), and a technique's options in an object of its name ("prt": {"order": 4}); "scene" is the scene, and what
/// may stand several times takes a list. What stands on the command line wins. Must be declared last: it fills in the options that are declared before it.
void addSettingsFile(CLI::App& app);

}  // namespace gloam::cli
