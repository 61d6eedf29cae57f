#!/usr/bin/env python3
# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam-view under Xvfb, with the validation layer on: real mouse and keys by xdotool, and scripts."""
import base64
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zlib

GLOAM = os.environ["GLOAM"]
VIEW = os.environ["GLOAM_VIEW"]
BOX = "builtin:cornell?detail=0.25"
SMALL = ["--size", "640x420"]
SOURCES = pathlib.Path(__file__).resolve().parents[2] / "src"
RED = "  imageStore(direct, pixel, vec4(1.0, 0.0, 0.0, 1.0));\n"


def png_size_and_rows(path):
    """Width, height and unfiltered rows of an 8-bit PNG without interlace."""
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    raw, rows, stride = zlib.decompress(packed), [], width * channels
    before = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a = line[i - channels] if i >= channels else 0
            b, c = before[i], before[i - channels] if i >= channels else 0
            if kind == 1:
                line[i] = (line[i] + a) & 255
            elif kind == 2:
                line[i] = (line[i] + b) & 255
            elif kind == 3:
                line[i] = (line[i] + (a + b) // 2) & 255
            elif kind == 4:
                p = a + b - c
                pick = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                line[i] = (line[i] + pick) & 255
        rows.append(line)
        before = line
    return width, height, rows


class Display:
    """An X server of its own; its number goes into DISPLAY."""

    def __init__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "3840x2160x24", "-nolisten", "tcp"],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        if not number:
            raise RuntimeError("Xvfb does not start")
        self.name = f":{number}"

    def close(self):
        self.server.terminate()
        self.server.wait(10)


class ViewerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.display = Display()
        cls.cache = tempfile.mkdtemp(prefix="gloam-view-cache-")

    @classmethod
    def tearDownClass(cls):
        cls.display.close()
        shutil.rmtree(cls.cache, ignore_errors=True)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="gloam-view-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.environment = dict(os.environ, DISPLAY=self.display.name, XDG_CACHE_HOME=self.cache,
                                XDG_CONFIG_HOME=str(self.folder / "config"), GLOAM_VALIDATION="1")

    def view(self, *arguments, environment=None):
        return subprocess.run([VIEW, *map(str, arguments)], cwd=self.folder, env=environment or self.environment,
                              capture_output=True, text=True, errors="replace", timeout=120, check=False)

    def succeed(self, *arguments):
        result = self.view(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("validation", result.stderr.lower())

    def refuse(self, *arguments, says, environment=None):
        result = self.view(*arguments, environment=environment)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("gloam-view: "), result.stderr)
        self.assertIn(says, result.stderr)

    def render(self, *arguments):
        subprocess.run([GLOAM, "render", *arguments, "--quiet"], cwd=self.folder, env=self.environment, check=True, timeout=120)

    def assert_same(self, one, other):
        """Two PNGs: of the same size, one value in two hundred more than two steps apart at most."""
        view, render = (png_size_and_rows(self.folder / name) for name in (one, other))
        self.assertEqual(view[:2], render[:2])
        pairs = [(a, b) for u, v in zip(view[2], render[2]) for a, b in zip(u, v)]
        self.assertLess(sum(abs(a - b) > 2 for a, b in pairs), len(pairs) // 200)

    def script(self, steps, *arguments):
        """Plays the steps; what `stats` steps wrote, by name."""
        (self.folder / "steps.json").write_text(json.dumps(steps))
        self.succeed(*(arguments or (BOX, *SMALL)), "--script", "steps.json")

    def stats(self, name):
        return json.loads((self.folder / name).read_text())

    # ---- bad input -------------------------------------------------------------------------------------------------

    def test_refusals_are_one_line(self):
        bare = {k: v for k, v in self.environment.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.refuse(says="`gloam render`", environment=bare)
        self.refuse("--technique", "nonsense", says="nonsense")
        self.refuse("nothing.glb", says="nothing.glb")
        (self.folder / "bad.json").write_text('[{"fly": 1}]')
        self.refuse("--script", "bad.json", says="steps[0]: no step 'fly'")
        no_driver = dict(self.environment, VK_ICD_FILENAMES="/nonexistent.json", VK_DRIVER_FILES="/nonexistent.json")
        self.refuse(BOX, says="mesa-vulkan-drivers", environment=no_driver)

    # ---- pictures --------------------------------------------------------------------------------------------------

    def test_screenshots_show_what_render_draws(self):
        self.succeed(BOX, *SMALL, "--screenshot", "view.png", "--frames", "2")  # of that size, without the panels
        self.succeed(BOX, *SMALL, "--scale", "0.5", "--screenshot", "view.exr")
        subprocess.run([GLOAM, "render", BOX, "--size", "640x420", "-o", "render.png", "--quiet"], cwd=self.folder,
                       env=self.environment, check=True, timeout=60)
        width, height, view = png_size_and_rows(self.folder / "view.png")
        self.assertEqual((width, height), (640, 420))
        _, _, render = png_size_and_rows(self.folder / "render.png")
        view_bytes, render_bytes = b"".join(map(bytes, view)), b"".join(map(bytes, render))
        if len(view_bytes) == len(render_bytes):
            differing = sum(abs(a - b) > 2 for a, b in zip(view_bytes[::7], render_bytes[::7]))
            self.assertLess(differing, len(view_bytes) // 7 // 100)
        info = subprocess.run([GLOAM, "info", "view.exr", "--json"], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True, check=True, timeout=60)
        for layer in ["indirect", "normal", "object"]:
            self.assertIn(layer, info.stdout)

    def test_presets_go_to_render_and_back(self):
        self.script([
            {"wait": "idle"},
            {"set": {"exposure": 0.5, "env": "sky:noon", "env_rotation": 40, "irradiance.order": 4, "background": False}},
            {"drag": [200, 200, 260, 180]}, {"wait": "idle"},
            {"save_preset": "preset.json"}, {"stats": "before.json"},
            {"set": {"exposure": -2, "env_rotation": 0, "env": "none", "irradiance.order": 2}}, {"key": "f"}, {"wait": "idle"},
            {"load_preset": "preset.json"}, {"wait": "idle"}, {"stats": "after.json"}])
        before, after = self.stats("before.json"), self.stats("after.json")
        for key in ["exposure", "env_rotation", "settings", "environment"]:
            self.assertEqual(before[key], after[key], key)
        for a, b in zip(before["camera"]["eye"], after["camera"]["eye"]):
            self.assertAlmostEqual(a, b, places=3)
        self.assertEqual(before["settings"]["order"], 4)
        done = subprocess.run([GLOAM, "render", BOX, "--settings", "preset.json", "--size", "48x32", "--json", "-o", "p.png"],
                              cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["settings"]["order"], 4)

    def test_presets_of_every_technique_draw_what_was_shown(self):
        """Options that change what is baked or fitted, too: `gloam render --settings` makes the same of them."""
        options = {"irradiance": {"order": 4}, "prt": {"local_light": "all"}, "proxies": {"spheres": 3, "divisor": 2},
                   "spherical_lights": {"lamp_radius": 0.1}, "splatting": {"vpls": 64}, "radiance_filter": {"sets": 3}}
        known = json.loads(subprocess.run([GLOAM, "list", "--techniques", "--json"], env=self.environment, capture_output=True,
                                          text=True, check=True, timeout=60).stdout)
        self.assertEqual({t["name"] for t in known["techniques"]}, set(options))
        lamps = {"splatting"}
        for scene, names in [(BOX, lamps), ("builtin:balls?count=2&detail=0.25", set(options) - lamps)]:
            steps = [{"wait": "idle"}]
            for name in sorted(names):
                steps += [{"set": {"technique": name}}, {"wait": "idle"}, {"screenshot": f"{name}_plain.png"},
                          {"set": {f"{name}.{option}": value for option, value in options[name].items()}}, {"wait": "idle"},
                          {"screenshot": f"{name}.png"}, {"save_preset": f"{name}.json"}]
            self.script(steps, scene, "--size", "160x120", "--no-panel", "--scale", "1")
        for name in options:
            with self.subTest(name):
                self.render("--settings", f"{name}.json", "-o", "render.png")
                self.assert_same(f"{name}.png", "render.png")
        self.assertNotEqual(png_size_and_rows(self.folder / "prt_plain.png"), png_size_and_rows(self.folder / "prt.png"))

    def test_a_bake_fits_no_spheres_anew(self):
        turns = [step for name in ["prt", "proxies", "prt"] for step in ({"set": {"technique": name}}, {"wait": "idle"})]
        self.script([{"wait": "idle"}, *turns, {"stats": "after.json"}], "builtin:balls?count=2&detail=0.25", *SMALL, "--scale", "0.2",
                    "--technique", "proxies", "--proxies.spheres", "3", "--no-cache")
        after = self.stats("after.json")
        self.assertEqual(after["technique"], "prt", after["messages"])
        self.assertEqual(sum("fitting 3 spheres" in line for line in after["messages"]), 1, after["messages"])

    def test_spheres_of_a_file_are_drawn_and_kept_in_presets(self):
        scene = "builtin:balls?detail=0.25"
        subprocess.run([GLOAM, "bake", "spheres", scene, "--count", "5", "-o", "few.json", "--quiet"], cwd=self.folder,
                       env=self.environment, stdout=subprocess.DEVNULL, check=True, timeout=60)
        self.script([{"wait": "idle"}, {"screenshot": "view.png"}, {"save_preset": "preset.json"},
                     {"set": {"scene": BOX}}, {"wait": "idle"}, {"drop": "preset.json"}, {"wait": "idle"}, {"screenshot": "back.png"}],
                    scene, "--technique", "proxies", "--spheres", "few.json", "--size", "192x144", "--no-panel", "--scale", "1")
        self.assertEqual(json.loads((self.folder / "preset.json").read_text())["spheres"], str(self.folder / "few.json"))
        self.render("--settings", "preset.json", "-o", "render.png")
        self.assert_same("view.png", "render.png")
        self.assert_same("back.png", "render.png")
        self.refuse(BOX, "--technique", "proxies", "--spheres", "few.json", says="few.json")

    def test_what_was_moved_is_in_the_preset(self):
        """`gloam render --settings preset.json` alone draws what the viewer shows."""
        self.script([
            {"wait": "idle"}, {"click": [320, 51]}, {"wait": "idle"}, {"drag": [320, 51, 380, 90]}, {"wait": "idle"},
            {"click": [270, 290]}, {"wait": "idle"}, {"key": "g"}, {"wait": 2}, {"stats": "box.json"}, {"key": "g"}, {"wait": 2},
            {"drag": [270, 290, 300, 280]}, {"key": "escape"}, {"wait": "idle"},
            {"stats": "moved.json"}, {"save_preset": "preset.json"}, {"screenshot": "view.png"},
            {"drop": "preset.json"}, {"wait": "idle"}, {"stats": "loaded.json"},
            {"set": {"scene": "builtin:lamp?detail=0.25"}}, {"wait": "idle"}, {"drop": "preset.json"}, {"wait": "idle"},
            {"stats": "back.json"}], BOX, *SMALL, "--no-panel", "--scale", "1")
        preset = json.loads((self.folder / "preset.json").read_text())
        self.assertEqual(preset["scene"], BOX)
        self.assertEqual(len(preset["move"]), self.stats("moved.json")["moves"])
        self.assertGreaterEqual(len(preset["move"]), 1)
        for name in ["loaded", "back"]:
            self.assertEqual(self.stats(f"{name}.json")["moves"], len(preset["move"]))
        self.assertEqual(self.stats("back.json")["scene"], BOX)
        self.render("--settings", "preset.json", "-o", "render.png")
        self.assert_same("view.png", "render.png")
        self.render(BOX, "--size", "640x420", "-o", "still.png")
        self.assertNotEqual(*(png_size_and_rows(self.folder / name)[2] for name in ("still.png", "render.png")))

    def test_orthographic_cameras_survive_presets(self):
        self.script([
            {"wait": "idle"}, {"set": {"ortho": 2.5}}, {"wait": "idle"}, {"save_preset": "preset.json"}, {"screenshot": "view.png"},
            {"set": {"fov": 40}}, {"wait": "idle"}, {"screenshot": "other.png"}, {"drop": "preset.json"}, {"wait": "idle"},
            {"screenshot": "back.png"}], BOX, *SMALL, "--no-panel", "--scale", "1")
        self.assertEqual(json.loads((self.folder / "preset.json").read_text())["ortho"], 2.5)
        self.render("--settings", "preset.json", "-o", "render.png")
        view, other, back = (png_size_and_rows(self.folder / f"{n}.png") for n in ("view", "other", "back"))
        self.assertEqual(view, back)
        self.assertNotEqual(view, other)
        self.assert_same("view.png", "render.png")

    def test_pictures_as_exr_have_all_layers(self):
        self.script([{"wait": "idle"}, {"screenshot": "picture.exr"}, {"wait": "idle"}, {"stats": "end.json"}], BOX, *SMALL,
                    "--scale", "0.5")
        info = subprocess.run([GLOAM, "info", "picture.exr", "--json"], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True, check=True, timeout=60)
        for layer in ["direct", "indirect", "normal", "depth", "albedo", "object"]:
            self.assertIn(layer, info.stdout)
        self.assertTrue(any(said.startswith("saved picture.exr, ") for said in self.stats("end.json")["messages"]))

    def test_what_was_moved_stays_moved_over_a_bake_that_makes_nodes(self):
        """Copies of an instanced node become nodes of their own when they are baked."""
        numbers = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0] + [0, 0, 1] * 4 + [0, 0, 0, 2, 0, 0]
        data = struct.pack("<36f", *numbers[:12], *numbers[12:24], *numbers[24:], *[0] * 6) + struct.pack("<6I", 0, 1, 2, 0, 2, 3)
        vec = lambda at, count: {"bufferView": 0, "byteOffset": 4 * at, "componentType": 5126, "count": count, "type": "VEC3"}
        scene = {
            "asset": {"version": "2.0"}, "extensionsUsed": ["EXT_mesh_gpu_instancing"], "scene": 0, "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"name": "many", "mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 3}}}},
                      {"name": "mover", "mesh": 0, "translation": [0, 2, 0]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
            "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "accessors": [{**vec(0, 4), "min": [0, 0, 0], "max": [1, 1, 0]}, vec(12, 4),
                          {"bufferView": 0, "byteOffset": 144, "componentType": 5125, "count": 6, "type": "SCALAR"}, vec(24, 2)]}
        (self.folder / "copies.gltf").write_text(json.dumps(scene))
        self.script([{"wait": "idle"}, {"stats": "before.json"}, {"set": {"technique": "prt"}}, {"wait": "idle"}, {"stats": "after.json"}],
                    "copies.gltf", *SMALL, "--scale", "0.2", "--move", "mover=0.5,0,0", "--technique", "irradiance")
        before, after = self.stats("before.json"), self.stats("after.json")
        self.assertEqual((before["technique"], before["moves"]), ("irradiance", 1), before["messages"])
        self.assertEqual((after["technique"], after["moves"]), ("prt", 1), after["messages"])
        self.assertGreater(after["nodes"], before["nodes"])

    def test_keys_overwrite_nothing(self):
        keys = [{"key": "f2"}, {"wait": 2}, {"key": "f5"}, {"wait": 2}]
        self.script([{"wait": "idle"}, *keys, {"set": {"exposure": 1}}, {"wait": "idle"}, *keys, {"set": {"exposure": 3}},
                     {"key": "f9"}, {"wait": "idle"}, {"stats": "end.json"}], BOX, *SMALL, "--scale", "0.2")
        for name in ["gloam.png", "gloam_2.png", "preset.json", "preset_2.json"]:
            self.assertTrue((self.folder / name).exists(), name)
        self.assertEqual(self.stats("end.json")["exposure"], 1)

    def test_videos_and_recent_files(self):
        self.script([
            {"wait": "idle"}, {"video": "nowhere/film.mp4"}, {"wait_s": 0.5}, {"video": "turn.mp4"}, {"wait_s": 1}, {"video": False},
            {"wait": "idle"}, {"set": {"scene": "builtin:lamp?detail=0.25"}}, {"wait": "idle"}, {"stats": "end.json"}],
            BOX, "--size", "320x240", "--scale", "0.3", "--no-panel")
        said = "\n".join(self.stats("end.json")["messages"])
        self.assertIn("nowhere", said)
        self.assertRegex(said, r"saved turn\.mp4 \(\d+ frames\)")
        self.assertGreater((self.folder / "turn.mp4").stat().st_size, 500)
        recent = json.loads((self.folder / "config/gloam/recent.json").read_text())
        self.assertEqual(recent[:2], ["builtin:lamp?detail=0.25", BOX])

    # ---- drops, sizes, devices -------------------------------------------------------------------------------------

    def test_drops_sizes_and_lost_devices(self):
        (self.folder / "no.glb").write_bytes(b"not a scene at all")
        (self.folder / "no.json").write_text('{"exposure": "bright"}')
        (self.folder / "no.hdr").write_bytes(b"#?RADIANCE\nFORMAT=nothing\n\n")
        subprocess.run([GLOAM, "scene", "lamp", "-o", "lamp.glb", "--quiet"], cwd=self.folder, env=self.environment,
                       check=True, timeout=60)
        self.script([
            {"wait": "idle"},
            {"drop": "no.glb"}, {"wait": "idle"}, {"drop": "no.json"}, {"drop": "no.hdr"}, {"wait": "idle"},
            {"stats": "bad.json"}, {"drop": "lamp.glb"}, {"wait": "idle"}, {"stats": "good.json"},
            {"resize": [1, 1]}, {"wait": "idle"}, {"resize": [40, 40]}, {"wait": "idle"}, {"resize": [640, 420]}, {"wait": 3},
            {"wait": "idle"}, {"stats": "grown.json"},
            {"resize": [3840, 2160]}, {"set": {"scale": 0.1}}, {"wait": "idle"},
            {"window_screenshot": "large.png"}, {"resize": [640, 420]}, {"wait": "idle"},
            {"minimise": True}, {"wait": 5}, {"restore": True}, {"wait": "idle"},
            {"lose_device": True}, {"wait": 3}, {"wait": "idle"}, {"lose_window": True}, {"wait": 3}, {"wait": "idle"},
            {"window_screenshot": "end.png"}, {"stats": "end.json"}])
        bad = "\n".join(self.stats("bad.json")["messages"])
        for name in ["no.glb", "no.json", "no.hdr"]:
            self.assertIn(name, bad)
        self.assertEqual(self.stats("bad.json")["scene"], BOX)
        self.assertEqual(self.stats("good.json")["scene"], "lamp.glb")
        self.assertEqual(self.stats("grown.json")["scale"], 1.0)  # small windows teach nothing wrong
        data = (self.folder / "large.png").read_bytes()
        self.assertEqual(struct.unpack(">II", data[16:24]), (3840, 2160))
        said = "\n".join(self.stats("end.json")["messages"])
        self.assertIn("the renderer starts anew", said)
        self.assertIn("opened anew", said)
        self.assertGreater(len(set(png_size_and_rows(self.folder / "end.png")[2][200])), 8)  # there is a picture again

    def test_a_probe_and_a_scene_dropped_together_are_both_taken(self):
        (self.folder / "probe.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes([90, 120, 200, 128]) * 8)
        subprocess.run([GLOAM, "scene", "lamp", "-o", "lamp.glb", "--quiet"], cwd=self.folder, env=self.environment,
                       check=True, timeout=60)
        for order in (["probe.hdr", "lamp.glb"], ["lamp.glb", "probe.hdr"]):
            self.script([{"wait": "idle"}, *({"drop": name} for name in order), {"wait": "idle"}, {"stats": "both.json"}])
            both = self.stats("both.json")
            self.assertEqual(both["scene"], "lamp.glb", order)
            self.assertIn("probe", both["environment"], order)

    def test_presets_that_are_none_are_said_in_our_words(self):
        broken = {"comma.json": '{"exposure": 1,\n "fov": }', "cut.json": '{"exposure": 0.5', "empty.json": "", "list.json": "[1, 2]",
                  "flag.json": '{"background": "maybe"}', "node.json": '{"move": ["nowhere=1,2,3"], "exposure": 4}', "huge.json": '{"exposure": 1e999}', "deep.json": "[" * 100000}
        for name, text in broken.items():
            (self.folder / name).write_text(text)
        self.script([{"wait": "idle"}, *({"drop": name} for name in broken), {"wait": "idle"}, {"stats": "said.json"}])
        said = self.stats("said.json")["messages"]
        for name, says in {"comma.json": "line 2, column 9: no JSON from here on", "cut.json": "line 1, column",
                           "empty.json": "is empty", "list.json": "an object of options",
                           "flag.json": "background: 'maybe': expected true or false", "node.json": "--move: no node 'nowhere'", "huge.json": "too large",
                           "deep.json": "nests too deeply"}.items():
            lines = [line for line in said if line.startswith(name)]
            self.assertEqual(len(lines), 1, said)
            self.assertIn(says, lines[0])
            self.assertIn("expected", lines[0])
            self.assertNotIn("exception", lines[0])

    # ---- images by name ----------------------------------------------------------------------------------------------

    def test_images_that_are_not_made_give_way_to_the_light(self):
        self.refuse(BOX, *SMALL, "--show", "nonsense", says="show 'nonsense': irradiance makes no image of that name; expected")
        self.script([
            {"wait": "idle"}, {"set": {"show": "nonsense"}}, {"wait": "idle"}, {"stats": "unknown.json"},
            {"set": {"technique": "splatting", "show": "splatting.irradiance"}}, {"wait": "idle"}, {"stats": "known.json"},
            {"set": {"technique": "irradiance"}}, {"wait": "idle"}, {"stats": "switched.json"},
            {"screenshot": "light.png"}, {"set": {"show": "frame.depth"}}, {"wait": "idle"},
            {"screenshot": "frame.depth.png"}, {"set": {"show": "depth"}}, {"wait": "idle"}, {"screenshot": "depth.png"},
            {"set": {"technique": "splatting"}}, {"wait": "idle"}, {"stats": "layer.json"}], BOX, *SMALL, "--technique", "irradiance", "--scale", "0.2")
        unknown, known, switched, layer = (self.stats(f"{n}.json") for n in ("unknown", "known", "switched", "layer"))
        line = "show '{}': irradiance makes no image of that name; its light is shown"
        self.assertIn(line.format("nonsense"), unknown["messages"])
        self.assertEqual(unknown["show"], "")
        self.assertEqual(known["show"], "splatting.irradiance")
        self.assertIn(line.format("splatting.irradiance"), switched["messages"])
        self.assertEqual(switched["show"], "")
        for name in ["depth", "frame.depth"]:  # small numbers are raised until they are seen
            self.assertGreater(max(png_size_and_rows(self.folder / f"{name}.png")[2][40]), 90, name)
        self.assertEqual(layer["show"], "depth")  # every technique has the frame's layers
        self.assertTrue((self.folder / "light.png").exists())

    # ---- panels ------------------------------------------------------------------------------------------------------

    def test_wide_sliders_are_fine_at_small_values(self):
        window = [BOX, "--size", "1100x800", "--scale", "0.1", "--technique", "splatting"]
        self.script([{"wait": "idle"}, {"wait": 5}, {"stats": "where.json"}], *window)
        x, y, width, height = self.stats("where.json")["controls"]["splatting.vpls"]
        y += height / 2
        self.script([
            {"wait": "idle"}, {"drag": [x + 5, y, x + width / 2, y]}, {"wait": "idle"}, {"stats": "middle.json"},
            {"drag": [x + width / 2, y, x + width - 1, y]}, {"wait": 3}, {"stats": "most.json"},
            {"drag": [x + width / 2, y, x + 1, y]}, {"wait": "idle"}, {"stats": "least.json"}], *window)
        middle, most, least = (self.stats(f"{n}.json")["settings"]["vpls"] for n in ("middle", "most", "least"))
        self.assertTrue(20 <= middle <= 2000, middle)  # of 0 to 100000
        self.assertEqual(most, 100000)
        self.assertEqual(least, 0)

    def test_what_plays_is_at_hand_in_narrow_windows(self):
        for size in ([200, 320], [320, 110]):
            arguments = ["builtin:walker?detail=0.25", "--size", f"{size[0]}x{size[1]}", "--scale", "0.2"]
            self.script([{"wait": "idle"}, {"wait": 5}, {"stats": "still.json"}], *arguments)
            x, y, width, height = self.stats("still.json")["controls"]["play"]
            self.assertTrue(0 <= x and x + width <= size[0] and 0 <= y and y + height <= size[1], (x, y, width, height))
            self.script([{"wait": "idle"}, {"click": [x + width / 2, y + height / 2]}, {"wait_s": 0.5}, {"stats": "plays.json"}],
                        *arguments)
            self.assertGreater(self.stats("plays.json")["time_s"], 0.0)

    def test_scenes_without_cameras_are_framed_by_the_window(self):
        (self.folder / "wall.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n")
        distances = []
        for size in ("900x500", "300x500"):
            self.script([{"wait": "idle"}, {"stats": "stats.json"}], "wall.obj", "--size", size, "--scale", "0.2")
            distances.append(math.hypot(*self.stats("stats.json")["camera"]["eye"]))  # the middle is at 0
        self.assertGreater(distances[1], 1.2 * distances[0])

    def test_lights_are_seen_before_anything_is_selected(self):
        window = [BOX, "--size", "900x600", "--scale", "0.2"]
        self.script([{"wait": "idle"}, {"wait": 5}, {"stats": "still.json"}, {"window_screenshot": "still.png"}], *window)
        still = self.stats("still.json")
        self.assertEqual(still["selected"], -1)
        (x, y), = still["light_marks"]
        _, _, rows = png_size_and_rows(self.folder / "still.png")
        around = [rows[round(y)][3 * (round(x) + dx)] for dx in (0, 6)]  # the dot, and the dark rim round it
        self.assertGreater(around[0], around[1] + 40, around)
        self.script([{"wait": "idle"}, {"click": [x, y]}, {"wait": "idle"}, {"stats": "clicked.json"}], *window)
        self.assertGreaterEqual(self.stats("clicked.json")["selected"], 0)

    def test_times_are_copied_as_json(self):
        window = [BOX, "--size", "1100x900", "--scale", "0.1"]
        self.script([{"wait": "idle"}, {"wait": 5}, {"stats": "closed.json"}], *window)
        x, y, _, _ = self.stats("closed.json")["controls"]["times"]
        unfold = [{"wait": "idle"}, {"click": [x + 30, y + 8]}, {"mouse": [x + 30, y - 40]}, {"scroll": -100}, {"wait": 5}]
        self.script([*unfold, {"stats": "open.json"}], *window)
        x, y, width, height = self.stats("open.json")["controls"]["copy_times"]
        self.script([*unfold, {"click": [x + width / 2, y + height / 2]}, {"wait": 3}, {"clipboard": "copied.json"},
                     {"stats": "stats.json"}], *window)
        copied, stats = self.stats("copied.json"), self.stats("stats.json")
        for key in ["device", "technique", "scene", "size", "memory_bytes"]:
            self.assertEqual(copied[key], stats[key], key)
        self.assertGreater(copied["frame_ms"], 0.0)
        self.assertEqual([p["name"] for p in copied["passes"]], [p["name"] for p in stats["passes"]])
        self.assertIn("times are on the clipboard", stats["messages"])

    def test_escape_closes_a_list_and_nothing_else(self):
        window = [BOX, "--size", "1100x700", "--scale", "0.1"]
        self.script([{"wait": "idle"}, {"wait": 5}, {"stats": "closed.json"}], *window)
        x, y, width, height = self.stats("closed.json")["controls"]["technique"]
        middle = [x + width / 2, y + height / 2]
        seen = [{"mouse": [20, 690]}, {"wait": 12}, {"wait": "idle"}]
        self.script([{"wait": "idle"}, {"click": [270, 450]}, {"wait": "idle"}, *seen, {"window_screenshot": "before.png"}, {"stats": "before.json"},
                     {"click": middle}, *seen, {"window_screenshot": "open.png"}, {"key": "escape"}, *seen, {"window_screenshot": "after.png"},
                     {"stats": "after.json"}], *window)
        left = int(x)
        panel = {n: [row[3 * left:3 * int(x + width)] for row in png_size_and_rows(self.folder / f"{n}.png")[2][int(y) + 40:int(y) + 160]]
                 for n in ("before", "open", "after")}
        self.assertNotEqual(panel["before"], panel["open"])
        self.assertEqual(panel["before"], panel["after"])
        self.assertEqual(self.stats("before.json")["selected"], self.stats("after.json")["selected"])

    def test_frame_times_are_plotted(self):
        """A line as wide as the panel, over its field."""
        window = [BOX, "--size", "1100x900", "--scale", "0.1"]
        self.script([{"wait": "idle"}, {"wait": 5}, {"stats": "closed.json"}], *window)
        x, y, _, _ = self.stats("closed.json")["controls"]["times"]
        turn = [{"set": {"env_rotation": 10}}, {"wait": 3}, {"set": {"env_rotation": 20}}, {"wait": 3}]
        self.script([{"wait": "idle"}, {"repeat": 4, "steps": turn}, {"click": [x + 30, y + 8]}, {"mouse": [x + 30, y - 40]},
                     {"scroll": -100}, {"wait": 5}, {"stats": "open.json"}, {"window_screenshot": "open.png"}], *window)
        x, y, width, height = (int(v) for v in self.stats("open.json")["controls"]["frame_plot"])
        _, _, rows = png_size_and_rows(self.folder / "open.png")
        columns = range(max(x, 740), 1090)  # of the panel
        top = int(self.stats("open.json")["controls"]["copy_times"][1])
        blue = [sum(rows[j][3 * i + 2] > rows[j][3 * i] + 40 for j in range(top - 420, top)) for i in columns]
        self.assertGreater(sum(count > 0 for count in blue), 250)

    def test_scripts_do_not_wait_for_what_never_comes(self):
        (self.folder / "steps.json").write_text(json.dumps([
            {"wait": "idle"}, {"mouse": [200, 200]}, {"press": "left"}, {"wait": 2}, {"mouse": [230, 200]}, {"wait": "idle"},
            {"release": "left"}, {"wait": "idle"}, {"key": "space"}, {"wait": 3}, {"wait": "idle"}]))
        self.refuse("builtin:walker?detail=0.25", *SMALL, "--scale", "0.2", "--script", "steps.json",
                    says="steps[10]: nothing stands still while the animation plays")

    # ---- switching ---------------------------------------------------------------------------------------------------

    def test_switching_leaks_nothing(self):
        switches = [{"set": {"technique": "proxies"}}, {"wait": 2}, {"set": {"technique": "irradiance"}}, {"wait": 2}]
        self.script([
            {"wait": "idle"}, {"set": {"technique": "proxies"}}, {"wait": "idle"}, {"set": {"technique": "irradiance"}},
            {"wait": "idle"}, {"repeat": 4, "steps": switches}, {"wait": "idle"}, {"stats": "before.json"},
            {"repeat": 25, "steps": switches}, {"wait": "idle"}, {"stats": "after.json"},
            {"set": {"split": "technique", "right": "proxies", "divider": 0.3}}, {"wait": "idle"}, {"screenshot": "split.png"}],
            "builtin:balls?detail=0.25", "--size", "520x360", "--scale", "0.25", "--proxies.spheres", "5")
        self.assertTrue((self.folder / "split.png").exists())
        before, after = self.stats("before.json"), self.stats("after.json")
        self.assertGreater(after["pictures"], before["pictures"] + 20)
        self.assertEqual(before["ui_objects"], after["ui_objects"])
        self.assertLess(after["memory_bytes"], before["memory_bytes"] * 1.01)  # small buffers follow the moving parts
        names = [{m["name"].removesuffix(".odd").removesuffix(".even") for m in stats["memory"]} for stats in (before, after)]
        self.assertEqual(names[0], names[1])
        self.assertLessEqual(after["input_to_picture"], 2)

    def test_pictures_leave_no_memory_behind(self):
        self.environment["GLOAM_VALIDATION"] = "0"  # the layer keeps books of its own
        turn = [{"set": {"env_rotation": 10}}, {"wait": 2}, {"set": {"env_rotation": 20}}, {"wait": 2}]
        self.script([{"wait": "idle"}, {"repeat": 15, "steps": turn}, {"wait": "idle"}, {"stats": "before.json"},
                     {"repeat": 40, "steps": turn}, {"wait": "idle"}, {"stats": "after.json"}],
                    BOX, "--size", "320x240", "--scale", "0.2")
        before, after = self.stats("before.json"), self.stats("after.json")
        self.assertGreater(after["pictures"], before["pictures"] + 50)
        self.assertLess(after["resident_bytes"] - before["resident_bytes"], 3 << 20)

    # ---- handles ---------------------------------------------------------------------------------------------------------

    def test_handles_move_a_lamp_and_a_box(self):
        self.script([
            {"wait": "idle"}, {"screenshot": "before.png"},
            {"click": [320, 51]}, {"wait": "idle"}, {"drag": [380, 51, 420, 51]}, {"wait": "idle"}, {"stats": "lamp.json"},
            {"screenshot": "lamp.png"},
            {"click": [270, 290]}, {"wait": "idle"}, {"stats": "box.json"}, {"key": "escape"}, {"wait": 2},
            {"drag": [600, 300, 560, 300]}, {"wait": "idle"}, {"stats": "camera.json"}],
            BOX, *SMALL, "--no-panel", "--scale", "0.3")
        lamp, box, camera = self.stats("lamp.json"), self.stats("box.json"), self.stats("camera.json")
        self.assertEqual(lamp["moves"], 1)
        self.assertEqual(camera["moves"], 1)  # a drag beside the handles turns the camera
        self.assertNotEqual(camera["camera"], box["camera"])
        self.assertEqual(box["camera"], lamp["camera"])
        self.assertNotEqual(box["selected"], lamp["selected"])
        self.assertGreaterEqual(box["selected"], 0)
        self.assertNotEqual(png_size_and_rows(self.folder / "before.png"), png_size_and_rows(self.folder / "lamp.png"))

    def test_a_dot_moves_in_the_plane_of_the_view_and_escape_puts_back(self):
        hold = [{"mouse": [320, 51]}, {"press": "left"}, {"wait": 2}, {"mouse": [360, 90]}, {"wait": "idle"}]
        self.script([
            {"wait": "idle"}, {"click": [320, 51]}, {"wait": "idle"}, {"screenshot": "before.png"},
            *hold, {"stats": "held.json"}, {"key": "escape"}, {"wait": "idle"}, {"stats": "back.json"},
            {"mouse": [400, 200]}, {"wait": "idle"}, {"release": "left"}, {"wait": "idle"}, {"stats": "after.json"},
            {"screenshot": "after.png"}, *hold, {"release": "left"}, {"wait": "idle"}, {"stats": "moved.json"}],
            BOX, *SMALL, "--scale", "0.3", "--no-panel")
        held, back, after, moved = (self.stats(f"{n}.json") for n in ("held", "back", "after", "moved"))
        self.assertEqual((held["moves"], back["moves"], after["moves"], moved["moves"]), (1, 0, 0, 1))
        for stats in (held, moved):
            (x, y), = stats["light_marks"]
            self.assertAlmostEqual(x, 360, delta=1.0)
            self.assertAlmostEqual(y, 90, delta=1.0)
        self.assertEqual(after["camera"], held["camera"])  # a handle let go is not the camera's
        self.assertGreaterEqual(after["selected"], 0)
        self.assertEqual(png_size_and_rows(self.folder / "before.png"), png_size_and_rows(self.folder / "after.png"))

    def test_what_is_selected_has_a_line_round_it(self):
        self.script([
            {"wait": "idle"}, {"wait": 3}, {"window_screenshot": "before.png"}, {"screenshot": "picture.png"},
            {"click": [270, 290]}, {"wait": "idle"}, {"mouse": [5, 5]}, {"wait": 3}, {"window_screenshot": "selected.png"},
            {"screenshot": "again.png"}, {"key": "escape"}, {"wait": "idle"}, {"wait": 3}, {"window_screenshot": "none.png"}],
            BOX, *SMALL, "--scale", "0.5", "--no-panel")
        line = lambda name: sum(row[i] > 230 and 190 < row[i + 1] < 235 and row[i + 2] < 130
                                for row in png_size_and_rows(self.folder / name)[2] for i in range(0, len(row), 3))
        self.assertLess(line("before.png"), 40)
        self.assertGreater(line("selected.png"), 300)
        self.assertLess(line("none.png"), 40)
        self.assertEqual(png_size_and_rows(self.folder / "picture.png"), png_size_and_rows(self.folder / "again.png"))

    def test_an_input_is_shown_within_two_pictures(self):
        """Whatever moves: pictures are counted from an input to the first one that shows it."""
        turn = [{"drag": [100 + 20 * i, 200, 120 + 20 * i, 190]} for i in range(6)]
        moves = {"camera": turn, "light": [{"key": "."}] * 12, "exposure": [{"key": "]"}] * 12,
                 "animation": [{"key": "space"}, *turn, {"key": "space"}],
                 "techniques": [{"key": "1"}, {"wait": 2}, {"key": "5"}, {"wait": 2}] * 6}
        steps = [{"wait": "idle"}, {"stats": "start.json"}]
        for name, move in moves.items():
            steps += [*move, {"wait": "idle"}, {"stats": f"{name}.json"}]
        self.script(steps, "builtin:walker?detail=0.25", *SMALL, "--scale", "0.25", "--technique", "irradiance")
        drawn = self.stats("start.json")["pictures"]
        for name in moves:
            after = self.stats(f"{name}.json")
            self.assertGreater(after["pictures"], drawn + 1, name)
            self.assertIn(after["input_to_picture"], (1, 2), name)
            drawn = after["pictures"]

    # ---- comparison ------------------------------------------------------------------------------------------------------

    def test_reference_refines_and_measures(self):
        self.script([
            {"wait": "idle"}, {"set": {"reference_samples": 4, "split": "reference"}}, {"wait": 2}, {"stats": "early.json"},
            {"wait": "reference"}, {"key": "i"}, {"mouse": [500, 200]}, {"wait": "idle"}, {"wait": 3}, {"stats": "reference.json"}, {"key": "i"}, {"set": {"exposure": 2}}, {"key": "i"}, {"wait": "idle"}, {"set": {"show": "normal"}},
            {"wait": "idle"}, {"set": {"show": "", "irradiance.order": 2}}, {"wait": "idle"}, {"wait_s": 0.5},
            {"stats": "same.json"}, {"set": {"env_rotation": 30}}, {"wait": 2}, {"stats": "dropped.json"},
            {"set": {"split": "none", "show": "normal"}}, {"wait": "idle"},
            {"screenshot": "normal.png"}], BOX, *SMALL, "--scale", "0.2", "--technique", "irradiance", "--no-panel")
        self.assertTrue(self.stats("early.json")["right_tag"].startswith("irradiance: "))  # what that half shows until then
        self.assertTrue(self.stats("reference.json")["right_tag"].startswith("reference, "))
        inspected = self.stats("reference.json")["inspected"]
        self.assertEqual(inspected[""], ["irradiance", "reference", "difference"])
        left, right, difference = ([float(v) for v in cell.split()] for cell in inspected["radiance"])
        for a, b, d in zip(left, right, difference):
            self.assertAlmostEqual(b - a, d, delta=0.01 * (abs(a) + abs(b)))
        self.assertEqual(inspected["object"][0], inspected["object"][1])
        reference, same = (self.stats(f"{n}.json")["reference"] for n in ("reference", "same"))
        self.assertGreaterEqual(reference["samples"], 4)
        self.assertGreater(reference["relative_rmse"], 0.0)
        for key in ["samples", "seconds", "noise"]:  # exposure, inspector, what is shown and options: the same samples
            self.assertEqual(reference[key], same[key], key)
        self.assertNotEqual(reference["relative_rmse"], same["relative_rmse"])  # measured against the new picture
        self.assertNotIn("reference", self.stats("dropped.json"))  # the light has turned
        self.assertTrue((self.folder / "normal.png").exists())

    def test_errors_and_noise_are_those_of_surfaces(self):
        """Much sky is in view, the same in both: it must not make the error look smaller than the noise that is in it."""
        self.script([{"wait": "idle"}, {"set": {"reference_samples": 4, "split": "reference"}}, {"wait": "reference"}, {"stats": "after.json"}],
                    "builtin:balls?detail=0.25", "--env", "sky:noon", "--size", "160x120", "--scale", "1", "--technique", "irradiance",
                    "--eye", "0,2,12", "--target", "0,3,0", "--no-panel")
        reference = self.stats("after.json")["reference"]
        self.assertGreater(reference["noise"], 0.01)
        self.assertGreater(reference["relative_rmse"], 0.7 * reference["noise"])

    # ---- shaders ---------------------------------------------------------------------------------------------------------

    def test_shaders_are_followed_while_they_are_edited(self):
        for file in SOURCES.rglob("*"):
            if file.suffix in (".glsl", ".h"):
                copy = self.folder / "src" / file.relative_to(SOURCES)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, copy)
        shader = self.folder / "src/frame/frame_shade.comp.glsl"
        right = shader.read_text()
        last = right.rindex("}")

        def edit():
            for seen, text in [("first.png", right[:last] + "broken }"), ("second.png", right[:last] + RED + "}")]:
                while not (self.folder / seen).exists():
                    time.sleep(0.05)
                time.sleep(0.3)
                shader.write_text(text)

        editor = threading.Thread(target=edit, daemon=True)
        editor.start()
        pause = [{"wait_s": 3}, {"wait": "idle"}]
        self.script([{"wait": "idle"}, {"wait_s": 1}, {"screenshot": "first.png"}, *pause, {"screenshot": "second.png"},
                     *pause, {"screenshot": "third.png"}, {"stats": "stats.json"}],
                    BOX, *SMALL, "--scale", "0.2", "--watch-shaders", "src")
        editor.join(5)
        first, second, third = (png_size_and_rows(self.folder / f"{n}.png") for n in ("first", "second", "third"))
        self.assertEqual(first, second)
        self.assertNotEqual(second, third)
        said = "\n".join(self.stats("stats.json")["messages"])
        self.assertIn("frame/frame_shade.comp.glsl: compiled", said)
        self.assertRegex(said, r"frame_shade\.comp\.glsl:\d+: error")
        self.refuse(BOX, "--watch-shaders", "nowhere", says="nowhere: expected the src folder")

    # ---- a person's hand ---------------------------------------------------------------------------------------------

    def xdotool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, capture_output=True, text=True,
                              check=True, timeout=30).stdout.strip()

    def test_mouse_and_keys(self):
        process = subprocess.Popen([VIEW, BOX, *SMALL, "--stats", "stats.json"], cwd=self.folder, env=self.environment,
                                   stderr=subprocess.PIPE, text=True)
        try:
            window = self.xdotool("search", "--sync", "--name", "gloam-view").splitlines()[0]
            time.sleep(1.0)
            self.xdotool("windowfocus", window)
            self.xdotool("windowmove", window, 0, 0)
            self.xdotool("mousemove", 120, 150, "mousedown", 1)
            for x in range(130, 200, 10):
                self.xdotool("mousemove", x, 150)
                time.sleep(0.03)
            self.xdotool("mouseup", 1)
            for key in ["Tab", "bracketright", "bracketright", "period"]:
                self.xdotool("key", key)
                time.sleep(0.15)
            time.sleep(0.5)
            self.xdotool("key", "ctrl+q")
            _, problems = process.communicate(timeout=60)
        finally:
            process.kill()
        self.assertEqual(process.returncode, 0, problems)
        stats = self.stats("stats.json")
        self.assertFalse(stats["panel"])
        self.assertAlmostEqual(stats["exposure"], 0.5, places=5)
        self.assertAlmostEqual(stats["env_rotation"], 5.0, places=4)
        eye, target = stats["camera"]["eye"], stats["camera"]["target"]
        self.assertGreater(abs(eye[0] - target[0]), 0.05)  # the room's camera looks straight along z


if __name__ == "__main__":
    for tool in ["Xvfb", "xdotool"]:
        if shutil.which(tool) is None:
            print(f"skipped: {tool} is not installed")
            sys.exit(77)
    unittest.main(verbosity=1)
