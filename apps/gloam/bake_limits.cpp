// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_limits.h"

#include <fmt/core.h>
#include <scene/machine_memory.h>

#include <cctype>
#include <cmath>

namespace gloam::cli {

void addLimitOptions(CLI::App& app, BakeOptions& options, LimitChoice& choice) {
  choice.caustics_option =
      addChoice(app, "--caustics", choice.caustics, {"on", "off"},
                "light that mirrors and metals throw on what is around them, followed ray by ray")
          ->default_str(choice.caustics)
          ->group("Transfer");
  choice.error_option =
      addNumber(app, "--error", options.error, {1e-5, 1.0}, "X",
                "each vertex takes rays, up to --directions, until its standard error is this part of what "
                "an open one has; the first bounce too. By default all take all")
          ->group("Transfer");
  choice.memory_option =
      addText(app, "--memory", choice.memory, "SIZE",
              "most memory that the bake may take, as 600M or 2G; less of it costs time in later bounces")
          ->group("Transfer");
}

std::size_t parseBytes(const std::string& place, const std::string& text) {
  std::size_t digits = 0;
  while (digits < text.size() && (std::isdigit((unsigned char)text[digits]) || text[digits] == '.')) ++digits;
  std::string unit;
  for (const char c : text.substr(digits)) {
    if (c != ' ') unit += char(std::toupper((unsigned char)c));
  }
  if (unit.ends_with("IB")) unit.resize(unit.size() - 2);
  if (unit.size() == 2 && unit[1] == 'B') unit.resize(1);
  if (unit == "B") unit.clear();
  const std::size_t power = std::string(" KMGT").find(unit.empty() ? ' ' : unit[0]);
  if (digits == 0 || unit.size() > 1 || power == std::string::npos)
    throw Error(place, fmt::format("'{}': expected a size as 600M or 2G", text));
  const double bytes =
      parseNumber(place, text.substr(0, digits), {0.0, 1e15}) * std::pow(1024.0, double(power));
  if (!(bytes >= 1.0 && bytes <= 1e15))
    throw Error(place, fmt::format("{}: expected more than nothing, and 900 TiB at most", text));
  return std::size_t(bytes);
}

void applyLimits(BakeOptions& options, const LimitChoice& choice, Console& console) {
  options.caustics = choice.caustics == "on";
  if (choice.memory_option->count() > 0) options.memory_bytes = parseBytes("--memory", choice.memory);
  const auto without = [&](const CLI::Option* option, const char* kind) {
    if (option->count() > 0)
      console.remark(fmt::format("{} has no effect on --kind {}", option->get_name(), kind));
  };
  if (options.kind == TransferKind::kShadowed) without(choice.caustics_option, "ds");
  if (options.kind == TransferKind::kUnshadowed) {
    without(choice.caustics_option, "du");
    without(choice.error_option, "du");
  }
}

std::optional<Error> memoryFault(const BakeOptions& options, const BakeEstimate& estimate,
                                 const BakeEstimate& of_transfer, bool has_grids) {
  const bool capped = options.memory_bytes > 0;
  const std::size_t most = capped ? options.memory_bytes : memoryOfMachine();
  if (most >= estimate.least_memory_bytes) return std::nullopt;
  const std::string least = bytesText(double(estimate.least_memory_bytes)), granted = bytesText(double(most));
  const bool by_others = most >= of_transfer.least_memory_bytes;  // transfer alone would do
  const char* cure = by_others && has_grids
                         ? "grids of fewer points (--grid), or round fewer objects, take less"
                     : by_others ? "volumes of fewer voxels take less"
                     : estimate.texels > estimate.vertices
                         ? "fewer texels (--texels) or bands (--order) take less"
                         : "fewer bands (--order), or no matrices (--glossy off), take less";
  if (!capped)
    return Error("bake",
                 fmt::format("takes {} of memory at least, this machine has {}: {}", least, granted, cure));
  return Error("--memory",
               fmt::format("{} are too little: this bake takes {} at least; {}", granted, least, cure));
}

void remarkDirections(const BakeOptions& options, const BakeReport& report, Console& console) {
  if (options.error <= 0.0f || options.kind == TransferKind::kUnshadowed) return;
  console.remark(fmt::format(
      "{:.0f} directions a point on average, {} at most: {:.3g} rays saved of {:.3g}; error {:.2g} (RMS){}",
      report.mean_directions, report.most_directions, double(report.rays_saved),
      double(report.rays_saved + report.rays), report.error,
      report.above_error > 0
          ? fmt::format("; {} points would need more than --directions", countText(report.above_error))
          : ""));
}

Json directionsJson(const BakeOptions& options, const BakeReport& report) {
  if (options.error <= 0.0f) return nullptr;
  return {{"bound", options.error},
          {"error", report.error},
          {"mean_directions", report.mean_directions},
          {"most_directions", report.most_directions},
          {"rays_saved", report.rays_saved},
          {"points_above", report.above_error}};
}

}  // namespace gloam::cli
