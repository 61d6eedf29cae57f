// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What techniques need before they can be shown: bakes, spheres and what those send, in the background and kept.
#include <fmt/core.h>

#include <algorithm>

#include "bake_run.h"
#include "emission_run.h"
#include "session.h"
#include "show.h"
#include "spheres_run.h"

namespace gloam::view {

bool hasBakeFor(const Pick& pick, const LoadedScene& scene) {
  if (!pick.info->needs_bake) return true;
  if (!cli::carriesTransfer(scene.scene)) return false;
  return !scene.unbaked || scene.apart == cli::bakesApart(*pick.info, pick.settings);
}

bool hasSpheresFor(const Pick& pick, const LoadedScene& scene, const Needs& needs) {
  if (!pick.info->needs_spheres) return true;
  if (pick.info->needs_emission && !needs.emission) return false;
  return needs.spheres && needs.of == &scene && needs.sphere_count == pick.settings.integer("spheres");
}

/// There is one bake at a time: where both halves want one, the left half says of which kind.
bool Session::isBaked(Side side, const Pick& pick) const {
  const bool follows =
      side == kRight && wanted[kLeft].info->needs_bake && cli::carriesTransfer(state.scene->scene);
  return follows || hasBakeFor(pick, *state.scene);
}

bool Session::isReady(Side side, const Pick& pick) const {
  return isBaked(side, pick) && hasSpheresFor(pick, *state.scene, state.needs);
}

bool Session::waitsFor(Side side) const {
  return state.scene && (side == kLeft || state.split == Split::kTechnique) && !isReady(side, wanted[side]);
}

bool Session::sharesBake() const {
  return state.split == Split::kTechnique && wanted[kRight].info->needs_bake &&
         isBaked(kRight, wanted[kRight]) && !hasBakeFor(wanted[kRight], *state.scene);
}

/// Starts what the picked techniques lack: one thing after the other.
void Session::prepare() {
  if (!state.scene || preparing_) return;
  takePicks();
  for (const Side side : {kLeft, kRight}) {
    if (!waitsFor(side)) continue;
    const Pick& pick = wanted[side];
    if (!isBaked(side, pick)) return startBake(pick);
    if (pick.info->needs_spheres)
      return startSpheres(pick.settings.integer("spheres"), pick.info->needs_emission);
  }
  if (cli::showsSpheres(state.show) && !state.needs.spheres) startSpheres(SphereOptions{}.count, false);
}

/// What was moved stays moved where a bake has made more nodes: they stand behind those that were there; where they do not, by
/// their names.
void Session::carryMoves(const Scene& from, const Scene& to) {
  const auto same = [](const Node& a, const Node& b) { return a.name == b.name; };
  if (to.nodes.size() >= from.nodes.size() &&
      std::equal(from.nodes.begin(), from.nodes.end(), to.nodes.begin(), same))
    return;
  choose(kNone);
  try {
    std::vector<cli::MoveText> texts;
    for (const std::string& text : cli::moveTexts(from, state.moves)) texts.push_back(cli::parseMove(text));
    state.moves = cli::movesIn(to, texts);
  } catch (const Error& error) {
    state.moves.clear();
    say(fmt::format("what was moved is back in its place: {}", error.what()));
  }
}

void Session::startBake(const Pick& pick) {
  preparing_ = true;
  const auto scene = state.scene;
  const auto unbaked = scene->unbaked ? scene->unbaked : scene;
  const bool apart = cli::bakesApart(*pick.info, pick.settings);
  const auto work = [this, scene, unbaked, apart, time_s = state.time_s,
                     use_cache = choice_.use_cache](JobConsole& console) -> Jobs::Finish {
    Scene baked = cli::bakeForDrawing(unbaked->scene, unbaked->name, time_s, use_cache, console, apart);
    auto loaded = makeLoadedScene({.name = unbaked->name,
                                   .ground = unbaked->ground,
                                   .spheres = unbaked->spheres,
                                   .scene = std::move(baked),
                                   .unbaked = unbaked,
                                   .apart = apart});
    return [this, scene, loaded] {
      preparing_ = false;
      if (state.scene == scene) {  // not another one in the meantime
        carryMoves(scene->scene, loaded->scene);
        if (fittedScene(loaded) != fittedScene(scene)) state.needs = {};
        state.scene = loaded;
        state.needs.of = loaded.get();
        resolution.forget();
        measured_.clear();
      }
      prepare();
      changed();
    };
  };
  jobs_.start(fmt::format("Baking for {}", pick.info->name), work, [this](const std::string& problem) {
    preparing_ = false;
    say(problem.empty() ? "baking was stopped; picked again, it goes on from there" : problem, true);
    for (Pick* p : {&wanted[kLeft], &wanted[kRight]}) {
      if (p->info->needs_bake) *p = state.left;
    }
    prepare();
  });
}

void Session::startSpheres(int count, bool emission) {
  preparing_ = true;
  const auto scene = state.scene;
  const auto work = [this, scene, count, emission,
                     use_cache = choice_.use_cache](JobConsole& console) -> Jobs::Finish {
    const LoadedScene& fitted = *fittedScene(scene);
    auto spheres = std::make_shared<const SceneSpheres>(cli::spheresForDrawing(
        fitted.scene, fitted.name, use_cache, console, count, nullptr, fitted.spheres));
    std::shared_ptr<const SceneEmission> sent;
    if (emission) {
      sent = std::make_shared<const SceneEmission>(
          cli::emissionForDrawing(fitted.scene, *spheres, fitted.name, use_cache, console));
    }
    return [this, scene, spheres, sent, count] {
      preparing_ = false;
      if (state.scene == scene) state.needs = {spheres, sent, count, scene.get()};
      prepare();
      changed();
    };
  };
  jobs_.start("Fitting spheres", work, [this](const std::string& problem) {
    preparing_ = false;
    say(problem.empty() ? "fitting of spheres was stopped" : problem, true);
    for (Pick* p : {&wanted[kLeft], &wanted[kRight]}) {
      if (p->info->needs_spheres)
        *p = state.left.info->needs_spheres ? pickOf(techniques().front()) : state.left;
    }
    if (cli::showsSpheres(state.show)) state.show.clear();
    prepare();
  });
}

/// What is ready is shown from the next picture on.
void Session::takePicks() {
  if (!state.scene) return;
  for (const Side side : {kLeft, kRight}) {
    Pick& shown = side == kLeft ? state.left : state.right;
    if (isReady(side, wanted[side])) shown = wanted[side];
    if (!isReady(side, shown)) shown = pickOf(techniques().front());  // of a scene before this one
  }
}

}  // namespace gloam::view
