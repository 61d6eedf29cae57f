// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "light_parts.h"

#include <fmt/core.h>

namespace gloam::cli {
namespace {

const std::vector<std::string> kSources = {"environment", "local", "lamps", "emitters"};

}  // namespace

void addLightParts(CLI::App& app, LightParts& parts) {
  const auto setOnly = [&parts](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (std::ranges::find(kSources, name) == kSources.end()) {
        throw Error("--only", fmt::format("'{}'{}: expected {}, or several apart by commas", name,
                                          didYouMean(name, kSources), listed(kSources)));
      }
    }
    parts.only = names;
  };
  app.add_option_function<std::vector<std::string>>(
         "--only", setOnly, "light of these sources alone, apart by commas; local is lamps and emitters")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name(CLI::detail::join(kSources, "|"))
      ->group("Light");
  app.add_flag("--direct", parts.direct, "only light that comes straight from its source")->group("Light");
  app.add_flag("--indirect", parts.indirect, "only light that comes by way of other surfaces")
      ->group("Light");
}

Coverage coverageOf(const LightParts& parts) {
  const auto takes = [&](const char* name) {
    return parts.only.empty() || std::ranges::find(parts.only, name) != parts.only.end();
  };
  const bool direct = parts.direct || !parts.indirect, indirect = parts.indirect || !parts.direct;
  const bool environment = takes("environment"), lamps = takes("lamps") || takes("local"),
             emitters = takes("emitters") || takes("local");
  return {.environment_direct = environment && direct,
          .environment_indirect = environment && indirect,
          .local_direct = lamps && direct,
          .local_indirect = lamps && indirect,
          .emitter_direct = emitters && direct,
          .emitter_indirect = emitters && indirect};
}

}  // namespace gloam::cli
