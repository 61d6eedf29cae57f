// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What is asked for. session_files.cpp reads and saves, session_prepare.cpp bakes and fits, session_update.cpp has what happens
// every frame, session_reference.cpp the path tracer's share of it, session_set.cpp names and values.
#include "session.h"

#include <fmt/core.h>

#include <algorithm>

#include "outline.h"

namespace gloam::view {
namespace {

constexpr std::size_t kKeptMessages = 60;

}  // namespace

Session::Session(const ViewerChoice& choice, std::function<void()> wake)
    : choice_(choice),
      shaders_(choice.shader_folder),
      jobs_(wake),
      worker_(choice.device, wake),
      tracer_(wake) {
  resolution.fixed = choice.scale;
  for (Pick& pick : wanted) pick = pickOf(techniques().front());
  state.left = state.right = wanted[kLeft];
  adoptChoice(choice);
  state.time_s = choice.view.time_s;
  open(choice.scene.name, choice.scene.ground);
}

double Session::now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

void Session::say(const std::string& text, bool problem) {
  if (text.empty()) return;
  Message message{cli::singleLine(text), problem, now_s()};
  if (!messages_.empty() && messages_.back().text == message.text) messages_.pop_back();  // said once
  messages_.push_back(std::move(message));
  if (messages_.size() > kKeptMessages) messages_.pop_front();
}

void Session::changed() {
  ++serial_;
  growths_ = 0;
  grown_from_ = 0.0f;
  last_change_s_ = now_s();
  if (response_serial_ == 0) {
    response_serial_ = serial_;
    response_from_ = worker_.pictures();
  }
}

bool Session::moving() const {
  return playing || dragging || now_s() - last_change_s_ < kStillSeconds;
}

/// All of a choice but scene and camera.
void Session::adoptChoice(const ViewerChoice& choice) {
  state.env_rotation_deg = choice.light.rotation_deg;
  state.env_intensity = choice.light.intensity;
  state.lights = choice.light.lights;
  light_texts = choice.light.light_texts;
  state.supersample = choice.view.supersample;
  state.display = cli::displayOf(choice.display);
  state.background = choice.display.background;
  state.show = choice.show;
  for (const TechniqueInfo& info : techniques()) {
    if (choice.technique.name != info.name) continue;
    wanted[kLeft] = {&info, cli::settingsFor(info, choice.technique)};
    beginSwitch();
  }
}

void Session::open(const std::string& name, bool ground) {
  ViewerChoice choice = choice_;
  choice.scene.name = name;
  choice.scene.ground = ground;
  if (!first_) {
    choice.view.camera.clear(), choice.view.eye.reset(), choice.view.target.reset();
    choice.view.time_s = 0.0f;
    choice.moves.clear();
    choice.spheres.clear();
    choice.light.environment = environment_name;
  }
  openChoice(choice, [this, before = read_light_.count] {
    if (read_light_.count == before) return;  // else a probe was dropped just before the scene: it stays
    state.base = read_light_.base;
    environment_name = read_light_.name;
  });
}

PosedCamera Session::framed(const PosedCamera& camera, const PosedScene& posed) const {
  PosedCamera framed = framingCamera(posed, aspect());
  const float z_near = std::min(framed.camera.z_near, camera.camera.z_near);
  framed.camera = camera.camera;
  framed.camera.z_near = z_near;
  return framed;
}

/// Reads scene and light. `then` runs when they are shown.
void Session::openChoice(const ViewerChoice& choice, std::function<void()> then) {
  const bool first = first_;
  cli::LightChoice light = choice.light;
  light.rotation_deg = 0.0f;  // turned later, as often as wanted
  light.intensity = 1.0f;
  const auto work = [this, choice, light, then](JobConsole& console) -> Jobs::Finish {
    Scene scene = cli::loadSceneToDraw(choice.scene, console);
    if (!choice.spheres.empty()) readSpheres(choice.spheres, scene);  // refused before anything has changed
    auto base =
        std::make_shared<const DistantLight>(mapLight(cli::chooseBaseEnvironment(scene, light, console)));
    const PosedScene posed = pose(scene, choice.view.time_s);
    const PosedCamera posed_camera = cli::chooseCamera(posed, choice.view, console);
    cli::remarkBuriedLamps(scene, posed, posed_camera, console);
    const cli::NodeMoves moves = cli::movesIn(scene, choice.moves);
    auto loaded = makeLoadedScene({.name = choice.scene.name,
                                   .ground = choice.scene.ground,
                                   .spheres = choice.spheres,
                                   .scene = std::move(scene)});
    const bool any = posed.cameras.empty() && !choice.view.eye;  // to be framed as the window is by then
    return [this, loaded, base, posed, posed_camera, moves, choice, then, any] {
      camera.set(any && height_ > 0 ? framed(posed_camera, posed) : posed_camera, posed);
      if (choice.view.eye && choice.view.target) camera.setTarget(*choice.view.eye, *choice.view.target);
      environment_name = choice.light.environment;
      state.time_s = choice.view.time_s;
      adopt(loaded, base);
      state.moves = moves;
      if (then) then();
      prepare();
      changed();
    };
  };
  const std::string name = choice.scene.name;
  jobs_.start(fmt::format("Opening {}", name), work, [this, name, first](const std::string& problem) {
    if (first && !state.scene) fatal = problem.empty() ? fmt::format("{}: not opened", name) : problem;
    say(problem, true);
  });
}

void Session::adopt(std::shared_ptr<const LoadedScene> scene, std::shared_ptr<const DistantLight> base) {
  const bool first = std::exchange(first_, false);
  state.scene = std::move(scene);
  state.base = std::move(base);
  state.needs = {};
  state.moves.clear();
  choose(kNone);
  playing = false;
  duration_s_ = state.scene->scene.duration_s();
  scene_name = state.scene->name;
  recent_.add(scene_name);
  resolution.forget();
  measured_.clear();
  if (first && choice_.technique.name.empty()) {
    const TechniqueInfo& info = cli::chooseTechnique(choice_.technique, state.scene->scene);
    wanted[kLeft] = {&info, cli::settingsFor(info, choice_.technique)};
  }
}

void Session::openEnvironment(const std::string& name) {
  if (!state.scene) return say(fmt::format("{}: no scene is there yet", name), true);
  const auto scene = state.scene;
  const cli::LightChoice light{.environment = name, .light_texts = light_texts, .lights = state.lights};
  const auto work = [this, scene, light, name](JobConsole& console) -> Jobs::Finish {
    auto base = std::make_shared<const DistantLight>(
        mapLight(cli::chooseBaseEnvironment(scene->scene, light, console)));
    return [this, base, name] {
      state.base = base;
      environment_name = name;
      read_light_ = {base, name, read_light_.count + 1};
      changed();
    };
  };
  jobs_.start(fmt::format("Reading {}", name.empty() ? "the scene's light" : name), work,
              [this](const std::string& problem) { say(problem, true); });
}

void Session::pick(Side side, const std::string& name) {
  if (name == wanted[side].info->name) return;
  wanted[side] = pickOf(technique(name));
  if (const auto given = choice_.technique.values.find(name); given != choice_.technique.values.end())
    wanted[side].settings = cli::settingsFor(*wanted[side].info, choice_.technique);
  beginSwitch();
  prepare();
  changed();
}

void Session::setOption(Side side, const std::string& name, const std::string& text) {
  wanted[side].settings.set(name, text);
  choice_.technique.values[wanted[side].info->name][name] = text;
  last_pick_s_ = now_s();
  takePicks();
  changed();
}

void Session::setSplit(Split split) {
  if (split == Split::kTechnique && wanted[kRight].info == wanted[kLeft].info && techniques().size() > 1) {
    const bool same = wanted[kLeft].info == &techniques()[0];
    wanted[kRight] = pickOf(techniques()[same ? 1 : 0]);
  }
  state.split = split;
  dropReference();
  prepare();
  changed();
}

void Session::setShow(const std::string& name) {
  state.show = name;
  prepare();
  changed();
}

void Session::setTime(float time_s) {
  state.time_s = std::clamp(time_s, 0.0f, std::max(duration_s_, 0.0f));
  changed();
}

void Session::play(bool play) {
  playing = play && (duration_s_ > 0.0f || state.lights.moves());
  last_advance_s_ = now_s();
  changed();
}

void Session::frameScene() {
  if (!state.scene) return;
  const PosedScene posed = cli::poseMoved(state.scene->scene, state.moves, state.time_s);
  camera.frame(posed.bounds_min, posed.bounds_max, aspect());
  changed();
}

void Session::resetMoves() {
  state.moves.clear();
  changed();
}

void Session::clickAt(const glm::vec2& place) {
  click_ = place;
  changed();
}

void Session::choose(int node) {
  if (selected_node_ == node) return;
  selected_node_ = node;
  ++picture_revision_;
  const bool seen = drawn_ && drawn_->left.layers && drawn_->left.layers->find("object") != nullptr;
  if (!seen && wantsLayers()) changed();
}

void Session::inspect(bool inspects) {
  inspects_ = inspects;
  changed();
}

std::vector<bool> Session::chosenInstances() const {
  if (!state.scene || selected_node_ == kNone) return {};
  return instancesBelow(state.scene->scene, state.scene->instance_nodes, selected_node_);
}

/// For what is clicked, outlined or inspected.
bool Session::wantsLayers() const {
  const std::vector<bool> chosen = chosenInstances();
  return inspects_ || click_ || pending_picture_.ends_with(".exr") || std::ranges::find(chosen, true) != chosen.end();
}

void Session::loseDevice() {
  worker_.loseDevice();
  changed();
}

}  // namespace gloam::view
