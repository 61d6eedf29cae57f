// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Input that a script makes, through the same callbacks that GLFW calls.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "app.h"
#include "arguments.h"

namespace gloam::view {
namespace {

int keyOf(const std::string& name) {
  static const std::map<std::string, int> kKeys = {{"space", GLFW_KEY_SPACE},
                                                   {"tab", GLFW_KEY_TAB},
                                                   {"escape", GLFW_KEY_ESCAPE},
                                                   {"enter", GLFW_KEY_ENTER},
                                                   {"left", GLFW_KEY_LEFT},
                                                   {"right", GLFW_KEY_RIGHT},
                                                   {"up", GLFW_KEY_UP},
                                                   {"down", GLFW_KEY_DOWN},
                                                   {"[", GLFW_KEY_LEFT_BRACKET},
                                                   {"]", GLFW_KEY_RIGHT_BRACKET},
                                                   {",", GLFW_KEY_COMMA},
                                                   {".", GLFW_KEY_PERIOD},
                                                   {"f2", GLFW_KEY_F2},
                                                   {"f3", GLFW_KEY_F3},
                                                   {"f5", GLFW_KEY_F5},
                                                   {"f9", GLFW_KEY_F9},
                                                   {"shift", GLFW_KEY_LEFT_SHIFT},
                                                   {"ctrl", GLFW_KEY_LEFT_CONTROL}};
  if (const auto found = kKeys.find(name); found != kKeys.end()) return found->second;
  if (name.size() == 1 && std::isalpha(static_cast<unsigned char>(name[0])))
    return GLFW_KEY_A + (std::tolower(name[0]) - 'a');
  if (name.size() == 1 && std::isdigit(static_cast<unsigned char>(name[0])))
    return GLFW_KEY_0 + (name[0] - '0');
  throw Error("script", fmt::format("no key '{}'", name));
}

int buttonOf(const std::string& name) {
  if (name == "left") return 0;
  if (name == "right") return 1;
  if (name == "middle") return 2;
  throw Error("script", fmt::format("no button '{}'; expected left, right or middle", name));
}

}  // namespace

void App::moveMouse(const glm::vec2& at) {
  mouse_ = at;
  input_s_ = glfwGetTime();
}

void App::pressMouse(const std::string& button, bool down) {
  buttons_[buttonOf(button)] = down;
  if (!mouse_) mouse_ = glm::vec2(0.0f);
  input_s_ = glfwGetTime();
}

void App::scroll(float steps) {
  ImGui_ImplGlfw_ScrollCallback(window_, 0.0, double(steps));
}

void App::pressKey(const std::string& key, bool down) {
  const int code = keyOf(key);
  ImGuiIO& io = ImGui::GetIO();
  ImGui_ImplGlfw_KeyCallback(window_, code, 0, down ? GLFW_PRESS : GLFW_RELEASE,
                             (io.KeyShift ? GLFW_MOD_SHIFT : 0) | (io.KeyCtrl ? GLFW_MOD_CONTROL : 0));
}

void App::type(const std::string& text) {
  for (const char c : text) ImGui_ImplGlfw_CharCallback(window_, static_cast<unsigned char>(c));
}

void App::resize(const glm::vec2& size) {
  glfwSetWindowSize(window_, std::max(1, int(size.x)), std::max(1, int(size.y)));
}

void App::minimise(bool minimised) {
  minimised ? glfwIconifyWindow(window_) : glfwRestoreWindow(window_);
}

}  // namespace gloam::view
