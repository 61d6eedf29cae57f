// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The one table of measures: names, words and direction. What prints, writes or bounds measures goes through it.
#pragma once

#include <gloam/metrics.h>

#include <span>

namespace gloam {

struct Measure {
  enum class Better { kLower, kHigher, kNearerZero };
  const char* key;      ///< "relative_squared_error", in JSON and CSV
  const char* title;    ///< "relative squared error", in tables
  const char* unit;     ///< "dB", or nothing
  const char* meaning;  ///< one line
  Better better;
  double Metrics::*value;
};
std::span<const Measure> measureTable();

/// What is held against a bound: the value, or its size where zero is best. Never not-a-number.
double boundedValue(const Measure& measure, const Metrics& metrics);
/// Whether the value is worse than the bound.
bool exceeds(const Measure& measure, const Metrics& metrics, double bound);

}  // namespace gloam
