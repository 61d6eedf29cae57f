// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The panel's lower sections: comparison, objects, times and memory, what is saved.
#include <fmt/core.h>

#include <algorithm>

#include "ui.h"

namespace gloam::view {
namespace {

void referenceControls(Session& session) {
  ReferenceChoice& choice = session.reference_choice;
  label("bounces", "surfaces between the first one that light meets and the one that is seen");
  ImGui::SliderInt("##bounces", &choice.bounces, 0, 8, "%d", ImGuiSliderFlags_AlwaysClamp);
  label("same light", "only the light that the technique computes; else all of it");
  ImGui::Checkbox("##same", &choice.same_light);
  const ReferenceView* reference = session.reference();
  if (reference == nullptr) return dim("begins when the picture stands still");
  if (!reference->layers) return;
  if (!ImGui::BeginTable("errors", 2)) return;
  valueRow("samples a pixel", std::to_string(reference->samples));
  valueRow("noise alone", percent(reference->noise, 2));
  if (reference->error) {
    const Metrics& e = *reference->error;
    valueRow("relative RMSE", percent(e.relative_rmse, 2));
    valueRow("gained or lost", fmt::format("{:+.2f} %", e.relative_signed_error * 100.0));
    valueRow("FLIP", fmt::format("{:.3f}", e.flip));
    valueRow("SSIM", fmt::format("{:.3f}", e.ssim));
  }
  valueRow("traced", fmt::format("{:.1f} s", reference->seconds));
  ImGui::EndTable();
}

std::string nodeName(const Scene& scene, int node) {
  const std::string& name = scene.nodes[std::size_t(node)].name;
  return name.empty() ? fmt::format("node {}", node) : name;
}

/// At the right end of a table's cell, as numbers stand.
void rightText(const std::string& text) {
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(room, 0.0f));
  ImGui::TextUnformatted(text.c_str());
}

/// Of pictures of the newest one's kind, the oldest on the left; the top of its scale is written over it.
void framePlot(const Session& session, float scale) {
  const std::vector<float> values = session.history().frameMs();
  if (values.empty()) return;
  const float most = *std::ranges::max_element(values);
  const ImVec2 size(ImGui::GetContentRegionAvail().x, 56.0f * scale);  // a negative width is none here
  const std::string top = fmt::format("{:.0f} ms", most);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  if (values.size() > 1) {
    ImGui::PlotLines("##frames", values.data(), int(values.size()), 0, nullptr, 0.0f, most * 1.1f, size);
  } else {  // of one there is no line
    ImGui::PlotHistogram("##frames", values.data(), 1, 0, nullptr, 0.0f, most * 1.1f, size);
  }
  const ImVec2 text = ImGui::CalcTextSize(top.c_str()), at(low.x + 6.0f * scale, low.y + 2.0f * scale);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + text.x, at.y + text.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  list.AddText(at, ImGui::GetColorU32(ImGuiCol_TextDisabled), top.c_str());
  dim(fmt::format("median {:.1f} ms, p95 {:.1f} ms, of {} of this size", session.history().medianMs(),
                  session.history().p95Ms(), session.history().counted()));
}

void passTable(const Session& session) {
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp;
  if (!ImGui::BeginTable("passes", 3, kFlags)) return;
  ImGui::TableSetupColumn("pass", 0, 3.0f);
  ImGui::TableSetupColumn("median ms", 0, 1.25f);
  ImGui::TableSetupColumn("p95", 0, 1.0f);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted("pass");
  for (const char* name : {"median ms", "p95"}) {
    ImGui::TableNextColumn();
    rightText(name);
  }
  for (const FrameHistory::Row& pass : session.history().rows()) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(pass.name.c_str());
    for (const double ms : {pass.median_ms, pass.p95_ms}) {
      ImGui::TableNextColumn();
      rightText(fmt::format("{:.2f}", ms));
    }
  }
  ImGui::EndTable();
}

void memoryTable(const Drawn& drawn) {
  if (!ImGui::TreeNode("memory", "Device memory: %s", cli::bytesText(double(drawn.memory_bytes)).c_str()))
    return;
  if (ImGui::BeginTable("memory", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
    for (const MemoryUse& use : drawn.memory) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(use.name.c_str());
      ImGui::TableNextColumn();
      rightText(cli::bytesText(double(use.bytes)));
    }
    ImGui::EndTable();
  }
  ImGui::TreePop();
}

}  // namespace

void compareSection(Session& session, UiState& ui) {
  int split = int(session.state.split);
  label("beside it");
  if (ImGui::Combo("##split", &split, "nothing\0a technique\0the reference\0"))
    session.setSplit(Split(split));
  if (session.state.split == Split::kReference) referenceControls(session);
  if (session.state.split != Split::kTechnique) return;
  label("technique");
  if (ImGui::BeginCombo("##right", session.wanted[kRight].info->name)) {
    for (const TechniqueInfo& info : techniques()) {
      if (ImGui::Selectable(info.name, &info == session.wanted[kRight].info)) session.pick(kRight, info.name);
      if (ImGui::IsItemHovered()) helpBeside(info.summary);
    }
    ImGui::EndCombo();
  }
  if (session.waitsFor(kRight)) dim("being prepared");
  if (session.sharesBake()) dim("Drawn of the left half's bake, which local_light decides.");
  optionControls(session, ui, kRight);
}

void objectSection(Session& session, UiState& ui) {
  int turns = ui.turns ? 1 : 0;
  label("handles", "G changes them");
  if (ImGui::Combo("##handles", &turns, "move\0turn\0")) ui.turns = turns == 1;
  if (!session.state.scene) return;
  const LoadedScene& loaded = *session.state.scene;
  if (session.selectedNode() != kNone) {
    ImGui::TextUnformatted(nodeName(loaded.scene, session.selectedNode()).c_str());
  } else {
    dim("Click a thing in the picture, or choose a light.");
  }
  for (const int node : loaded.light_nodes) {
    const std::string text = fmt::format("light: {}##{}", nodeName(loaded.scene, node), node);
    if (ImGui::Selectable(text.c_str(), session.selectedNode() == node)) session.choose(node);
  }
  if (!session.state.moves.empty() && ImGui::Button("Put everything back")) session.resetMoves();
}

void timesSection(Session& session, UiState& ui) {
  const Drawn* drawn = session.drawn();
  if (drawn == nullptr) return;
  framePlot(session, ui.scale);
  noteControl(ui, "frame_plot");
  dim(fmt::format("{} x {}, {}", drawn->width, drawn->height, drawn->device.name));
  passTable(session);
  memoryTable(*drawn);
  dim(fmt::format("panels: {:.2f} ms of the device", ui.ui_device_ms));
  std::string answers = fmt::format("input to picture: {} at most", session.slowestResponse());
  if (session.lastSwitchMs() > 0.0) answers += fmt::format("; last switch {:.0f} ms", session.lastSwitchMs());
  dim(answers);
  if (ImGui::Button("Copy as JSON")) {
    ui.copied = cli::jsonText(session.history().json(*drawn, session.scene_name, ui.ui_device_ms));
    session.say("times are on the clipboard");
  }
  noteControl(ui, "copy_times");
}

void saveSection(Session& session, UiState& ui) {
  const float button = 86.0f * ui.scale;
  const auto line = [&](const char* id, std::string& path, const char* verb) {
    inputPath(id, path, -button - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SameLine();
    ImGui::PushID(id);
    const bool pressed = ImGui::Button(verb, {button, 0.0f}) && !path.empty();
    ImGui::PopID();
    return pressed;
  };
  dim("picture, .png or .exr (F2)");
  if (line("##picture", ui.screenshot, "Save")) session.saveWhole(ui.screenshot);
  dim("video, .mp4 (F3)");
  if (line("##video", ui.video, session.recording() ? "Stop" : "Record")) {
    session.recording() ? session.stopVideo() : session.startVideo(ui.video);
  }
  dim("preset, for gloam render --settings too");
  if (line("##preset", ui.preset, "Save")) session.savePreset(ui.preset);
  if (ImGui::Button("Load preset")) session.loadPreset(ui.preset);
}

}  // namespace gloam::view
