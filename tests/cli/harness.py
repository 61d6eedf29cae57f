# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""What the tests of the command line share: running it as a user would, and files made on the spot.

GLOAM names the program; every test works in a folder of its own, with a cache of its own.
"""
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest

GLOAM = os.environ["GLOAM"]
SOURCE = pathlib.Path(__file__).resolve().parents[2]
VERBS = ["render", "bake", "compare", "reference", "diff", "info", "list", "scene", "bench", "completion"]
SMALL = ["--size", "48x32"]
BOX = "builtin:cornell?detail=0.25"


class Result:
    def __init__(self, arguments, process):
        self.arguments = arguments
        self.code = process.returncode
        self.out = process.stdout
        self.err = process.stderr

    def __str__(self):
        return f"gloam {' '.join(map(str, self.arguments))}\nexit {self.code}\n--- stdout\n{self.out}\n--- stderr\n{self.err}"


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="gloam-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"), GLOAM_VALIDATION="1")

    def path(self, name):
        return self.folder / name

    def gloam(self, *arguments, environment=None):
        process = subprocess.run([GLOAM, *map(str, arguments)], cwd=self.folder, env=environment or self.environment,
                                 capture_output=True, text=True, errors="replace", timeout=120, check=False)
        return Result(arguments, process)

    def succeed(self, *arguments, **keywords):
        """Runs, expects exit code 0."""
        result = self.gloam(*arguments, **keywords)
        self.assertEqual(result.code, 0, str(result))
        self.assertNotIn("validation", result.err.lower(), str(result))
        return result

    def succeed_json(self, *arguments, **keywords):
        """Runs with --json; the parsed result."""
        result = self.succeed(*arguments, "--json", **keywords)
        return json.loads(result.out)

    def refuse(self, *arguments, says=(), **keywords):
        """Runs, expects exit code 2, nothing on stdout, one line on stderr that holds all of `says`."""
        before = self.listing()
        result = self.gloam(*arguments, **keywords)
        self.assertEqual(result.code, 2, str(result))
        self.assertEqual(result.out, "", str(result))
        lines = result.err.splitlines()
        self.assertEqual(len(lines), 1, str(result))
        self.assertTrue(lines[0].startswith("gloam: "), str(result))
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(str(word), lines[0], str(result))
        self.assertEqual(self.listing(), before, f"a file was left behind by\n{result}")
        return lines[0]

    def interrupt(self, *command, output, how=signal.SIGINT):
        """Starts again and again until the signal falls into the middle of the work, so that `output` has a checkpoint but is
        not there; what it said then."""
        checkpoint = self.path(output + ".checkpoint")
        delay_s = 0.3
        for _ in range(12):
            process = subprocess.Popen([GLOAM, *map(str, command)], cwd=self.folder, env=self.environment,
                                       stderr=subprocess.PIPE, text=True)
            time.sleep(delay_s)
            sent = time.monotonic()
            process.send_signal(how)
            err = process.communicate(timeout=60)[1]
            if process.returncode == 1 and checkpoint.exists():
                self.assertLess(time.monotonic() - sent, 10)
                self.assertFalse(self.path(output).exists())
                return err
            delay_s *= 0.7 if process.returncode == 0 else 1.3
            self.path(output).unlink(missing_ok=True)
        self.fail(f"never interrupted in the middle; the last time: exit {process.returncode}, {err}")

    def listing(self):
        """Names and sizes of all files of the test's folder; the cache may grow."""
        files = (p for p in self.folder.rglob("*") if self.path("cache") not in [p, *p.parents])
        return sorted((str(p), p.stat().st_size if p.is_file() else -1) for p in files)

    def picture(self, name):
        """What `gloam info` says of a picture."""
        return self.succeed_json("info", self.path(name))

    def means(self, name, layer=""):
        """Channel means of a layer, by the channel's name."""
        layers = {entry["name"]: entry for entry in self.picture(name)["layers"]}
        return {channel["name"]: channel["mean"] for channel in layers[layer]["channels"]}


def glb(document, binary=b""):
    """A .glb of a JSON document and a binary chunk."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def triangle(positions=None, indices=(0, 1, 2)):
    """(document, binary) of a scene that is one triangle."""
    positions = positions or [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    vertex_bytes = b"".join(struct.pack("<3f", *p) for p in positions)
    index_bytes = b"".join(struct.pack("<I", i) for i in indices)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(vertex_bytes) + len(index_bytes)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(vertex_bytes)},
                        {"buffer": 0, "byteOffset": len(vertex_bytes), "byteLength": len(index_bytes)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
    }
    return document, vertex_bytes + index_bytes


def moving_triangle():
    """(document, binary) of a triangle that moves 4 m along x within 1 s, with a camera that looks at the beginning."""
    document, binary = triangle([(-1, -1, 0), (1, -1, 0), (0, 1, 0)])
    start = len(binary)
    binary += struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 4, 0, 0)
    document["bufferViews"] += [{"buffer": 0, "byteOffset": start, "byteLength": 8},
                                {"buffer": 0, "byteOffset": start + 8, "byteLength": 24}]
    document["accessors"] += [
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}]
    document["buffers"][0]["byteLength"] = len(binary)
    document["animations"] = [{"samplers": [{"input": 2, "output": 3}],
                               "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
    document["cameras"] = [{"name": "front", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}]
    document["nodes"].append({"camera": 0, "translation": [0, 0, 4]})
    document["scenes"][0]["nodes"] = [0, 1]
    return document, binary


def spinning_triangle():
    """That as a .glb."""
    return glb(*moving_triangle())


def hdr(width=4, height=2, pixel=(128, 128, 128, 129)):
    """A flat Radiance picture; the default pixel is radiance 1."""
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + bytes(pixel) * (width * height)
