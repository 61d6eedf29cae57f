// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_results.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare_plan.h"
#include "console.h"

namespace gloam::cli {
namespace {

struct Measure {
  const char* name;
  double Metrics::*member;
};
constexpr Measure kMeasures[] = {
    {"rmse", &Metrics::rmse}, {"relative_squared_error", &Metrics::relative_squared_error},
    {"psnr", &Metrics::psnr}, {"ssim", &Metrics::ssim},
    {"flip", &Metrics::flip}, {"mean_signed_error", &Metrics::mean_signed_error},
};

// Infinite where nothing differs: no number of JSON.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

void addMeasures(Json& json, const LayerError& error) {
  for (const Measure& measure : kMeasures) {
    json[measure.name] = error ? number((*error).*measure.member) : Json();
  }
}

Json layerJson(const LayerError& error) {
  Json json = Json::object();
  addMeasures(json, error);
  return json;
}

Json techniqueJson(const TechniqueResult& result) {
  Json json = {{"name", result.name}, {"settings", result.settings}};
  addMeasures(json, result.sum);
  json["direct"] = layerJson(result.direct);
  json["indirect"] = layerJson(result.indirect);
  json["device_ms"] = result.device_ms;
  json["passes"] = result.passes;
  json["memory_bytes"] = result.memory_bytes;
  json["bake_seconds"] = orNull(result.bake_seconds);
  json["label"] = result.label;
  json["frame_ms"] = result.frame_ms;
  json["covers"] = coverageNames(result.covers);
  json["leaves_out"] = coverageNames(result.missing);
  json["bounces"] = result.bounces;
  json["own_bounces"] = result.own_bounces;
  json["reference_noise"] = orNull(result.reference_noise);
  json["bake_note"] = result.bake_note;
  json["notes"] = result.notes;
  json["file"] = result.file.filename().string();
  json["reference_file"] = result.reference_file.filename().string();
  json["command"] = result.command;
  return json;
}

// As RFC 4180 wants it where a field holds what separates fields.
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + "\"";
}

std::string csvNumber(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string csvLine(const TechniqueResult& result, const char* layer, const LayerError& error) {
  std::string line = fmt::format("{},{},{}", csvField(result.name), csvField(result.label), layer);
  for (const Measure& measure : kMeasures) {
    line += "," + (error ? csvNumber((*error).*measure.member) : "");
  }
  return line + fmt::format(",{},{},{}\n", csvNumber(result.device_ms), result.memory_bytes,
                            result.bake_seconds ? csvNumber(*result.bake_seconds) : "");
}

}  // namespace

Json resultsJson(const CompareResults& results) {
  Json list = Json::array();
  for (const TechniqueResult& result : results.techniques) list.push_back(techniqueJson(result));
  return {{"scene", results.scene},
          {"environment", results.environment},
          {"bounces", results.bounces},
          {"size", results.size},
          {"device", results.device},
          {"techniques", list},
          {"environment_order", results.environment_order},
          {"reference",
           {{"file", results.reference_file.string()},
            {"text", results.reference_text},
            {"samples", orNull(results.reference_samples)},
            {"noise", orNull(results.reference_noise)},
            {"relative_noise", orNull(results.reference_relative_noise)}}},
          {"command", results.command},
          {"version", GLOAM_VERSION}};
}

std::string resultsCsv(const CompareResults& results) {
  std::string text = "name,label,layer";
  for (const Measure& measure : kMeasures) text += fmt::format(",{}", measure.name);
  text += ",device_ms,memory_bytes,bake_seconds\n";
  for (const TechniqueResult& result : results.techniques) {
    text += csvLine(result, "sum", result.sum);
    text += csvLine(result, "direct", result.direct);
    text += csvLine(result, "indirect", result.indirect);
  }
  return text;
}

std::vector<std::string> resultsTable(const CompareResults& results) {
  std::size_t width = 9;
  for (const TechniqueResult& result : results.techniques) width = std::max(width, result.label.size());
  std::vector<std::string> lines = {fmt::format("{:<{}}  {:>9}  {:>8}  {:>8}  {:>10}  {:>10}", "technique",
                                                width, "error", "FLIP", "signed", "device ms", "memory")};
  for (const TechniqueResult& result : results.techniques) {
    const Metrics none, &m = result.sum ? *result.sum : none;
    lines.push_back(fmt::format("{:<{}}  {:>7.2f} %  {:>8.4f}  {:>6.2f} %  {:>10.2f}  {:>10}", result.label,
                                width, 100.0 * m.relative_rmse, m.flip, 100.0 * m.relative_signed_error,
                                result.device_ms, bytesText(double(result.memory_bytes))));
  }
  return lines;
}

std::vector<std::string> noteLines(const CompareResults& results) {
  std::vector<std::string> lines;
  for (const TechniqueResult& result : results.techniques) {
    for (const std::string& note : result.notes) {
      const bool of_all = std::ranges::all_of(results.techniques, [&](const TechniqueResult& other) {
        return other.name != result.name || std::ranges::find(other.notes, note) != other.notes.end();
      });
      const std::string& who = of_all ? result.name : result.label;
      const bool says_who = note.starts_with(result.name + ":");
      const std::string line = says_who ? note : fmt::format("{}: {}", who, note);
      if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
    }
  }
  return lines;
}

std::string bouncesRemark(const CompareResults& results) {
  std::vector<std::string> said;
  for (const TechniqueResult& result : results.techniques) {
    if (result.bounces > 0 && result.bounces < results.bounces)
      said.push_back(fmt::format("{} to {}", result.label, result.bounces));
  }
  if (said.empty()) return "";
  return fmt::format("of {} bounces traced, each is held to its own: {}", results.bounces,
                     fmt::join(said, ", "));
}

std::string noiseRemark(const CompareResults& results) {
  // An error of so many times its reference's noise is noise to a good part; index.html says so too.
  constexpr double kNear = 1.5;
  double least = INFINITY, most = 0.0;
  int hidden = 0;
  for (const TechniqueResult& result : results.techniques) {
    const double noise = result.reference_noise.value_or(0.0);
    if (!result.sum || result.sum->relative_rmse >= kNear * noise) continue;
    ++hidden;
    least = std::min(least, noise), most = std::max(most, noise);
  }
  if (hidden == 0) return "";
  const std::string low = fmt::format("{:.2g}", 100.0 * least), high = fmt::format("{:.2g}", 100.0 * most);
  return fmt::format(
      "{} not clearly above the noise of what {} held to ({} %): a reference of more samples (--spp) tells "
      "more",
      results.techniques.size() == 1
          ? std::string("the error is")
          : fmt::format("{} of {} errors {}", hidden, results.techniques.size(), hidden == 1 ? "is" : "are"),
      hidden == 1 ? "it is" : "they are", low == high ? low : low + " to " + high);
}

}  // namespace gloam::cli
