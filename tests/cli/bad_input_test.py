# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Bad input: one clear line each, exit code 2, nothing half-written."""
import os
import struct
import unittest

from harness import BOX, SMALL, CliTest, glb, hdr, spinning_triangle, triangle


def broken_scenes():
    """Name of a file -> (its bytes, words that the error must hold)."""
    good = spinning_triangle()
    scenes = {
        "empty.glb": (b"", []),
        "truncated.glb": (good[:200], []),
        "cut_in_data.glb": (good[:-20], []),
        "magic.glb": (b"XXXX" + good[4:], []),
        "claims_4_gib.glb": (good[:8] + struct.pack("<I", 0xFFFFFFFF) + good[12:], []),
        "chunk_4_gib.glb": (good[:12] + struct.pack("<I", 0xFFFFFFF0) + good[16:], []),
        "text.gltf": (b"not json at all", []),
        "array.gltf": (b"[]", []),
    }

    def edited(name, edit, words=(), **keywords):
        document, binary = triangle(**keywords)
        edit(document)
        scenes[name] = (glb(document, binary), words)

    edited("index.glb", lambda d: None, ["99"], indices=(0, 1, 99))
    edited("nan.glb", lambda d: None, positions=[(0, 0, float("nan")), (1, 0, 0), (0, 1, 0)])
    edited("inf.glb", lambda d: None, positions=[(0, 0, float("inf")), (1, 0, 0), (0, 1, 0)])
    edited("past_buffer.glb", lambda d: d["accessors"][0].update(count=1000), ["accessors[0]"])
    edited("view_past_buffer.glb", lambda d: d["bufferViews"][0].update(byteLength=100000), ["bufferView"])
    edited("count_4_gib.glb", lambda d: d["accessors"][0].update(count=4294967295), ["accessors[0]"])
    edited("cycle.glb", lambda d: d.update(nodes=[{"children": [1]}, {"children": [0], "mesh": 0}]), ["node"])
    edited("mesh_index.glb", lambda d: d["nodes"][0].update(mesh=7), ["mesh"])
    edited("nothing.glb", lambda d: d.update(nodes=[{}], meshes=[]), ["triangle"])
    edited("extension.glb", lambda d: d.update(extensionsRequired=["XYZ_unheard_of"], extensionsUsed=["XYZ_unheard_of"]),
           ["XYZ_unheard_of"])
    return scenes


class Scenes(CliTest):
    def test_each_broken_scene_gets_one_line(self):
        for name, (data, words) in broken_scenes().items():
            with self.subTest(name):
                self.path(name).write_bytes(data)
                self.refuse("info", name, says=[name, *words]) if name != "nothing.glb" else None
                self.refuse("render", name, *SMALL, "-o", "a.png", says=[name, *words])
                self.refuse("bake", name, "-o", "a.glb", says=[name, *words])

    def test_missing_and_unreadable(self):
        self.refuse("render", "none.glb", says="none.glb")
        self.path("folder").mkdir()
        self.refuse("render", "folder", says="folder")
        self.path("a.xyz").write_bytes(b"hello")
        self.refuse("render", "a.xyz", says=["a.xyz", ".gltf"])
        self.refuse("info", "none.exr", says="none.exr")

    def test_empty_names(self):
        for verb in "render", "bake", "scene":
            self.refuse(verb, "", says=["SCENE", "the name is empty"])
        self.refuse("info", "", says=["FILE", "the name is empty"])

    def test_mesh_files_that_claim_what_they_do_not_hold(self):
        self.path("a.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
        self.path("a.ply").write_text("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                                      "property float y\nproperty float z\nend_header\n")
        for name, words in ("a.off", ["face 0", "vertex 7"]), ("a.ply", ["4000000000", "bytes"]):
            line = self.refuse("info", name)
            if "without assimp" not in line:
                for word in [name, *words]:
                    self.assertIn(word, line)

    def test_no_normals_and_zero_area_are_drawn(self):
        document, binary = triangle([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0)], (0, 1, 2, 1, 1, 3))
        self.path("a.glb").write_bytes(glb(document, binary))
        self.succeed("render", "a.glb", *SMALL, "-o", "a.png")


class Lights(CliTest):
    def refuse_light(self, name, data, says=()):
        self.path(name).write_bytes(data)
        self.refuse("render", BOX, *SMALL, "--env", name, "-o", "a.png", says=[name, *says])

    def test_broken_pictures(self):
        self.refuse_light("empty.hdr", b"")
        self.refuse_light("short.hdr", hdr(64, 32)[:100])
        self.refuse_light("huge.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n")
        run_past_end = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n" + bytes([2, 2, 0, 8, 255, 1, 1])
        self.refuse_light("runs.hdr", run_past_end)
        self.refuse_light("text.exr", b"no picture")
        self.refuse_light("magic.exr", b"\x76\x2f\x31\x01" + b"\0" * 40)

    def test_exr_without_the_channels_of_light(self):
        self.succeed("render", BOX, *SMALL, "-o", "a.exr")
        self.succeed("render", BOX, *SMALL, "-o", "n.exr", "--show", "normal")
        data = self.path("a.exr").read_bytes()
        # The header's plain G becomes a channel of another name.
        broken = data.replace(b"\0G\0", b"\0Q\0", 1)
        self.assertNotEqual(data, broken)
        self.refuse_light("broken.exr", broken)

    def test_unknown_sky(self):
        self.refuse("render", BOX, "--env", "sky:no-such", says=["no-such", "mild"])
        self.refuse("render", BOX, "--env", "none.exr", says="none.exr")
        self.refuse("render", BOX, "--env", "", says=["--env", "empty"])


class Numbers(CliTest):
    def test_render(self):
        for option, values in {
                "--size": ["0", "0x10", "10x0", "100000", "100000x100000", "-1", "1x1x1", "axb", "", "nan", "1e3"],
                "--supersample": ["0", "5", "x", "1.5"],
                "--fps": ["0", "-1", "nan", "inf"],
                "--fov": ["0", "180", "nan", "-10"],
                "--time": ["-1", "nan", "x"],
                "--orbit": ["0", "-1", "1000000"],
                "--animate": ["1", "1:1", "2:1", "0:inf", "a:b", "-1:2", ":"],
                "--exposure": ["nan", "x", "1000"],
                "--env-intensity": ["-1", "nan", "inf"],
                "--env-rotation": ["nan", "x"],
                "--eye": ["1,2", "1,2,3,4", "a,b,c", "nan,0,0", ""],
                "--tone-map": ["filmic", ""],
                "--technique": ["no-such", ""],
                "--device": ["no-such-device", "99"],
        }.items():
            for value in values:
                with self.subTest(option=option, value=value):
                    self.refuse("render", BOX, *SMALL, "-o", "a.png", f"{option}={value}",
                                says=[value] if option == "--device" else [option, value])

    def test_too_many_frames(self):
        self.refuse("render", BOX, "--animate", "0:100000", "-o", "frames", says="frames")

    def test_technique_options(self):
        for technique in self.succeed_json("list", "--techniques")["techniques"]:
            for option in technique["options"]:
                flag = f"--{technique['name']}.{option['name']}"
                self.refuse("render", BOX, f"{flag}=certainly-not", "-o", "a.png", says=[flag, "certainly-not"])

    def test_bench(self):
        self.refuse("bench", "irradiance", "--frames", "0", says="--frames")


class Outputs(CliTest):
    def test_unknown_extension_lists_the_known(self):
        self.refuse("render", BOX, "-o", "a.jpg", says=[".jpg", ".png", ".mp4"])
        self.refuse("render", BOX, "-o", "", says="--output")
        self.path("plain").write_bytes(b"a file")
        self.refuse("render", BOX, "-o", "plain", says=["plain", "no folder", ".png"])
        if os.path.exists("/dev/full"):
            self.refuse("render", BOX, "-o", "/dev/full", says=["/dev/full", "no folder"])

    def test_found_before_any_work(self):
        self.refuse("render", "/nowhere.glb", "-o", "no/such/a.png", says="no/such")
        self.refuse("render", "/nowhere.glb", "-o", "no/such/frames", says="no/such")
        self.refuse("render", "/nowhere.glb", "-o", "no/such/a.mp4", says="no/such")
        self.path("file").write_bytes(b"")
        self.refuse("render", BOX, "--orbit", "2", "-o", "file/frames", says="file")

    def test_an_input_is_not_overwritten(self):
        self.path("probe.hdr").write_bytes(hdr())
        self.refuse("render", BOX, "--env", "probe.hdr", "-o", "probe.hdr", says="probe.hdr")
        document, binary = triangle()
        data = glb(document, binary)
        self.path("a.glb").write_bytes(data)
        for verb in "bake", "scene":
            self.refuse(verb, "a.glb", "-o", "a.glb", says=["a.glb", "destroy the input"])
            self.refuse(verb, "a.glb", "-o", "./a.glb", says="destroy the input")
        self.assertEqual(self.path("a.glb").read_bytes(), data)

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_no_permission(self):
        self.path("locked").mkdir(mode=0o500)
        self.refuse("render", BOX, "-o", "locked/a.png", says="locked/a.png")

    def test_no_space(self):
        if os.path.exists("/dev/full"):
            self.refuse("scene", "cornell", "-o", "/dev/full.glb/x.glb", says="x.glb")


if __name__ == "__main__":
    unittest.main()
