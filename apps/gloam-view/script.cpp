// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "script.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "app.h"
#include "json_file.h"

namespace gloam::view {
namespace {

constexpr std::size_t kMaxSteps = 100000;
constexpr int kMaxDepth = 8, kDragSteps = 8;
constexpr double kDefaultTimeoutSeconds = 120.0;

const std::vector<std::string>& knownSteps() {
  static const std::vector<std::string> kKnown = {"wait",
                                                  "wait_s",
                                                  "mouse",
                                                  "press",
                                                  "release",
                                                  "click",
                                                  "drag",
                                                  "scroll",
                                                  "key",
                                                  "key_down",
                                                  "key_up",
                                                  "text",
                                                  "drop",
                                                  "set",
                                                  "resize",
                                                  "minimise",
                                                  "restore",
                                                  "screenshot",
                                                  "window_screenshot",
                                                  "save_preset",
                                                  "load_preset",
                                                  "video",
                                                  "stats",
                                                  "clipboard",
                                                  "repeat",
                                                  "lose_device",
                                                  "lose_window",
                                                  "quit"};
  return kKnown;
}

glm::vec2 pointOf(const cli::Json& value, std::size_t first, const std::string& place) {
  const bool good = value.is_array() && value.size() >= first + 2 && value[first].is_number() &&
                    value[first + 1].is_number();
  if (!good) throw Error(place, "expected numbers [x, y]");
  return {value[first].get<float>(), value[first + 1].get<float>()};
}

double numberOf(const cli::Json& value, const std::string& place) {
  if (!value.is_number()) throw Error(place, "expected a number");
  return value.get<double>();
}

std::string textOf(const cli::Json& value, const std::string& place) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_boolean()) return value.dump();
  throw Error(place, "expected a string, a number, true or false");
}

}  // namespace

Script::Script(const std::string& file) : file_(file) {
  const cli::Json steps =
      cli::readJsonFile(file, 4 * kMaxDepth, "a list of steps, such as [{\"key\": \"space\"}]");
  try {
    add(steps, "steps", 0);
  } catch (const cli::Json::exception&) {
    throw Error(file, "a step's value is of another type than it takes");
  }
}

void Script::add(const cli::Json& steps, const std::string& place, int depth) {
  if (!steps.is_array()) throw Error(file_ + ": " + place, "expected a list of steps");
  for (std::size_t i = 0; i < steps.size(); ++i) addOne(steps[i], fmt::format("{}[{}]", place, i), depth);
}

void Script::addOne(const cli::Json& step, const std::string& at, int depth) {
  const std::string place = file_ + ": " + at;
  if (!step.is_object() || step.empty())
    throw Error(place, "expected an object such as {\"key\": \"space\"}");
  const std::string what = step.begin().key();
  const cli::Json& value = step.begin().value();
  if (std::ranges::find(knownSteps(), what) == knownSteps().end())
    throw Error(place, fmt::format("no step '{}'; expected {}", what, cli::listed(knownSteps())));
  if (steps_.size() > kMaxSteps || depth > kMaxDepth) throw Error(place, "too many steps");
  const auto push = [&](const char* name, cli::Json v) { steps_.push_back({name, std::move(v), place}); };
  const std::string button = step.value("button", "left");
  if (what == "repeat") {
    if (!value.is_number_integer() || value < 0 || !step.contains("steps"))
      throw Error(place, "expected {\"repeat\": N, \"steps\": […]}");
    for (int i = 0; i < value.get<int>(); ++i) add(step["steps"], at + ".steps", depth + 1);
  } else if (what == "click") {
    pointOf(value, 0, place);
    push("mouse", value);
    push("press", button);
    push("release", button);
  } else if (what == "drag") {
    const glm::vec2 from = pointOf(value, 0, place), to = pointOf(value, 2, place);
    push("mouse", {from.x, from.y});
    push("press", button);
    for (int i = 1; i <= kDragSteps; ++i) {
      const glm::vec2 p = glm::mix(from, to, float(i) / float(kDragSteps));
      push("mouse", {p.x, p.y});
    }
    push("release", button);
  } else if (what == "key") {
    push("key_down", value);
    push("key_up", value);
  } else if (what == "set") {
    if (!value.is_object()) throw Error(place, "expected an object of names and values");
    for (const auto& [name, inner] : value.items()) push("set", {name, textOf(inner, place + ": " + name)});
  } else {
    push(what.c_str(), value);
  }
}

bool Script::play(App& app) {
  if (steps_.empty()) return false;
  const Step step = steps_.front();
  if (!waiting_since_) waiting_since_ = app.session().now_s();
  if (done(app, step)) {
    waiting_since_.reset();
    waited_frames_ = 0;
    steps_.pop_front();
  } else if (app.session().now_s() - *waiting_since_ > kDefaultTimeoutSeconds) {
    throw Error(step.place, fmt::format("nothing after {:.0f} s", kDefaultTimeoutSeconds));
  }
  return !steps_.empty();
}

bool Script::waits() const {
  if (steps_.empty()) return false;
  const Step& step = steps_.front();
  return step.what == "wait_s" || (step.what == "wait" && step.value.is_string());
}

bool Script::done(App& app, const Step& step) {
  const cli::Json& value = step.value;
  Session& session = app.session();
  const std::string& what = step.what;
  if (what == "wait") {
    if (value == "idle" && session.playing && session.drawn() != nullptr && !session.job().busy)
      throw Error(step.place, "nothing stands still while the animation plays");
    if (value == "idle") return app.inputTaken() && session.idle() && ++waited_frames_ > 2;
    if (value == "reference")
      return session.reference() != nullptr &&
             session.reference()->samples >= session.reference_choice.samples;
    if (!value.is_number_integer())
      throw Error(step.place, "expected a number of frames, \"idle\" or \"reference\"");
    return ++waited_frames_ > value.get<int>();
  }
  if (what == "wait_s") return session.now_s() - *waiting_since_ >= numberOf(value, step.place);
  if (what == "mouse") return app.moveMouse(pointOf(value, 0, step.place)), true;
  if (what == "press" || what == "release")
    return app.pressMouse(textOf(value, step.place), what == "press"), true;
  if (what == "scroll") return app.scroll(float(numberOf(value, step.place))), true;
  if (what == "key_down" || what == "key_up")
    return app.pressKey(textOf(value, step.place), what == "key_down"), true;
  if (what == "text") return app.type(textOf(value, step.place)), true;
  if (what == "drop") return session.openDropped(textOf(value, step.place)), true;
  if (what == "set") return session.set(value[0].get<std::string>(), value[1].get<std::string>()), true;
  if (what == "resize") return app.resize(pointOf(value, 0, step.place)), true;
  if (what == "minimise" || what == "restore") return app.minimise(what == "minimise"), true;
  if (what == "screenshot") return session.saveScreenshot(textOf(value, step.place)), true;
  if (what == "save_preset") return session.savePreset(textOf(value, step.place)), true;
  if (what == "load_preset") return session.loadPreset(textOf(value, step.place)), true;
  if (what == "stats") return app.writeStats(textOf(value, step.place)), true;
  if (what == "clipboard") return app.writeClipboard(textOf(value, step.place)), true;
  if (what == "lose_device") return session.loseDevice(), true;
  if (what == "lose_window") return app.loseWindow(), true;
  if (what == "video") {
    value.is_string() ? session.startVideo(value.get<std::string>()) : session.stopVideo();
    return true;
  }
  if (what == "window_screenshot") return app.captureWindow(textOf(value, step.place));
  app.quit();
  return true;
}

}  // namespace gloam::view
