// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "rows.h"

#include <fmt/core.h>

namespace gloam::cli {

const char* worksText(Row::Works works) {
  switch (works) {
    case Row::Works::kYes:
      return "yes";
    case Row::Works::kPartly:
      return "partly";
    case Row::Works::kNotYet:
      break;
  }
  return "not yet";
}

std::string rowsMarkdown() {
  std::string out =
      "# The rows\n\n"
      "What gloam is to do, by name. Docs, tests and `gloam list --rows` use these names. This page is made "
      "by\n"
      "`gloam list --rows --markdown` from the table in `apps/gloam/rows_table.cpp`; a test holds it to "
      "that.\n";
  for (const RowGroup& group : rowGroups()) {
    out += fmt::format(
        "\n## {}: {} ({})\n\n| row | what | works | command that shows it | held by "
        "|\n|---|---|---|---|---|\n",
        group.prefix, group.system, group.source);
    for (const Row& row : group.rows) {
      std::string works = worksText(row.works);
      if (row.works == Row::Works::kPartly) works += fmt::format("; lacks {}", row.missing);
      const std::string command = *row.command ? fmt::format("`{}`", row.command) : "";
      out += fmt::format("| {} | {} | {} | {} | {} |\n", row.name, row.what, works, command, row.test);
    }
  }
  return out;
}

}  // namespace gloam::cli
