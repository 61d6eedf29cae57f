// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The path tracer beside the picture: when it begins, goes on and ends.
#include "session.h"
#include "show.h"

namespace gloam::view {

ReferenceKey Session::referenceKey() const {
  const Camera& of = camera.camera();
  const Coverage light =
      reference_choice.same_light ? coverageWith(*state.left.info, state.left.settings) : kAllLight;
  return {state.scene.get(),
          state.base.get(),
          {state.env_rotation_deg, state.env_intensity, state.time_s, of.vertical_fov_rad, of.half_height,
           resolution.fixed},
          {reference_choice.bounces, reference_choice.samples, width_, height_},
          camera.posed().world_from_view,
          state.lights.text(),
          state.moves,
          light,
          state.background};
}

void Session::dropReference() {
  tracer_.stop();
  traced_.reset();
  reference_.reset();
  ++picture_revision_;
}

/// Begins when the picture stands still, and goes on until something changes that it depends on. Exposure, the inspector, what is
/// shown and how the technique computes its light do not: a new picture of the technique is measured against the same samples.
void Session::followReference() {
  if (state.split != Split::kReference || !drawn_) return;
  ReferenceKey key = referenceKey();
  if (traced_ && *traced_ != key) dropReference();
  if (moving() || drawn_->serial != serial_ || still_serial_ != serial_ || worker_.busy()) return;
  const bool fits = traced_ && traced_width_ == drawn_->width && traced_height_ == drawn_->height;
  if (fits && compared_ == drawn_) return;
  compared_ = drawn_;
  if (fits) return tracer_.compare(drawn_);
  traced_width_ = drawn_->width;
  traced_height_ = drawn_->height;
  tracer_.start(state, drawn_, key.light, reference_choice.bounces, reference_choice.samples);
  traced_ = std::move(key);
}

void Session::takeReference() {
  auto reference = tracer_.take();
  if (!reference || state.split != Split::kReference) return;
  if (!reference->problem.empty()) say(reference->problem, true);
  reference_ = std::move(reference);
  ++picture_revision_;
}

Image Session::referencePicture() const {
  if (state.split != Split::kReference || !reference_ || !reference_->layers) return {};
  DisplayOptions display = state.display;
  display.auto_exposure = false;
  const bool same = drawn_ && reference_->layers->find(drawn_->show) != nullptr;
  return cli::shownPicture(*reference_->layers, same ? drawn_->show : "", display);
}

}  // namespace gloam::view
