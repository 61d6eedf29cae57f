#!/usr/bin/env python3
# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Checks that dependencies run one way: every #include of one room by another must be allowed below.

Usage: check_includes.py REPOSITORY. Prints each offending line; exit 1 if there is one.
"""
import pathlib
import re
import sys

SCENE_SIDE = {"math", "image", "scene"}
FRAME_SIDE = SCENE_SIDE | {"gpu", "frame"}
TECHNIQUE_SIDE = FRAME_SIDE | {"spheres", "trace", "vpls", "visibility"}

# room -> rooms that it may include (itself always).
ALLOWED = {
    "math": set(),
    "image": {"math"},
    "scene": {"math", "image"},
    "spheres": SCENE_SIDE,
    "trace": SCENE_SIDE,
    "reference": SCENE_SIDE | {"spheres", "trace"},
    "gpu": set(),
    "frame": SCENE_SIDE | {"gpu"},
    "visibility": FRAME_SIDE | {"trace"},
    "vpls": FRAME_SIDE | {"trace", "visibility"},
    "techniques": TECHNIQUE_SIDE,
    "renderer": TECHNIQUE_SIDE | {"techniques"},
}
# Public headers are the declarations of rooms. error.h is everyone's; renderer.h declares options, which techniques fill.
PUBLIC_ROOM = {"error.h": None, "sh.h": "math", "image.h": "image", "scene.h": "scene", "bake.h": None, "metrics.h": "image", "reference.h": "reference", "spheres.h": "spheres", "spherical_lights.h": None, "neighbourhood.h": "scene", "volume.h": "scene", "lights.h": "scene", "compress.h": "scene", "renderer.h": None}
# Libraries that only one room may include.
ONLY_IN = [(re.compile(r"embree[34]?/"), {"trace"}), (re.compile(r"(volk\.h|vulkan/)"), {"gpu"})]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def room_of(path):
    """('techniques', 'prt') for src/techniques/prt/x.cpp, ('math', None) for src/math/sh.cpp."""
    parts = path.parts
    if parts[0] == "techniques" and len(parts) > 2:
        return parts[0], parts[1]
    return parts[0], None


def check_file(root, path):
    source = path.relative_to(root / "src")
    room, technique = room_of(source)
    if room not in ALLOWED:
        yield f"src/{source}: room '{room}' is not in tests/check_includes.py"
        return
    is_test = "_test" in path.stem
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, name = match.groups()
        where = f"src/{source}:{number}"
        for pattern, rooms in ONLY_IN:
            if pattern.match(name) and room not in rooms:
                yield f"{where}: {name} may be included only in {', '.join(sorted(rooms))}/"
        if name.startswith("gloam/"):
            header = name[len("gloam/"):]
            if header not in PUBLIC_ROOM:
                yield f"{where}: {name} is not a public header"
                continue
            target, target_technique = PUBLIC_ROOM[header], None
            if header in ("bake.h", "renderer.h") and room not in ("techniques", "renderer"):
                yield f"{where}: {room}/ includes {name}"
        else:
            if not (root / "src" / name).exists():
                if bracket == '"' and not (path.parent / name).exists() and not name.startswith("shaders/") \
                        and not is_test:
                    yield f"{where}: {name} does not exist"
                continue
            target, target_technique = room_of(pathlib.PurePath(name))
        if target is None:
            continue
        if target == room:
            if technique and target_technique and technique != target_technique:
                yield f"{where}: technique {technique} includes technique {target_technique}"
        elif target not in ALLOWED[room] and not is_test:
            yield f"{where}: {room}/ includes {name} of {target}/"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    suffixes = {".h", ".cpp", ".glsl"}
    files = sorted(p for p in (root / "src").rglob("*") if p.suffix in suffixes)
    if not files:
        sys.exit(f"check_includes.py: no sources under {root}/src")
    problems = [problem for path in files for problem in check_file(root, path)]
    print("\n".join(problems) if problems else f"{len(files)} files: includes run one way")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
