// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Coverage (gloam/scene.h) as a table: its members in their order, and sets of them.
#pragma once

#include <gloam/scene.h>

namespace gloam {

struct CoverageMember {
  const char* name;  ///< as results, attributes and layers name it
  bool Coverage::*member;
  bool direct;
};
inline constexpr CoverageMember kCoverageMembers[] = {
    {"environment_direct", &Coverage::environment_direct, true},
    {"environment_indirect", &Coverage::environment_indirect, false},
    {"local_direct", &Coverage::local_direct, true},
    {"local_indirect", &Coverage::local_indirect, false},
    {"emitter_direct", &Coverage::emitter_direct, true},
    {"emitter_indirect", &Coverage::emitter_indirect, false},
};

inline Coverage both(const Coverage& a, const Coverage& b) {
  Coverage result;
  for (const CoverageMember& m : kCoverageMembers) result.*m.member = a.*m.member && b.*m.member;
  return result;
}
inline Coverage without(const Coverage& a, const Coverage& b) {
  Coverage result;
  for (const CoverageMember& m : kCoverageMembers) result.*m.member = a.*m.member && !(b.*m.member);
  return result;
}
/// "environment_direct", … of what is set.
inline std::vector<std::string> coverageNames(const Coverage& coverage) {
  std::vector<std::string> names;
  for (const CoverageMember& m : kCoverageMembers) {
    if (coverage.*m.member) names.emplace_back(m.name);
  }
  return names;
}

}  // namespace gloam
