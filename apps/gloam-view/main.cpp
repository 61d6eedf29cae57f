// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam-view: a scene in a window. Whatever goes wrong is one line and an exit code, as in gloam itself.
#include <fmt/core.h>

#include <cstdio>
#include <new>

#include "app.h"

namespace gloam::view {
namespace {

int fail(const std::string& message, int code) {
  fmt::print(stderr, "gloam-view: {}\n", cli::singleLine(message));
  return code;
}

int guarded(const std::vector<std::string>& arguments) {
  try {
    std::string help;
    const ViewerChoice choice = parseArguments(arguments, &help);
    if (!help.empty()) {
      std::fputs(help.c_str(), stdout);
      return 0;
    }
    cli::catchInterrupts();
    App app(choice);
    app.run();
    return cli::interrupted() ? 1 : 0;
  } catch (const Error& error) {
    return fail(error.what(), 2);
  } catch (const std::bad_alloc&) {
    return fail("out of memory", 2);
  } catch (const std::exception& error) {
    return fail(fmt::format("unexpected error: {}", error.what()), 2);
  }
}

}  // namespace
}  // namespace gloam::view

int main(int argc, char** argv) {
  return gloam::view::guarded({argv + 1, argv + argc});
}
