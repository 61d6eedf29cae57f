// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What gloam is to do, by name: each row is a piece of one of the five papers, or goes beyond them. `gloam list --rows`
// and docs/rows.md come from this one table.
#pragma once

#include <span>
#include <string>

namespace gloam::cli {

struct Row {
  enum class Works { kNotYet, kPartly, kYes };
  const char* name;  ///< "PRT-3"
  const char* what;  ///< one line
  Works works = Works::kNotYet;
  const char* missing = "";  ///< of a row that works partly: what it lacks
  const char* command = "";  ///< shows the row at work
  const char* test = "";     ///< holds it: the test's name for ctest, and which cases of it
};

struct RowGroup {
  const char* prefix;
  const char* system;
  const char* source;
  std::span<const Row> rows;
};

std::span<const RowGroup> rowGroups();
/// "yes", "partly", "not yet".
const char* worksText(Row::Works works);
/// docs/rows.md.
std::string rowsMarkdown();

}  // namespace gloam::cli
