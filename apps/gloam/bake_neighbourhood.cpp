// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_neighbourhood.h"

#include <fmt/format.h>
#include <scene/machine_memory.h>

#include <algorithm>

#include "arguments.h"

namespace gloam::cli {
namespace {

std::string nameOf(const Scene& scene, int node) {
  const std::string& name = scene.nodes[std::size_t(node)].name;
  return name.empty() ? fmt::format("node {}", node) : name;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

glm::ivec3 parseGrid(const std::string& text) {
  const std::string place = "--grid";
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == 'x' || c == 'X') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (parts.size() == 1) return {parseInteger(place, text, {4, 128}), 0, 0};
  if (parts.size() != 3) throw Error(place, fmt::format("'{}'; expected points as 16 or 16x8x16", text));
  glm::ivec3 size;
  for (int c = 0; c < 3; ++c) size[c] = parseInteger(place, parts[std::size_t(c)], {2, 128});
  return size;
}

}  // namespace

void addNeighbourhoodOptions(CLI::App& app, NeighbourhoodChoice& choice) {
  const char* group = "Neighbourhood";
  addName(
      app, "--neighbourhood", choice.objects, "auto|all|NAME",
      "round these objects (root nodes, by name, apart by commas; auto: those that move, and those that they "
      "come near) a grid is baked, through which they throw shadow and light on whatever passes; implies "
      "--apart")
      ->group(group);
  const auto ofGrid = [&](CLI::Option* option) { choice.of_grid.push_back(option->group(group)); };
  ofGrid(addText(app, "--grid", choice.grid, "N|XxYxZ", "points along each side of the grid")
             ->default_str(std::to_string(kDefaultNeighbourhoodPoints)));
  ofGrid(addNumber(app, "--neighbourhood-reach", choice.options.reach, {0.0, 16.0}, "LENGTHS",
                   "how far the grid goes beyond its object, in lengths of the object's longest side")
             ->default_str("1"));
}

std::vector<int> chooseNeighbourhoods(const Scene& scene, NeighbourhoodChoice& choice, BakeOptions& bake,
                                      Console& console) {
  if (choice.objects.empty()) {
    for (const CLI::Option* option : choice.of_grid) {
      if (option->count() > 0)
        console.remark(fmt::format("{} has no effect without --neighbourhood", option->get_name()));
    }
    return {};
  }
  if (choice.of_grid.front()->count() > 0) choice.options.size = parseGrid(choice.grid);
  bake.apart = true;
  choice.options.order = bake.order;
  choice.options.directions = bake.directions;
  choice.options.thrown_directions =
      std::min(bake.bounce_directions > 0 ? bake.bounce_directions : 1024, bake.directions);
  choice.options.thrown = bake.kind != TransferKind::kUnshadowed;
  choice.options.threads = bake.threads;
  choice.options.time_s = bake.time_s;
  choice.options.memory_bytes = bake.memory_bytes;
  const std::vector<int> objects = neighbourhoodNodes(scene, bake.time_s);
  std::vector<std::string> names;
  for (const int node : objects) names.push_back(nameOf(scene, node));
  std::vector<int> chosen;
  if (choice.objects == "all") return objects;
  if (choice.objects == "auto") {
    chosen = neighbourhoodNodesThatMeet(scene, choice.options.reach, bake.time_s);
    if (chosen.empty())
      throw Error(
          "--neighbourhood",
          fmt::format("auto: nothing moves by itself here; take all, or name an object: {}", listed(names)));
    return chosen;
  }
  const auto find = [&](const std::string& name) {
    if (name.empty())
      throw Error("--neighbourhood", fmt::format("'{}' has an empty name between commas", choice.objects));
    const auto at = std::ranges::find(names, name);
    if (at == names.end())
      throw Error("--neighbourhood", fmt::format("no object is called '{}'; there are {}{}", name,
                                                 listed(names), didYouMean(name, names)));
    return objects[std::size_t(at - names.begin())];
  };
  if (std::ranges::find(names, choice.objects) != names.end()) return {find(choice.objects)};
  for (const std::string& name : splitAtCommas(choice.objects)) {
    const int node = find(name);
    if (std::ranges::find(chosen, node) == chosen.end()) chosen.push_back(node);
  }
  return chosen;
}

Json estimateNeighbourhoods(const Scene& scene, const std::vector<int>& nodes,
                            const NeighbourhoodChoice& choice, bool half_float, Console& console,
                            bool print) {
  Json list = Json::array();
  for (const int node : nodes) {
    const NeighbourhoodEstimate estimate = estimateNeighbourhood(scene, node, choice.options);
    const glm::ivec3 size = estimate.size;
    const std::size_t file_bytes = estimate.file_bytes / (half_float ? 2 : 1);
    const std::size_t most =
        choice.options.memory_bytes > 0 ? choice.options.memory_bytes : memoryOfMachine();
    if (estimate.memory_bytes > most)
      throw Error("--grid",
                  fmt::format("{} x {} x {} points round '{}' take {} of memory, {} are granted: take "
                              "fewer points or a lower --order",
                              size.x, size.y, size.z, nameOf(scene, node),
                              bytesText(double(estimate.memory_bytes)), bytesText(double(most))));
    const std::string line = fmt::format(
        "neighbourhood of {}: {} x {} x {} points; {:.3g} rays; at most {} of memory, {} in the file",
        nameOf(scene, node), size.x, size.y, size.z, double(estimate.rays),
        bytesText(double(estimate.memory_bytes)), bytesText(double(file_bytes)));
    if (!print) {
      console.remark(line);
    } else if (!console.json) {
      console.print(line);
    }
    list.push_back({{"object", nameOf(scene, node)},
                    {"grid", {size.x, size.y, size.z}},
                    {"rays", estimate.rays},
                    {"memory_bytes", estimate.memory_bytes},
                    {"file_bytes", file_bytes}});
  }
  return list;
}

Json bakeNeighbourhoods(Scene& scene, const std::vector<int>& nodes, const NeighbourhoodChoice& choice,
                        const BakeCheckpoints& checkpoints, Console& console) {
  Json list = Json::array();
  std::vector<std::shared_ptr<const NeighbourhoodTransfer>> grids;
  for (const int node : nodes) {
    NeighbourhoodOptions options = choice.options;
    options.checkpoint = checkpoints.neighbourhood(list.size());
    options.keep_checkpoint = true;
    NeighbourhoodReport report;
    grids.push_back(std::make_shared<NeighbourhoodTransfer>(
        bakeNeighbourhood(scene, node, options, console.progress(), &report)));
    console.endProgress();
    const glm::ivec3 size = grids.back()->size;
    if (!console.json)
      console.remark(fmt::format(
          "neighbourhood of {}: {} x {} x {} points in {}{}; its shadow errs by {:.1f} %, close by {:.1f} % "
          "(at worst {:.0f} %){}",
          nameOf(scene, node), size.x, size.y, size.z, durationText(report.seconds),
          grids.back()->indirect.empty() ? ", shadow alone" : "", 100.0 * report.error,
          100.0 * report.near_error, 100.0 * report.worst_error, report.resumed ? "; resumed" : ""));
    list.push_back({{"object", nameOf(scene, node)},
                    {"grid", {size.x, size.y, size.z}},
                    {"inside", report.inside},
                    {"rays", report.rays},
                    {"seconds", report.seconds},
                    {"error", report.error},
                    {"near_error", report.near_error},
                    {"worst_error", report.worst_error},
                    {"resumed", report.resumed}});
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) scene.nodes[std::size_t(nodes[i])].neighbourhood = grids[i];
  return list;
}

}  // namespace gloam::cli
