// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "verb.h"

namespace gloam::cli {

extern const Verb kRenderVerb, kBakeVerb, kBakeSpheresVerb, kCompareVerb, kReferenceVerb, kDiffVerb,
    kInfoVerb, kListVerb, kSceneVerb, kBenchVerb, kCompletionVerb;

std::span<const Verb* const> verbs() {
  static constexpr const Verb* kVerbs[] = {
      &kRenderVerb, &kBakeVerb, &kBakeSpheresVerb, &kCompareVerb, &kReferenceVerb,  &kDiffVerb,
      &kInfoVerb,   &kListVerb, &kSceneVerb,       &kBenchVerb,   &kCompletionVerb,
  };
  return kVerbs;
}

const Verb* findVerb(const std::string& name) {
  const auto found = std::ranges::find_if(verbs(), [&](const Verb* verb) { return name == verb->name; });
  return found == verbs().end() ? nullptr : *found;
}

}  // namespace gloam::cli
