// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What happens every frame of the window: results are taken, the next picture is asked for.
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "arguments.h"
#include "gpu/shader_code.h"
#include "session.h"
#include "show.h"

namespace gloam::view {
namespace {

/// Of this program, where the system tells; else 0.
std::size_t residentBytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  in >> all >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

/// What a picture costs depends on it.
std::string kindOf(const std::string& left, const std::string& right, const std::string& show) {
  return left + " " + right + " " + show;
}

constexpr int kMostGrowths = 8, kMostLosses = 3;
constexpr double kLookSeconds = 0.25;   // between looks at the sources of shaders
constexpr double kSettleSeconds = 0.3;  // after the last change of a slider, before long work starts

}  // namespace

void Session::update(int width, int height) {
  if (width > 0 && (width != width_ || height != height_)) {
    resolution.fit(double(width) * height);
    growths_ = 0;
    grown_from_ = 0.0f;
  }
  width_ = width;
  height_ = height;
  for (const std::string& remark : jobs_.take()) say(remark);
  if (!preparing_ && now_s() - last_pick_s_ > kSettleSeconds) prepare();
  takeDrawn();
  takeReference();
  advance();
  requestPicture();
  savePending();
  followReference();
  followShaders();
}

/// To the first picture of the technique that was picked.
void Session::beginSwitch() {
  switch_started_s_ = now_s();
  switch_clock_ = std::clock();
}

void Session::takeDrawn() {
  std::shared_ptr<const Drawn> drawn = worker_.take();
  if (!drawn) return;
  answered_serial_ = drawn->serial;
  asked_s_ = now_s();
  answered_width_ = drawn->width;
  if (!drawn->error.empty()) return takeProblem(*drawn);
  losses_ = 0;
  if (!drawn->missing_show.empty()) takeMissing(*drawn);
  for (const std::string& warning : drawn->warnings) {
    const bool said = std::ranges::any_of(messages_, [&](const Message& m) { return m.text == warning; });
    if (!said) say(warning);
  }
  const double frame_ms = drawn->left.frame_ms + drawn->right.frame_ms;
  const std::string kind = kindOf(drawn->technique, drawn->right_technique, drawn->show);
  if (!measured_.insert(kind).second) {  // the first of its kind compiles shaders
    resolution.add(kind, double(drawn->width) * drawn->height,
                   float(drawn->height) / float(std::max(height_, 1)), frame_ms);
  }
  const float scale_drawn = float(drawn->height) / float(std::max(height_, 1));
  if (drawn->serial == serial_ && still_serial_ == serial_ && !video_ && growths_ < kMostGrowths &&
      resolution.mayGrow(scale_drawn, frame_ms)) {
    ++growths_;
    grown_from_ = scale_drawn;
    still_serial_ = 0;  // once more, larger
  }
  history_.add(*drawn);
  if (state.display.auto_exposure) state.display = drawn->display;
  for (const auto& [serial, number] : drawn->answers) {
    if (response_serial_ == 0 || serial < response_serial_) continue;
    slowest_response_ = std::max(slowest_response_, number - response_from_);
    response_serial_ = 0;
  }
  if (switch_started_s_ >= 0.0 && drawn->technique == wanted[kLeft].info->name) {
    switch_ms_ = (now_s() - switch_started_s_) * 1000.0;
    switch_work_ms_ = double(std::clock() - switch_clock_) * 1000.0 / CLOCKS_PER_SEC;
    switch_started_s_ = -1.0;
  }
  drawn_ = std::move(drawn);
  ++picture_revision_;
  if (click_) select(*drawn_);
  if (!video_) return;
  try {
    const LayeredImage* right = drawn_->split ? drawn_->right.layers.get() : nullptr;
    video_->add(*drawn_, right, divider);
  } catch (const std::exception& error) {
    say(error.what(), true);
    video_.reset();
  }
}

/// What was shown stays.
void Session::takeProblem(const Drawn& drawn) {
  say(drawn.error, true);
  if (!drawn_) fatal = drawn.error;
  if (drawn.error.find("device was lost") == std::string::npos) return;
  if (++losses_ > kMostLosses) {
    fatal = "gpu: the device was lost again and again";
    return;
  }
  say("the renderer starts anew");
  ++serial_;
}

/// Images of other techniques, or of options that were turned off, have no place here.
void Session::takeMissing(const Drawn& drawn) {
  if (state.show != drawn.missing_show || waitsFor(kLeft) || drawn.technique != wanted[kLeft].info->name)
    return;
  const std::string problem =
      fmt::format("show '{}': {} makes no image of that name", state.show, drawn.technique);
  if (!drawn_) fatal = fmt::format("{}; expected {}", problem, cli::listed(drawn.image_names));
  say(problem + "; its light is shown", true);
  state.show.clear();
}

/// The node of the surface that was clicked.
void Session::select(const Drawn& drawn) {
  const Layer* objects = drawn.left.layers->find("object");
  if (objects == nullptr) return;
  const glm::vec2 place = *std::exchange(click_, std::nullopt);
  const int x = std::clamp(int(place.x * float(drawn.width)), 0, drawn.width - 1);
  const int y = std::clamp(int(place.y * float(drawn.height)), 0, drawn.height - 1);
  const std::uint32_t id = objects->ids[std::size_t(y) * std::size_t(drawn.width) + std::size_t(x)];
  choose(id > 0 && id <= state.scene->instance_nodes.size() ? state.scene->instance_nodes[std::size_t(id - 1)]
                                                            : kNone);
}

/// By the clock while it plays, a picture at a time; by even steps while a video is taken.
void Session::advance() {
  const double now = now_s();
  if (!playing) {
    if (video_ && !worker_.busy() && drawn_ && drawn_->serial == serial_) changed();  // the next frame
    return;
  }
  if (worker_.busy()) return;
  const double step = video_ ? 1.0 / double(VideoCapture::kFramesPerSecond) : (now - last_advance_s_);
  last_advance_s_ = now;
  const float length = duration_s_ > 0.0f ? duration_s_ : 1e6f;
  state.time_s = std::fmod(state.time_s + float(step) * speed, length);
  changed();
}

void Session::requestPicture() {
  if (!state.scene || width_ <= 0 || height_ <= 0) return;
  const bool moves = moving() && !video_;
  // What stands still is drawn once at the size that it keeps: times that vary do not draw it again and again.
  if (!moves && still_serial_ == serial_ && still_width_ == width_ && still_height_ == height_) return;
  if (worker_.busy() && sent_serial_ == serial_) return;
  takePicks();
  const bool both = state.split == Split::kTechnique;
  const std::string kind = kindOf(state.left.info->name, both ? state.right.info->name : "", state.show);
  float scale = resolution.scale(kind, double(width_) * height_, moves, moves && switch_started_s_ >= 0.0);
  if (!moves && grown_from_ > 0.0f) scale = resolution.grown(scale, grown_from_);
  int width = std::max(1, int(std::lround(float(width_) * scale)));
  int height = std::max(1, int(std::lround(float(height_) * scale)));
  if (video_ && video_->frames() > 0 && drawn_) width = drawn_->width, height = drawn_->height;
  const bool measured = state.split == Split::kReference && traced_ && *traced_ == referenceKey();
  if (!moves && measured) width = traced_width_, height = traced_height_;  // samples go on
  if (sent_serial_ == serial_ && sent_width_ == width && sent_height_ == height) {
    if (!moves) still_serial_ = serial_, still_width_ = width_, still_height_ = height_;
    return;
  }
  state.width = width;
  state.height = height;
  state.layers = wantsLayers();
  state.camera = camera.posed();
  if (!worker_.busy()) asked_s_ = now_s();
  sent_kind_ = kind;
  worker_.request(serial_, state);
  sent_serial_ = serial_;
  sent_width_ = width;
  sent_height_ = height;
  if (!moves) still_serial_ = serial_, still_width_ = width_, still_height_ = height_;
}

std::string Session::firstPicture() const {
  constexpr double kPatienceSeconds = 0.7;
  const double since = now_s() - asked_s_;
  if (!worker_.busy() || measured_.contains(sent_kind_) || since < kPatienceSeconds) return "";
  return fmt::format("First picture of {}: the device compiles its shaders, {:.0f} s", state.left.info->name,
                     since);
}

/// Sources that were edited are compiled in the background; what goes wrong leaves the shader as it was.
void Session::followShaders() {
  if (now_s() - last_look_s_ < kLookSeconds) return;
  last_look_s_ = now_s();
  for (const gpu::ShaderCode* code : shaders_.changed()) {
    const auto work = [this, code, folder = shaders_.folder()](JobConsole&) -> Jobs::Finish {
      ShaderWatch::reload(folder, *code);
      return [this, code] {
        say(fmt::format("{}: compiled", code->source));
        changed();
      };
    };
    jobs_.start(fmt::format("Compiling {}", code->name), work,
                [this](const std::string& problem) { say(problem, true); });
  }
}

bool Session::idle() const {
  return stands() && pending_picture_.empty();
}

bool Session::stands() const {
  const bool prepared = !jobs_.status().busy && !preparing_ && !waitsFor(kLeft) && !waitsFor(kRight);
  const bool shown =
      prepared && !worker_.busy() && drawn_ && answered_serial_ == serial_ && answered_width_ == sent_width_;
  if (dragging) return shown && !playing && now_s() - last_change_s_ >= kStillSeconds;
  return shown && !moving() && still_serial_ == serial_;
}

cli::Json Session::stats(double ui_device_ms, int ui_objects) const {
  cli::Json json = drawn_ ? history_.json(*drawn_, scene_name, ui_device_ms) : cli::Json::object();
  json["pictures"] = worker_.pictures();
  json["input_to_picture"] = slowest_response_;
  json["last_switch_ms"] = switch_ms_;
  json["last_switch_work_ms"] = switch_work_ms_;  // of all processors, the window's share with it
  json["ui_objects"] = ui_objects;
  json["resident_bytes"] = residentBytes();
  json["camera"] = {{"eye", cli::shortest(camera.eye())}, {"target", cli::shortest(camera.target())}};
  json["time_s"] = cli::shortest(state.time_s);
  json["exposure"] = cli::shortest(state.display.exposure_stops);
  json["show"] = state.show;
  json["environment"] = state.base ? state.base->map->name : "";
  json["env_rotation"] = cli::shortest(state.env_rotation_deg);
  json["selected"] = selected_node_;
  json["scale"] = drawn_ && height_ > 0 ? double(drawn_->height) / height_ : 0.0;
  json["moves"] = state.moves.size();
  json["nodes"] = state.scene ? state.scene->scene.nodes.size() : 0;
  json["waits"] = waitsFor(kLeft) || waitsFor(kRight);
  if (state.left.info != nullptr) json["settings"] = cli::settingsJson(*state.left.info, state.left.settings);
  if (reference_) {
    json["reference"] = {
        {"samples", reference_->samples}, {"noise", reference_->noise}, {"seconds", reference_->seconds}};
    if (reference_->error) json["reference"]["relative_rmse"] = reference_->error->relative_rmse;
  }
  cli::Json said = cli::Json::array();
  for (const Message& message : messages_) said.push_back(message.text);
  json["messages"] = said;
  return json;
}

}  // namespace gloam::view
