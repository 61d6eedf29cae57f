// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What bounds a bake: the error that is allowed, the memory; and light by way of mirrors.
#pragma once

#include <gloam/bake.h>

#include <optional>
#include <string>

#include "arguments.h"
#include "json.h"

namespace gloam::cli {

struct LimitChoice {
  std::string caustics = "on", memory;
  const CLI::Option* caustics_option = nullptr;
  const CLI::Option* error_option = nullptr;
  const CLI::Option* memory_option = nullptr;
};

/// --caustics, --error, --memory.
void addLimitOptions(CLI::App& app, BakeOptions& options, LimitChoice& choice);
/// Takes over what was chosen, and says what has no effect. Throws Error.
void applyLimits(BakeOptions& options, const LimitChoice& choice, Console& console);
/// What is wrong where --memory, or without it the machine's, does not suffice. `of_transfer`: what the bake would take without
/// grids and volumes.
std::optional<Error> memoryFault(const BakeOptions& options, const BakeEstimate& estimate,
                                 const BakeEstimate& of_transfer, bool has_grids);

/// "512M", "1.5 GiB", "300000000" as bytes. Throws Error.
std::size_t parseBytes(const std::string& place, const std::string& text);

/// How many directions points took: for people where they were free to, for machines always.
void remarkDirections(const BakeOptions& options, const BakeReport& report, Console& console);
Json directionsJson(const BakeOptions& options, const BakeReport& report);

}  // namespace gloam::cli
