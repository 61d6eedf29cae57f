#!/usr/bin/env bash
# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
#
# Installs the build into a folder of its own, builds the example against it out of the tree, runs it, and checks its
# picture.
#   install_test.sh CMAKE BUILD_FOLDER EXAMPLES_FOLDER
set -euo pipefail
cmake=$1 build=$2 examples=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "install_test: $1" >&2; exit 1; }

"$cmake" --install "$build" --prefix "$work/prefix" > "$work/install.log" || { cat "$work/install.log"; fail "install"; }
headers="error image sh scene spheres spherical_lights neighbourhood volume lights compress bake reference metrics renderer"
for header in $headers; do
  [ -f "$work/prefix/include/gloam/$header.h" ] || fail "gloam/$header.h is not installed"
done
[ "$(find "$work/prefix/include/gloam" -type f | wc -l)" -eq "$(echo $headers | wc -w)" ] ||
  fail "other public headers than those were expected: $(ls "$work/prefix/include/gloam" | tr '\n' ' ')"
[ -f "$work/prefix/share/bash-completion/completions/gloam" ] || fail "no completion"
[ -n "$(find "$work/prefix/share/doc" -name LICENSE)" ] || fail "no licence"
"$work/prefix/bin/gloam" --version | grep -q '^gloam [0-9]' || fail "the installed gloam does not run"

# Neither the source tree nor the build tree may be needed: nothing but the prefix is named here.
generator=$(sed -n 's/^CMAKE_GENERATOR:INTERNAL=//p' "$build/CMakeCache.txt")
sanitize=$(sed -n 's/^GLOAM_SANITIZE:STRING=//p' "$build/CMakeCache.txt")
flags=${sanitize:+-fsanitize=$sanitize}
"$cmake" -S "$examples" -B "$work/build" -G "$generator" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="$flags" > "$work/configure.log" 2>&1 || { cat "$work/configure.log"; fail "configuring the example"; }
"$cmake" --build "$work/build" > "$work/build.log" 2>&1 || { cat "$work/build.log"; fail "building the example"; }

cd "$work"
build/minimal builtin:cornell sky:mild picture.png
prefix/bin/gloam info picture.png --json > picture.json
python3 - <<'PYTHON'
import json
picture = json.load(open("picture.json"))
assert picture["size"] == "640x480", picture["size"]
channels = picture["layers"][0]["channels"]
mean = sum(channel["mean"] for channel in channels[:3]) / 3
assert 0.03 < mean < 0.9, f"mean {mean}: black or white"
assert max(channel["maximum"] for channel in channels) - min(channel["minimum"] for channel in channels) > 0.2, channels
print(f"the example's picture: {picture['size']}, mean {mean:.3f}")
PYTHON

if build/minimal /nowhere.glb 2> error.txt; then fail "a missing scene was no error"; fi
[ "$(wc -l < error.txt)" -eq 1 ] && grep -q nowhere.glb error.txt || fail "no clear error: $(cat error.txt)"
