// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What prt answers for and its options.
#include "techniques/prt/prt.h"

namespace gloam::prt {

namespace {

/// Local light sees emitters and what surfaces send to one another.
Coverage coverageOf(const Settings& settings) {
  const Coverage distant{.environment_direct = true, .environment_indirect = true, .local_direct = true};
  Coverage covers = settings.choice("local_light") == std::string("off") ? distant : kAllLight;
  if (!settings.flag("indirect"))
    covers.environment_indirect = covers.local_indirect = covers.emitter_indirect = false;
  return covers;
}

}  // namespace

const TechniqueInfo& info() {
  static const std::vector<Option> options = {
      {.name = "order",
       .default_value = 0,
       .minimum = 0,
       .maximum = 6,
       .help = "bands to use; 0: all that are baked"},
      {.name = "window",
       .default_value = std::string("auto"),
       .choices = {"none", "hann", "lanczos", "auto"},
       .help = "damping of ringing around small bright lights; auto: only where it shows"},
      {.name = "indirect", .default_value = true, .help = "light between surfaces, where it is baked"},
      {.name = "glossy",
       .default_value = std::string("matrix"),
       .choices = {"matrix", "cheap", "unshadowed"},
       .help = "gloss where it is baked: by matrices; by visibility alone, times the light; or as if nothing "
               "were in the way"},
      {.name = "neighbourhood",
       .default_value = true,
       .help = "shadow and light that objects throw on others, where a neighbourhood is baked (and "
               "local_light is "
               "off, which has them from its probes)"},
      {.name = "local_light",
       .default_value = std::string("off"),
       .choices = {"off", "emitters", "all"},
       .help = "light sampled around each object every frame: of emitters, other objects and the sky behind "
               "them; all: "
               "of lamps too, softly, in place of shadow maps"},
      {.name = "local_points",
       .default_value = 4,
       .minimum = 1,
       .maximum = kMostLocalPoints,
       .help = "points around an object at which local light is sampled"},
      {.name = "local_bounces",
       .default_value = 1,
       .minimum = 0,
       .maximum = 8,
       .help = "how often local light goes from object to object"},
      {.name = "local_size",
       .default_value = 16,
       .minimum = 4,
       .maximum = 64,
       .help = "texels a side of the cubes' faces in which local light is sampled"},
      {.name = "half_float",
       .default_value = false,
       .help = "keep transfer as halves on the device: half the memory"},
      {.name = "relight",
       .default_value = std::string("auto"),
       .choices = {"auto", "host", "device"},
       .help =
           "who multiplies diffuse transfer with distant light: the host between two passes, or a compute "
           "pass; auto: the host for software drivers"}};
  static const TechniqueInfo info = {
      .name = "prt",
      .summary =
          "precomputed radiance transfer: soft shadows and light between rigid surfaces, under any distant "
          "light",
      .covers = {.environment_direct = true, .environment_indirect = true, .local_direct = true},
      .options = options,
      .needs_bake = true,
      .covers_with = coverageOf};
  return info;
}

}  // namespace gloam::prt
