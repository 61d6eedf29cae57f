// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the command line and scripts ask the window for: pictures of it, numbers, the clipboard.
#include <GLFW/glfw3.h>
#include <image/atomic_file.h>

#include <algorithm>

#include "app.h"

namespace gloam::view {
namespace {

void writeText(const std::string& path, const std::string& text) {
  AtomicFile out(path);
  out.write(text.data(), text.size());
  out.commit();
}

}  // namespace

/// A picture that was asked for on the command line has the size that was asked for, whatever the window's is.
bool App::drawsAlone() const {
  return !choice_.screenshot.empty() && choice_.window_screenshot.empty();
}

/// --screenshot, --window-screenshot: after --frames pictures, when the last one stands.
void App::runErrands() {
  if (choice_.screenshot.empty() && choice_.window_screenshot.empty()) return;
  if (!session_->idle()) return;
  const int wanted = choice_.frames > 0 ? choice_.frames : 2;
  if (session_->pictures() < wanted) return session_->changed();
  if (!choice_.window_screenshot.empty()) {
    if (captureWindow(choice_.window_screenshot)) choice_.window_screenshot.clear();
    if (!choice_.window_screenshot.empty() || !choice_.screenshot.empty())
      return;  // alone from the next frame on
  }
  if (!choice_.screenshot.empty()) {
    const LayeredImage* right = session_->drawn()->split ? session_->drawn()->right.layers.get() : nullptr;
    savePicture(choice_.screenshot, *session_->drawn(), right, session_->divider);
  }
  if (!script_) ui_.quit = true;
  choice_.screenshot.clear();
}

bool App::captureWindow(const std::string& path) {
  if (!capture_asked_) {
    surface_->requestCapture();
    capture_asked_ = true;
    return false;
  }
  surface_->wait();
  const Image image = surface_->takeCapture();
  if (image.empty()) return false;
  capture_asked_ = false;
  writePng(image, path);
  return true;
}

void App::writeStats(const std::string& path) {
  cli::Json stats = session_->stats(ui_.ui_device_ms, device_->liveObjects());
  stats["picture_place"] = {place_.low.x, place_.low.y, place_.size.x, place_.size.y};
  stats["panel"] = ui_.panel;
  stats["controls"] = cli::Json::object();
  for (const auto& [name, at] : ui_.controls)
    stats["controls"][name] = {at.low.x, at.low.y, at.size.x, at.size.y};
  stats["inspected"] = ui_.inspected;
  stats["right_tag"] = ui_.right_tag;
  stats["light_marks"] = cli::Json::array();
  for (const LightMark& mark : lightMarks(*session_, place_))
    stats["light_marks"].push_back({mark.at.x, mark.at.y});
  writeText(path, cli::jsonText(stats) + "\n");
}

void App::writeClipboard(const std::string& path) {
  const char* text = glfwGetClipboardString(window_);
  if (text == nullptr) throw Error(path, "there is no text on the clipboard");
  writeText(path, text);
}

}  // namespace gloam::view
