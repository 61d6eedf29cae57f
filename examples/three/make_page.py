#!/usr/bin/env python3
# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Packs a baked .glb, three.js and the reader beside this file into one page that opens from disk, without a server.

  make_page.py BAKED.glb PAGE.html [three.module.min.js]

three.js comes from npm: `tools/get-assets three` puts it into assets/three.
"""
import base64
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
THREE = HERE.parents[1] / "assets/three/three.module.min.js"


def packed(path):
    return base64.b64encode(path.read_bytes()).decode()


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__.strip())
    model, page, three = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), pathlib.Path((sys.argv + [THREE])[3])
    for path in model, three:
        if not path.is_file():
            sys.exit(f"make_page: {path}: no such file" + ("; tools/get-assets three fetches it" if path == THREE else ""))
    parts = {
        "TITLE": model.stem,
        "THREE": packed(three),
        "RELIGHT": packed(HERE / "relight.js"),
        "MODEL": packed(model),
    }
    text = (HERE / "page.html").read_text()
    for name, part in parts.items():
        text = text.replace(f"@{name}@", part, 1)
    page.write_text(text)


if __name__ == "__main__":
    main()
