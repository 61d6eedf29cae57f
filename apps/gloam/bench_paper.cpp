// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bench_paper.h"

#include <fmt/core.h>

#include <algorithm>

#include "verb.h"

namespace gloam::cli {
namespace {

struct Paper {
  const char* technique;
  MeasurePaper measure;
};
constexpr Paper kPapers[] = {
    {"proxies", measureProxiesPaper},
    {"radiance_filter", measureRadianceFilterPaper},
    {"spherical_lights", measureSphericalLightsPaper},
    {"splatting", measureSplattingPaper},
};

const char* betterText(PaperRow::Better better) {
  switch (better) {
    case PaperRow::Better::kHigher:
      return "higher";
    case PaperRow::Better::kLower:
      return "lower";
    case PaperRow::Better::kNone:
      break;
  }
  return "none";
}

/// "reached", "not reached", or nothing to compare with.
const char* verdict(const PaperRow& row) {
  if (!row.paper || row.better == PaperRow::Better::kNone) return "";
  const bool reached = row.better == PaperRow::Better::kHigher ? row.ours * row.within >= *row.paper
                                                               : row.ours <= *row.paper * row.within;
  if (!reached) return "not reached";
  return row.within > 1.0 ? "reached (within the factor allowed)" : "reached";
}

void printTable(const PaperTable& table, Console& console) {
  std::size_t width = 4;
  for (const PaperRow& row : table.rows) width = std::max(width, row.name.size());
  console.print(fmt::format("{:<{}}  {:>10}  {:>10}  {:<10}", table.device, width, "ours", "paper", "unit"));
  for (const PaperRow& row : table.rows) {
    const std::string paper = row.paper ? fmt::format("{:.4g}", *row.paper) : "";
    console.print(fmt::format("{:<{}}  {:>10.4g}  {:>10}  {:<10}  {}", row.name, width, row.ours, paper,
                              row.unit, verdict(row)));
  }
  for (const std::string& note : table.notes) console.print(note);
}

void printJson(const PaperTable& table, const std::string& command, Console& console) {
  Json rows = Json::array();
  for (const PaperRow& row : table.rows) {
    rows.push_back({{"name", row.name},
                    {"ours", row.ours},
                    {"paper", row.paper ? Json(*row.paper) : Json(nullptr)},
                    {"unit", row.unit},
                    {"better", betterText(row.better)},
                    {"command", row.command.empty() ? command : row.command}});
  }
  console.print(jsonText({{"device", table.device}, {"rows", rows}}));
}

}  // namespace

MeasurePaper findPaper(const std::string& technique) {
  for (const Paper& paper : kPapers) {
    if (technique == paper.technique) return paper.measure;
  }
  return nullptr;
}

std::vector<std::string> techniquesWithPaper() {
  std::vector<std::string> names;
  for (const Paper& paper : kPapers) names.emplace_back(paper.technique);
  return names;
}

int benchPaper(const BenchChoice& choice, Console& console) {
  const MeasurePaper measure = findPaper(choice.subject);
  if (measure == nullptr)
    throw Error("--paper", fmt::format("no figures of a paper are kept of '{}'; expected {}", choice.subject,
                                       listed(techniquesWithPaper())));
  if (!choice.output.empty()) checkPlotPath(choice.output);
  const PaperTable table = measure(choice, console);
  if (!choice.output.empty()) writePlot(table.plot, choice.output);
  if (console.json)
    printJson(table, benchCommand(choice, "--paper"), console);
  else
    printTable(table, console);
  return kDone;
}

}  // namespace gloam::cli
