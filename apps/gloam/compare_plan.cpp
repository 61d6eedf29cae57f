// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_plan.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace gloam::cli {
namespace {

std::vector<std::string> splitAt(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1) {
    parts.push_back(text.substr(begin, end - begin));
  }
  parts.push_back(text.substr(begin));
  return parts;
}

Contender contenderOf(const std::string& text, const TechniqueChoice& common) {
  const std::vector<std::string> parts = splitAt(text, ':');
  std::vector<std::string> names;
  for (const TechniqueInfo& info : techniques()) names.emplace_back(info.name);
  if (std::ranges::find(names, parts.front()) == names.end()) {
    names.emplace_back("all");
    throw Error("--techniques", fmt::format("'{}'{}: expected {}, each with :OPTION=VALUE as often as wanted",
                                            parts.front(), didYouMean(parts.front(), names), listed(names)));
  }
  Contender contender{&technique(parts.front()), {}, parts.front(), parts.front()};
  contender.settings = settingsFor(*contender.technique, common);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::size_t equals = parts[i].find('=');
    if (equals == std::string::npos) {
      throw Error("--techniques", fmt::format("'{}': expected OPTION=VALUE after {}:", parts[i], parts[0]));
    }
    try {
      contender.settings.set(parts[i].substr(0, equals), parts[i].substr(equals + 1));
    } catch (const Error& error) {
      throw Error(fmt::format("--techniques {}", text), error.what());
    }
    contender.label += " " + parts[i];
    contender.stem += "_" + parts[i];
  }
  return contender;
}

/// All that moves does so by bones or morph targets, and something does.
bool deformsAltogether(const Scene& scene, const PosedScene& posed) {
  bool any = false;
  for (const Instance& instance : posed.instances) {
    if (scene.meshes[std::size_t(instance.mesh)].indices.empty()) continue;
    if (!instance.deformed()) return false;
    any = true;
  }
  return any;
}

/// Takes out what nobody named and `unfit` holds for; `why` is the end of the line that says so.
template <class Unfit>
void leaveOut(std::vector<Contender>& contenders, Console& console, const std::string& why,
              const Unfit& unfit) {
  const auto goes = [&](const Contender& contender) { return !contender.named && unfit(contender); };
  if (std::ranges::all_of(contenders, goes)) return;
  std::vector<std::string> names;
  for (const Contender& contender : contenders) {
    if (goes(contender)) names.push_back(contender.label);
  }
  std::erase_if(contenders, goes);
  if (!names.empty()) console.remark(fmt::format("left out: {} ({})", listed(names), why));
}

}  // namespace

std::vector<Contender> planContenders(const std::string& list, const TechniqueChoice& common) {
  std::vector<Contender> contenders;
  const auto add = [&](Contender contender) {
    for (const Contender& other : contenders) {
      if (other.technique == contender.technique && other.settings.list() == contender.settings.list()) {
        throw Error("--techniques",
                    contender.label == other.label
                        ? fmt::format("'{}' stands twice", contender.label)
                        : fmt::format("'{}' is the same as '{}'", contender.label, other.label));
      }
    }
    contenders.push_back(std::move(contender));
  };
  for (const std::string& text : splitAt(list, ',')) {
    if (text == "all") {
      for (Contender& contender : allContenders(common)) add(std::move(contender));
    } else {
      add(contenderOf(text, common));
    }
  }
  return contenders;
}

std::vector<Contender> allContenders(const TechniqueChoice& common) {
  std::vector<Contender> contenders;
  for (const TechniqueInfo& info : techniques()) {
    contenders.push_back(contenderOf(info.name, common));
    contenders.back().named = false;
  }
  return contenders;
}

std::vector<std::string> emittersWithoutSpheres(const Scene& scene, const SceneSpheres& spheres) {
  std::vector<std::string> names;
  for (const SphereSet& set : spheres.sets) {
    const bool any = std::ranges::any_of(set.meshes, [&](int mesh) { return glows(scene, mesh); });
    if (any && set.spheres.empty() && set.deforms) names.push_back(set.name);
  }
  return names;
}

Coverage coverageOf(const Contender& contender) {
  return coverageWith(*contender.technique, contender.settings);
}

int bouncesOf(const Contender& contender, int baked) {
  if (contender.technique->needs_bake) return baked;
  const bool own = std::ranges::any_of(contender.technique->options, [](const Option& option) {
    return option.name == std::string("bounces");
  });
  return own ? contender.settings.integer("bounces") : 1;
}

bool anyDirect(const Coverage& coverage) {
  return std::ranges::any_of(kCoverageMembers,
                             [&](const CoverageMember& m) { return m.direct && coverage.*m.member; });
}

bool anyIndirect(const Coverage& coverage) {
  return std::ranges::any_of(kCoverageMembers,
                             [&](const CoverageMember& m) { return !m.direct && coverage.*m.member; });
}

Coverage directOf(const Coverage& coverage) {
  Coverage direct;
  for (const CoverageMember& m : kCoverageMembers) direct.*m.member = m.direct && coverage.*m.member;
  return direct;
}

bool lights(const Contender& contender, const Coverage& in_scene) {
  return both(coverageOf(contender), in_scene) != Coverage{};
}

void leaveOutDark(std::vector<Contender>& contenders, const Coverage& in_scene, Console& console) {
  leaveOut(contenders, console, fmt::format("covers nothing of {}", fmt::join(coverageNames(in_scene), ", ")),
           [&](const Contender& contender) { return !lights(contender, in_scene); });
  leaveOut(contenders, console, "its bake would hold nothing of the light that is there",
           [&](const Contender& contender) {
             const Coverage held = both(coverageOf(contender), in_scene);
             return contender.technique->needs_bake && !held.environment_direct && !anyIndirect(held);
           });
}

void leaveOutUnbakeable(std::vector<Contender>& contenders, const Scene& scene, const PosedScene& posed,
                        Console& console) {
  if (carriesTransfer(scene) || !deformsAltogether(scene, posed)) return;
  leaveOut(contenders, console, "all meshes are skinned or morphed; rigid ones alone can be baked",
           [](const Contender& contender) { return contender.technique->needs_bake; });
  for (const Contender& contender : contenders) {
    if (!contender.technique->needs_bake) continue;
    throw Error(
        "--techniques",
        fmt::format("{} needs a bake: all meshes are skinned or morphed, and rigid ones alone can be baked",
                    contender.technique->name));
  }
}

void requireLight(const Contender& contender, const Coverage& in_scene) {
  if (lights(contender, in_scene)) return;
  const std::vector<std::string> there = coverageNames(in_scene);
  throw Error("--techniques",
              fmt::format("{} cannot light this scene: it covers {}; the scene has {}",
                          contender.technique->name, listed(coverageNames(coverageOf(contender))),
                          there.empty() ? "no light" : fmt::format("{} alone", listed(there))));
}

}  // namespace gloam::cli
