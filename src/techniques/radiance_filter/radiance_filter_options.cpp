// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {

namespace {

const std::vector<Option>& options() {
  static const std::vector<Option> options = {
      {.name = "sets",
       .default_value = 4,
       .minimum = 1,
       .maximum = 16,
       .help = "sets of virtual lights a side of the block of pixels that shares all of them"},
      {.name = "sets_down",
       .default_value = 0,
       .minimum = 0,
       .maximum = 16,
       .help = "the same from top to bottom; 0: as many as across"},
      {.name = "direct",
       .default_value = 16,
       .minimum = 0,
       .maximum = 4096,
       .help = "virtual lights a set on what glows and in the environment, together"},
      {.name = "indirect",
       .default_value = 32,
       .minimum = 0,
       .maximum = 4096,
       .help = "virtual lights a set on surfaces that sources light; each further bounce has half as many on "
               "top"},
      {.name = "candidates",
       .default_value = 1,
       .minimum = 1,
       .maximum = 64,
       .help = "times as many are made, and those kept that add most to what the camera sees; "
               "where all is seen, light is a little less even"},
      {.name = "focus",
       .default_value = true,
       .help = "in a wide scene, half of the virtual lights that sky and sun make stand about what is seen"},
      {.name = "bounces",
       .default_value = 1,
       .minimum = 0,
       .maximum = 16,
       .help = "surfaces that light meets before it reaches the one that is seen"},
      {.name = "bound",
       .default_value = 12.0f,
       .minimum = 0.0,
       .maximum = 1e6,
       .help = "least squared distance to a virtual light of a lit surface, in parts of the area that it "
               "stands for, of all sets together, over pi; it shines as a disc of half that size"},
      {.name = "mode",
       .default_value = std::string("radiance"),
       .choices = {"radiance", "irradiance", "irradiance_normals", "brute", "brute_exact"},
       .help =
           "what is averaged over pixels: radiance by direction; or, as before 2008, light after shading, "
           "also "
           "across normals or not; to compare: every set at every pixel, shaded from three bands or exactly"},
      {.name = "filter",
       .default_value = std::string("two_pass"),
       .choices = {"two_pass", "one_pass", "none"},
       .help = "across and then down, each pixel of the window, or not at all"},
      {.name = "beams",
       .default_value = true,
       .help =
           "light of each colour that comes from one or two places is shaded as sharp as it is; off: three "
           "bands alone, as in the paper"},
      {.name = "slopes",
       .default_value = true,
       .help =
           "beside edges, where the window lies to one side, its mean is carried back to the pixel along the "
           "light's slope"},
      {.name = "window",
       .default_value = 1,
       .minimum = 1,
       .maximum = 4,
       .help = "blocks of sets a side that the filter takes in; at most 32 pixels"},
      {.name = "depth_threshold",
       .default_value = 0.25f,
       .minimum = 0.0,
       .maximum = 1000.0,
       .help = "distance from the tangent plane, in parts of the window's width, from which on pixels are "
               "not mixed"},
      {.name = "normal_threshold",
       .default_value = 0.95f,
       .minimum = -1.0,
       .maximum = 1.0,
       .help = "cosine between shading normals below which pixels are not mixed; mode irradiance_normals"},
      {.name = "lamps",
       .default_value = std::string("maps"),
       .choices = {"maps", "field"},
       .help = "direct light of lamps: exactly, by shadow maps, or as virtual lights among the others"},
      {.name = "apart",
       .default_value = true,
       .help = "direct and indirect light are kept apart, at twice the filter's cost; off: all is the direct "
               "layer, and beams, which expect lamps, are less sharp"},
      {.name = "visibility",
       .default_value = std::string("auto"),
       .choices = {"auto", "host", "device"},
       .help = "who traces rays and averages: the host between two passes, rays by Embree; or compute "
               "passes; auto: "
               "the host for software drivers"},
      {.name = "views",
       .default_value = false,
       .help =
           "keeps images to look at, not only those that --show names: radiance_filter.set, raw_0 … raw_2, "
           "bands_0 … bands_2 (in irradiance modes _0, irradiance, and _1, gloss, alone), weights"}};
  return options;
}

Mode modeNamed(const std::string& name) {
  if (name == "irradiance") return Mode::kIrradiance;
  if (name == "irradiance_normals") return Mode::kIrradianceNormals;
  if (name == "brute") return Mode::kBrute;
  return name == "brute_exact" ? Mode::kBruteExact : Mode::kRadiance;
}

Coverage coverage(const Settings& settings) {
  const bool direct = settings.integer("direct") > 0;
  const bool indirect = settings.integer("indirect") > 0 && settings.integer("bounces") > 0;
  return {direct, indirect, true, indirect, direct, indirect};
}

}  // namespace

const TechniqueInfo& info() {
  static const TechniqueInfo info = {
      .name = "radiance_filter",
      .summary =
          "light of every kind by virtual lights and rays, a set a pixel, filtered before it is shaded",
      .covers = kAllLight,
      .options = options(),
      .covers_with = coverage};
  return info;
}

Plan planOf(const Settings& settings, int width, int height, Warnings& warnings) {
  Plan plan;
  plan.mode = modeNamed(settings.choice("mode"));
  plan.width = width, plan.height = height;
  const int across = settings.integer("sets");
  const int down = settings.integer("sets_down") == 0 ? across : settings.integer("sets_down");
  plan.sets = {std::min(across, width), std::min(down, height)};
  if (plan.sets != glm::ivec2(across, down))
    warnings.push_back(fmt::format(
        "radiance_filter.sets: {} x {} are more than a picture of {} x {} has pixels; {} x {} are "
        "used",
        across, down, width, height, plan.sets.x, plan.sets.y));
  const std::string& filter = settings.choice("filter");
  plan.filter = filter == "none" || plan.brute() ? Filter::kNone
                : filter == "one_pass"           ? Filter::kOnePass
                                                 : Filter::kTwoPass;
  const auto taps = [&](int sets, int side) {
    int blocks = settings.integer("window");
    while (blocks > 1 && (sets * blocks > kMostTaps || sets * blocks > side)) --blocks;
    return sets * blocks;
  };
  plan.taps = {taps(plan.sets.x, width), taps(plan.sets.y, height)};
  if (plan.taps != settings.integer("window") * plan.sets && plan.filter != Filter::kNone)
    warnings.push_back(fmt::format(
        "radiance_filter.window: {} blocks of {} x {} sets are more than {} pixels or the picture; {} x {} "
        "pixels are "
        "filtered",
        settings.integer("window"), plan.sets.x, plan.sets.y, kMostTaps, plan.taps.x, plan.taps.y));
  plan.beams = settings.flag("beams");
  plan.slopes = settings.flag("slopes");
  plan.depth_threshold = settings.number("depth_threshold");
  plan.normal_threshold = settings.number("normal_threshold");
  plan.bound = settings.number("bound");
  plan.lamps_in_field = settings.choice("lamps") == "field";
  plan.views = settings.flag("views");
  plan.means = visibility::meansNamed(settings.choice("visibility"));
  plan.walks = {.sets = plan.sets.x * plan.sets.y,
                .direct = settings.integer("direct"),
                .indirect = settings.integer("bounces") > 0 ? settings.integer("indirect") : 0,
                .bounces = settings.integer("bounces"),
                .most_lamps = plan.lamps_in_field ? vpls::WalkOptions{}.most_lamps : 0,
                .candidates = settings.integer("candidates"),
                .focus = settings.flag("focus")};
  const bool direct = plan.walks.direct > 0 || plan.lamps_in_field, indirect = plan.walks.indirect > 0;
  if (direct && indirect && settings.flag("apart"))
    plan.parts = {frame::Path::kDirect, frame::Path::kIndirect};
  else
    plan.parts = {direct ? frame::Path::kDirect : frame::Path::kIndirect};
  return plan;
}

}  // namespace gloam::radiance_filter
