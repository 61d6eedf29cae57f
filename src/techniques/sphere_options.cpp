// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/sphere_options.h"

namespace gloam {

Option spheresOption() {
  return {.name = "spheres",
          .default_value = 0,
          .minimum = 0,
          .maximum = 4096,
          .help =
              "spheres that stand for all that casts, when they are made for this picture; 0: by size and "
              "shape, 26 or more"};
}

Option divisorOption() {
  return {.name = "divisor",
          .default_value = std::string("4"),
          .choices = {"1", "2", "4", "8"},
          .help = "light is computed for one receiver in a square of that many pixels a side"};
}

Option partsOption() {
  return {.name = "parts",
          .default_value = true,
          .help =
              "the light's sharpest peak (a sun) through visibility apart from the rest, neither below 0: no "
              "coloured rings in contact shadows; not with a window"};
}

Option windowOption() {
  return {.name = "window",
          .default_value = std::string("none"),
          .choices = {"none", "hann", "lanczos", "auto"},
          .help =
              "damping of ringing around small bright lights; auto: as little as keeps light non-negative, "
              "which takes most of a sun's shadow"};
}

}  // namespace gloam
