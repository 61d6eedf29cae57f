// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The one table of techniques.
#include <algorithm>

#include "techniques/irradiance/irradiance.h"
#include "techniques/proxies/proxies.h"
#include "techniques/prt/prt.h"
#include "techniques/radiance_filter/radiance_filter.h"
#include "techniques/spherical_lights/spherical_lights.h"
#include "techniques/splatting/splatting.h"
#include "techniques/technique.h"

namespace gloam {

namespace {

struct Entry {
  TechniqueInfo info;
  std::unique_ptr<Technique> (*make)(gpu::Device&);
};

template <class T>
std::unique_ptr<Technique> make(gpu::Device& device) {
  return std::make_unique<T>(device);
}

const std::vector<Entry>& table() {
  static const std::vector<Entry> entries = {
      {irradiance::info(), make<irradiance::Irradiance>},
      {prt::info(), make<prt::Prt>},
      {proxies::info(), make<proxies::Proxies>},
      {spherical_lights::info(), make<spherical_lights::SphericalLights>},
      {splatting::info(), make<splatting::Splatting>},
      {radiance_filter::info(), make<radiance_filter::RadianceFilter>},
  };
  return entries;
}

const Entry& entryOf(const std::string& name) {
  const auto found = std::find_if(table().begin(), table().end(),
                                  [&](const Entry& entry) { return name == entry.info.name; });
  if (found != table().end()) return *found;
  std::string names;
  for (const Entry& entry : table()) names += (names.empty() ? "" : ", ") + std::string(entry.info.name);
  throw Error("technique '" + name + "'", "unknown; there are: " + names);
}

}  // namespace

std::span<const TechniqueInfo> techniques() {
  static const std::vector<TechniqueInfo> infos = [] {
    std::vector<TechniqueInfo> result;
    for (const Entry& entry : table()) result.push_back(entry.info);
    return result;
  }();
  return infos;
}

const TechniqueInfo& technique(const std::string& name) {
  return entryOf(name).info;
}

std::unique_ptr<Technique> makeTechnique(const std::string& name, gpu::Device& device) {
  return entryOf(name).make(device);
}

}  // namespace gloam
