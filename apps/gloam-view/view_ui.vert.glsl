// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Triangles of the panels and the picture: points of the window to clip space.
#version 460

layout(location = 0) in vec2 place;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
layout(push_constant) uniform Push {
  vec2 scale, shift;
} push;
layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;

void main() {
  out_uv = uv;
  out_color = color;
  gl_Position = vec4(place * push.scale + push.shift, 0.0, 1.0);
}
