// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The part of `gloam bake` that bakes grids round objects (PRT-6).
#pragma once

#include <gloam/bake.h>
#include <gloam/neighbourhood.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bake_checkpoints.h"
#include "console.h"
#include "json.h"

namespace gloam::cli {

struct NeighbourhoodChoice {
  std::string objects;  ///< "auto", names apart by commas, or empty: none
  std::string grid;     ///< "16" or "16x8x16"; empty: the default
  NeighbourhoodOptions options;
  std::vector<const CLI::Option*> of_grid;
};

void addNeighbourhoodOptions(CLI::App& app, NeighbourhoodChoice& choice);

/// The nodes that were asked for; takes over what transfer's options say, and has objects baked apart. Throws Error.
std::vector<int> chooseNeighbourhoods(const Scene& scene, NeighbourhoodChoice& choice, BakeOptions& bake,
                                      Console& console);
/// Says what each will take; also refuses before the bake what does not fit into memory. For --estimate --json: a list.
Json estimateNeighbourhoods(const Scene& scene, const std::vector<int>& nodes,
                            const NeighbourhoodChoice& choice, bool half_float, Console& console, bool print);
/// Bakes them one after the other; each stays in its checkpoint. A list for --json.
Json bakeNeighbourhoods(Scene& scene, const std::vector<int>& nodes, const NeighbourhoodChoice& choice,
                        const BakeCheckpoints& checkpoints, Console& console);

}  // namespace gloam::cli
