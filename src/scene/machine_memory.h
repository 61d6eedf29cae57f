// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What long work may take at most when nobody said.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <limits>

namespace gloam {

/// Bytes of the machine's memory; the largest number where the system does not tell.
inline std::size_t memoryOfMachine() {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page_bytes <= 0) return std::numeric_limits<std::size_t>::max();
  return std::size_t(pages) * std::size_t(page_bytes);
}

}  // namespace gloam
