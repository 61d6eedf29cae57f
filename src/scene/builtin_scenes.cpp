// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/builtin_scenes.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include "scene/builtin_papers.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

struct Entry {
  BuiltinScene about;
  Scene (*make)(const Detail&, NamedValues&);
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {{"furnace", "a white sphere under white light: radiance 1 everywhere"}, makeFurnace},
      {{"furnace-concave", "a white bowl with a wall under white light: tends to 1 with bounces"},
       makeConcaveFurnace},
      {{"bowl", "an open spherical bowl, one sheet, with a known answer (coverage, albedo)"}, makeBowl},
      {{"cornell", "a box with a red and a green wall, two boxes, a skylight with a lamp"}, makeCornell},
      {{"spheres", "diffuse, glossy and metal spheres of five roughnesses on a plinth"}, makeSpheres},
      {{"shadow", "three rings round a ball float above a plinth: soft shadows"}, makeShadow},
      {{"bronze", "a bronze knot and balls on polished slate: gloss that is shadowed and reflects"},
       makeBronze},
      {{"caustic", "a gold ring on plaster and the light that it throws into itself"}, makeCaustic},
      {{"columns", "an arcade before a red wall: shadow and bleeding colour in depth"}, makeColumns},
      {{"gallery", "plain walls of two triangles, with texture coordinates for a lightmap, under a skylight"},
       makeGallery},
      {{"lamp", "a corner of a room at night: point, spot and directional light through thin bars"},
       makeLamp},
      {{"swing", "a room with a red and a blue wall in which a lamp swings (4 s, loops): light that bounces"},
       makeSwing},
      {{"teapot", "a teapot between coloured walls under a spot (8K triangles)"},
       makeTeapot},
      {{"statue", "a robed statue turns between coloured walls (8 s, loops; triangles, roughness)"}, makeStatue},
      {{"serpent", "a coiled serpent and a hare between coloured walls (405K triangles)"}, makeSerpent},
      {{"flying", "six hares turn in the air between coloured walls (8 s, loops; 412K triangles)"},
       makeFlyingHares},
      {{"clutter", "two hundred small things on a floor under a spot"}, makeClutter},
      {{"textured", "tiles, bricks, a plant: textures, normal maps, alpha masks, texture transforms"},
       makeTextured},
      {{"bumps", "a bumped, glossy ground and ball under three coloured lights (roughness): fine normals"},
       makeBumps},
      {{"conference", "a room with a normal-mapped floor under glowing panels (roughness)"}, makeConference},
      {{"vehicle", "a small car on slabs under a sky (roughness): gloss and thin parts"}, makeVehicle},
      {{"wet_floor", "the car on a glossy, wavy floor under two glowing panels (roughness)"}, makeWetFloor},
      {{"lanterns", "a knot and a ball pass glowing panels under a moving lamp (8 s, loops): local light"},
       makeLanterns},
      {{"walker", "a skinned figure that walks round a pedestal (8 s, loops)"}, makeWalker},
      {{"passing", "a vane turns above a ball that passes under it (8 s, loops): shadows on what moves"},
       makePassing},
      {{"ring", "a turning ring of gold on a sheet that moves under it (8 s, loops; wave): caustics"},
       makeRing},
      {{"cloud", "a cloud over a plain (density, albedo, g): smoke that light scatters in"}, makeCloud},
      {{"squirrel",
        "a squirrel and six balls slide down a box that leans (4 s): rigid motion, strong colours"},
       makeSquirrel},
      {{"robot", "a tin robot marches and waves (4 s, loops; skin): rigid parts on joints"}, makeRobot},
      {{"packages", "two soft bags jump and wobble (4 s, loops): a skin and a morph target"}, makePackages},
      {{"assembly", "toys are put together on a line under a lamp that moves (4 s, loops)"}, makeAssembly},
      {{"balls", "one to five painted balls over a pale ground (4 s, loops; count)"}, makeBalls},
      {{"pair", "two balls that have grown into each other (4 s, loops; overlap, objects)"}, makePair},
      {{"bend", "a cylinder that bends and straightens (4 s, loops; angle)"}, makeBend},
      {{"box", "a box with sharp edges turns over a pale ground (4 s, loops; lift)"}, makeBox},
      {{"links", "links of a chain within each other (4 s, loops; count)"}, makeLinks},
      {{"bars", "three bars, each over one and under the other (4 s, loops): no order sorts them"}, makeBars},
      {{"furnace-pair", "two white balls under white light (gap, albedo): tends to 1 with bounces"},
       makeFurnacePair},
      {{"mobile", "a turning knot among bouncing balls (8 s, loops): rigid animation"}, makeMobile},
  };
  return all;
}

}  // namespace

const std::vector<BuiltinScene>& builtinScenes() {
  static const std::vector<BuiltinScene> list = [] {
    std::vector<BuiltinScene> names;
    for (const Entry& entry : entries()) names.push_back(entry.about);
    return names;
  }();
  return list;
}

Scene makeBuiltinScene(const std::string& description) {
  NamedValues values("builtin:", description);
  std::vector<std::string> names;
  for (const Entry& entry : entries()) {
    names.emplace_back(entry.about.name);
    if (values.name() != entry.about.name) continue;
    const Detail detail{float(values.take("detail", 1, 0.25, 8))};
    Scene scene = entry.make(detail, values);
    values.finish();
    return scene;
  }
  throw Error(values.place(), fmt::format("no such scene; there are {}", fmt::join(names, ", ")));
}

}  // namespace gloam
