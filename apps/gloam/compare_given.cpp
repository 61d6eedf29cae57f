// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_given.h"

#include <fmt/core.h>

namespace gloam::cli {

ReferencePicture takeReference(CompareChoice& choice) {
  const std::pair<const char*, bool> of_tracing[] = {{"--spp", choice.samples.has_value()},
                                                     {"--noise", choice.noise > 0.0f},
                                                     {"--seed", choice.seed.has_value()}};
  for (const auto& [option, asked] : of_tracing) {
    if (!asked) continue;
    throw Error(option, fmt::format("says how a reference is traced; {} is there already (--reference)",
                                    choice.reference));
  }
  ReferencePicture given = readReference(choice.reference);
  const glm::ivec2 size{given.layers.width, given.layers.height};
  const auto require = [&](bool same, const char* option, const std::string& asked, const std::string& has) {
    if (!same) throw Error(option, fmt::format("{} was asked for, {} has {}", asked, choice.reference, has));
  };
  const auto sizeText = [](const glm::ivec2& s) { return fmt::format("{}x{}", s.x, s.y); };
  if (choice.size_given) {
    require(choice.view.size == size, "--size", sizeText(choice.view.size), sizeText(size));
  }
  if (choice.supersample_given) {
    require(choice.view.supersample == given.supersample, "--supersample",
            std::to_string(choice.view.supersample), std::to_string(given.supersample));
  }
  if (choice.bounces) {
    require(*choice.bounces == given.bounces, "--bounces", std::to_string(*choice.bounces),
            std::to_string(given.bounces));
  }
  if (choice.environment_order) {
    require(*choice.environment_order == given.environment_order, "--sh-order",
            std::to_string(*choice.environment_order), std::to_string(given.environment_order));
  }
  choice.view.size = size;
  choice.view.supersample = given.supersample;
  return given;
}

void checkGivenReference(const ReferencePicture& given, const CompareChoice& choice,
                         const CompareStage& stage, const std::vector<Contender>& contenders,
                         Console& console) {
  if (!checkReference(given, {stage.scene, stage.posed, stage.camera, stage.environment})) {
    console.remark(
        fmt::format("{} does not say what it is a picture of: that scene, light and camera are those of "
                    "this comparison cannot be checked",
                    choice.reference));
  }
  if (!choice.environment_order && given.environment_order > 0) {
    console.remark(fmt::format("{} is lit by {} bands of spherical harmonics (--sh-order)", choice.reference,
                               given.environment_order));
  }
  if (!given.version.empty() && given.version != tracerVersion()) {
    console.remark(
        fmt::format("{} was traced by {}; this is {}", choice.reference, given.version, tracerVersion()));
  }
  if (stage.in_scene.emitter_direct && given.layers.find("seen") == nullptr) {
    console.remark(fmt::format(
        "{} has no layer seen: lamps that are seen themselves count in measures, and make errors look small",
        choice.reference));
  }
  if (given.background && given.layers.find("object") == nullptr) {
    console.remark(
        fmt::format("{} has no channel object.id: the light behind the scene counts in measures, and makes "
                    "errors look small",
                    choice.reference));
  }
  for (const Contender& contender : contenders) {
    const Coverage held = both(coverageOf(contender), stage.in_scene);
    imageOf(given.layers, held, choice.reference);
    varianceOf(given.layers, held, choice.reference);
  }
  if (!varianceOf(given.layers, coverageOf(given.layers, choice.reference), choice.reference)) {
    console.remark(
        fmt::format("{} does not say how noisy it is: an error may be its noise", choice.reference));
  }
}

}  // namespace gloam::cli
