// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The panel on the right: scene, technique, light, camera, view.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "show.h"
#include "ui.h"

namespace gloam::view {
namespace {

bool section(const char* name, bool open) {
  ImGui::Spacing();
  return ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

/// "Light: from afar direct and bounced; of lamps direct".
std::string lightText(const Coverage& covers) {
  std::string text;
  const auto add = [&](const char* source, bool direct, bool bounced) {
    if (!direct && !bounced) return;
    text += fmt::format("{}{} {}", text.empty() ? "Light: " : "; ", source,
                        direct && bounced ? "direct and bounced" : (direct ? "direct" : "bounced"));
  };
  add("from afar", covers.environment_direct, covers.environment_indirect);
  add("of lamps", covers.local_direct, covers.local_indirect);
  add("of what glows", covers.emitter_direct, covers.emitter_indirect);
  return text;
}

/// Other things than lamps.
bool movesThings(const ViewState& state) {
  const std::vector<int>& lamps = state.scene->light_nodes;
  return std::ranges::any_of(
      state.moves, [&](const auto& move) { return std::ranges::find(lamps, move.first) == lamps.end(); });
}

std::string shortName(const std::string& name) {
  return name.starts_with("builtin:") ? name : std::filesystem::path(name).filename().string();
}

void openPopup(Session& session, UiState& ui) {
  ImGui::SetNextWindowPos({ImGui::GetWindowPos().x - 8.0f * ui.scale, 12.0f * ui.scale}, ImGuiCond_Always,
                          {1.0f, 0.0f});  // beside the panel
  if (!ImGui::BeginPopup("open")) return;
  dim("A file (or drop one on the window)");
  if (inputPath("##path", ui.path, 320.0f * ui.scale) && !ui.path.empty()) {
    session.openDropped(ui.path);
    ImGui::CloseCurrentPopup();
  }
  if (!session.recent().names().empty()) {
    ImGui::Spacing();
    dim("Opened before");
    for (const std::string& name : session.recent().names()) {
      if (ImGui::Selectable(shortName(name).c_str())) session.open(name);
      if (ImGui::IsItemHovered() && shortName(name) != name) helpBeside(name.c_str());
    }
  }
  ImGui::Spacing();
  dim("Built in");
  ImGui::BeginChild("scenes", {320.0f * ui.scale, 180.0f * ui.scale});
  for (const BuiltinScene& scene : builtinScenes()) {
    if (ImGui::Selectable(scene.name)) {
      session.open(fmt::format("builtin:{}", scene.name));
      ImGui::CloseCurrentPopup();
    }
    if (ImGui::IsItemHovered()) helpBeside(scene.summary);
  }
  ImGui::EndChild();
  ImGui::EndPopup();
}

std::size_t triangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += mesh.triangleCount();
  return count;
}

}  // namespace

void sceneSection(Session& session, UiState& ui) {
  if (ImGui::Button("Open…")) ImGui::OpenPopup("open");
  openPopup(session, ui);
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shortName(session.scene_name).c_str());
  if (!session.state.scene) return;
  const Scene& scene = session.state.scene->scene;
  const std::size_t lamps = session.state.scene->light_nodes.size();
  dim(fmt::format("{} triangles in {} mesh{}, {}", cli::countText(triangles(scene)), scene.meshes.size(),
                  scene.meshes.size() == 1 ? "" : "es",
                  lamps == 0   ? "no lamps"
                  : lamps == 1 ? "1 lamp"
                               : fmt::format("{} lamps", lamps)));
}

void techniqueSection(Session& session, UiState& ui) {
  if (!section("Technique", true)) return;
  ImGui::SetNextItemWidth(-1.0f);
  const TechniqueInfo& wanted = *session.wanted[kLeft].info;
  if (ImGui::BeginCombo("##technique", wanted.name)) {
    for (const TechniqueInfo& info : techniques()) {
      if (ImGui::Selectable(info.name, &info == &wanted)) session.pick(kLeft, info.name);
      if (ImGui::IsItemHovered()) helpBeside(info.summary);
    }
    ImGui::EndCombo();
  }
  noteControl(ui, "technique");
  dim(wanted.summary);
  if (session.waitsFor(kLeft)) dim(fmt::format("being prepared; {} is shown", session.state.left.info->name));
  const Coverage covers = coverageWith(wanted, session.wanted[kLeft].settings);
  const bool lamps_only = !covers.environment_direct && !covers.environment_indirect;
  if (lamps_only && session.state.scene && session.state.scene->light_nodes.empty())
    dim("It computes the light of lamps, and this scene has none.");
  dim(lightText(covers));
  if (wanted.needs_bake && session.state.scene && movesThings(session.state))
    dim("Its bake is of things where the file has them: what was moved keeps that shadow and light.");
  ImGui::Spacing();
  optionControls(session, ui, kLeft);
}

void lightSection(Session& session) {
  if (!section("Light", true)) return;
  ViewState& state = session.state;
  label("from afar", "An .exr or .hdr dropped on the window takes its place");
  const std::string& named = session.environment_name;
  const std::string shown = !named.empty()                            ? shortName(named)
                            : state.base && !state.base->map->empty() ? state.base->map->name
                                                                      : "none";
  if (ImGui::BeginCombo("##env", shown.c_str())) {
    if (ImGui::Selectable("the scene's own", named.empty())) session.openEnvironment("");
    if (ImGui::Selectable("none", named == "none")) session.openEnvironment("none");
    for (const BuiltinScene& sky : builtinSkies()) {
      const std::string name = fmt::format("sky:{}", sky.name);
      if (ImGui::Selectable(name.c_str(), named == name)) session.openEnvironment(name);
      if (ImGui::IsItemHovered()) helpBeside(sky.summary);
    }
    ImGui::EndCombo();
  }
  bool changed = false;
  label("rotation");
  changed |= ImGui::SliderFloat("##rotation", &state.env_rotation_deg, -180.0f, 180.0f, "%.0f°");
  label("intensity");
  changed |= ImGui::SliderFloat("##intensity", &state.env_intensity, 0.0f, 16.0f, "%.2f",
                                ImGuiSliderFlags_Logarithmic);
  label("exposure", "in stops: each doubles the light");
  ImGui::SetNextItemWidth(-52.0f * ImGui::GetFontSize() / 14.0f);
  changed |= ImGui::SliderFloat("##exposure", &state.display.exposure_stops, -10.0f, 10.0f, "%+.2f");
  ImGui::SameLine();
  if (ImGui::Button("Auto", {-1.0f, 0.0f})) {
    state.display.auto_exposure = changed = true;
    state.display.exposure_stops = 0.0f;
  }
  label("tone curve");
  int curve = state.display.tone_map == ToneMap::kAces ? 1 : 0;
  if (ImGui::Combo("##curve", &curve, "none\0aces\0")) {
    state.display.tone_map = curve == 1 ? ToneMap::kAces : ToneMap::kNone;
    changed = true;
  }
  label("background");
  changed |= ImGui::Checkbox("##background", &state.background);
  if (changed) session.changed();
}

void cameraSection(Session& session) {
  if (!section("Camera", false)) return;
  const Camera& camera = session.camera.camera();
  if (!camera.perspective) {
    float height = 2.0f * camera.half_height;
    label("height", "of what an orthographic camera shows, in metres");
    if (ImGui::DragFloat("##height", &height, 0.01f * height, 1e-4f, 1e6f, "%.3g m",
                         ImGuiSliderFlags_AlwaysClamp)) {
      session.camera.setOrtho(height);
      session.changed();
    }
  } else {
    float fov = glm::degrees(camera.vertical_fov_rad);
    label("field of view");
    if (ImGui::SliderFloat("##fov", &fov, 5.0f, 120.0f, "%.0f°")) {
      session.camera.setFov(glm::radians(fov));
      session.changed();
    }
  }
  if (session.state.scene && !session.state.scene->scene.cameras.empty()) {
    label("of the scene");
    if (ImGui::BeginCombo("##cameras", "go to…")) {
      const PosedScene posed = pose(session.state.scene->scene, session.state.time_s);
      for (std::size_t i = 0; i < posed.cameras.size(); ++i) {
        const std::string& name = posed.cameras[i].camera.name;
        const std::string text = fmt::format("{}##{}", name.empty() ? fmt::format("camera {}", i) : name, i);
        if (!ImGui::Selectable(text.c_str())) continue;
        session.camera.set(posed.cameras[i], posed);
        session.changed();
      }
      ImGui::EndCombo();
    }
  }
  if (ImGui::Button("Show all of it")) session.frameScene();
  const glm::vec3 eye = session.camera.eye();
  dim(fmt::format("eye {:.3g}, {:.3g}, {:.3g}", eye.x, eye.y, eye.z));
}

void viewSection(Session& session, UiState& ui) {
  if (!section("View", true)) return;
  label("shows", "the light, a layer of the frame, or any image that the technique makes on its way");
  const std::string& show = session.state.show;
  if (ImGui::BeginCombo("##show", show.empty() ? "light" : show.c_str(), ImGuiComboFlags_HeightLarge)) {
    if (ImGui::Selectable("light", show.empty())) session.setShow("");
    for (const std::string& name : cli::frameLayers()) {
      if (ImGui::Selectable(name.c_str(), show == name)) session.setShow(name);
    }
    ImGui::Separator();
    if (session.drawn() != nullptr) {
      for (const std::string& name : session.drawn()->image_names) {
        if (ImGui::Selectable(name.c_str(), show == name)) session.setShow(name);
      }
    }
    ImGui::EndCombo();
  }
  noteControl(ui, "show");
  label("resolution", "share of the window's pixels; auto draws fewer while something moves");
  int percent = int(std::lround(session.resolution.fixed * 100.0f));
  if (ImGui::SliderInt("##scale", &percent, 0, 100, percent == 0 ? "auto" : "%d %%")) {
    session.resolution.fixed = percent < 5 ? 0.0f : float(percent) / 100.0f;
    session.changed();
  }
  label("supersample");
  if (ImGui::SliderInt("##supersample", &session.state.supersample, 1, 4, "%d", ImGuiSliderFlags_AlwaysClamp))
    session.changed();
  label("pixel inspector", "linear values under the mouse (I)");
  if (ImGui::Checkbox("##inspector", &ui.inspector)) session.inspect(ui.inspector);
}

void drawPanel(Session& session, UiState& ui, const Place& place, const ImVec2& window) {
  if (place.size.x >= window.x) return;
  ImGui::SetNextWindowPos({place.size.x, 0.0f});
  ImGui::SetNextWindowSize({window.x - place.size.x, window.y});
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  sceneSection(session, ui);
  techniqueSection(session, ui);
  lightSection(session);
  viewSection(session, ui);
  static Split seen = Split::kNone;  // what is compared shows its numbers
  if (std::exchange(seen, session.state.split) != session.state.split && session.state.split != Split::kNone)
    ImGui::SetNextItemOpen(true);
  if (section("Compare", false)) compareSection(session, ui);
  cameraSection(session);
  if (section("Move things", false)) objectSection(session, ui);
  const bool times = section("Times and memory", false);
  noteControl(ui, "times");
  if (times) timesSection(session, ui);
  if (section("Save", false)) saveSection(session, ui);
  ImGui::End();
}

}  // namespace gloam::view
