# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam diff: measures, masks, layers, pictures, bounds; pictures that cannot be compared."""
import json
import math
import struct
import unittest
import zlib

from harness import SMALL, CliTest

MEASURES = ["rmse", "relative_rmse", "relative_squared_error", "psnr", "ssim", "flip", "ldr_flip", "mean_signed_error",
            "relative_signed_error", "max_difference"]

GREY = 0.2140  # half of the signal, as linear light


def exr(width, height, channels):
    """An OpenEXR file of uncompressed channels: name -> a number, or a list of one number a pixel; "id" is UINT."""
    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(data)) + data
    names = sorted(channels)
    kinds = {name: 0 if name.endswith(".id") else 2 for name in names}
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", kinds[name], 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2)
    header += attribute("channels", "chlist", listed) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"

    def row(name, y):
        values = channels[name]
        values = values[y * width:(y + 1) * width] if isinstance(values, list) else [values] * width
        return struct.pack(f"<{width}{'I' if kinds[name] == 0 else 'f'}", *values)
    line = 8 + 4 * width * len(names)
    table = b"".join(struct.pack("<Q", len(header) + 8 * height + y * line) for y in range(height))
    rows = b"".join(struct.pack("<ii", y, line - 8) + b"".join(row(name, y) for name in names) for y in range(height))
    return header + table + rows


def rgb(r, g=None, b=None, layer=""):
    g, b = r if g is None else g, r if b is None else b
    return {layer + "R": r, layer + "G": g, layer + "B": b}


def png(width, height, pixels, kind=2):
    """kind 0: grey, 2: colour; `pixels` are bytes in rows."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    stride = len(pixels) // height
    rows = b"".join(b"\0" + pixels[y * stride:(y + 1) * stride] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class DiffTest(CliTest):
    def write(self, name, data):
        self.path(name).write_bytes(data)
        return name

    def pair(self):
        """a.exr is b.exr and a half in its left part."""
        self.write("b.exr", exr(8, 4, {**rgb(2.0), **rgb(0.5, layer="direct."), "object.id": [1, 1, 0, 0, 0, 0, 0, 0] * 4}))
        left = [2.5 if x < 4 else 2.0 for _ in range(4) for x in range(8)]
        self.write("a.exr", exr(8, 4, {**rgb(left), **rgb(0.25, layer="direct."), "object.id": 1}))


class Measures(DiffTest):
    def test_numbers_by_hand(self):
        self.pair()
        result = self.succeed_json("diff", "a.exr", "b.exr")
        self.assertEqual(set(MEASURES) - set(result), set())
        self.assertEqual(result["pixels"], 32)
        self.assertEqual(result["size"], "8x4")
        self.assertAlmostEqual(result["rmse"], math.sqrt(0.125))
        self.assertAlmostEqual(result["relative_squared_error"], 0.125 / 4)
        self.assertAlmostEqual(result["relative_rmse"], math.sqrt(0.125 / 4))
        self.assertAlmostEqual(result["psnr"], 10 * math.log10(4 / 0.125))
        self.assertAlmostEqual(result["mean_signed_error"], 0.25)
        self.assertAlmostEqual(result["relative_signed_error"], 0.125)
        self.assertAlmostEqual(result["max_difference"], 0.5)
        self.assertTrue(0 < result["ssim"] < 1 and 0 < result["flip"] < 1 and 0 < result["ldr_flip"] < 1)
        self.assertEqual((result["exceeded"], result["outputs"]), ([], []))

    def test_equal_pictures_and_one_file_twice(self):
        self.pair()
        result = self.succeed_json("diff", "a.exr", "a.exr")
        self.assertIsNone(result["psnr"], "infinite")
        self.assertEqual([result[key] for key in ("rmse", "flip", "ldr_flip", "mean_signed_error")], [0, 0, 0, 0])
        self.assertAlmostEqual(result["ssim"], 1)
        self.succeed("diff", "a.exr", "a.exr", "--min-psnr", "1000", "--max-flip", "0")

    def test_table_for_people(self):
        self.pair()
        lines = self.succeed("diff", "a.exr", "b.exr").out.splitlines()
        self.assertEqual(lines[0], "a.exr against b.exr, 8x4")
        self.assertEqual(len(lines), 1 + len(MEASURES))
        self.assertRegex(lines[3], r"^  relative squared error +0\.03125 ")

    def test_layers(self):
        self.pair()
        result = self.succeed_json("diff", "a.exr", "b.exr", "--layer", "direct")
        self.assertAlmostEqual(result["mean_signed_error"], -0.25)
        self.assertEqual(result["layer"], "direct")
        self.refuse("diff", "a.exr", "b.exr", "--layer", "indirect", says=["a.exr", "indirect", "has direct"])
        self.refuse("diff", "a.exr", "b.exr", "--layer", "object", says=["a.exr", "object"])
        self.write("c.png", png(8, 4, bytes(96)))
        self.refuse("diff", "c.png", "b.exr", "--layer", "direct", says=["c.png", "OpenEXR"])

    def test_masks(self):
        self.pair()
        self.write("left.png", png(8, 4, (b"\x01" * 4 + b"\0" * 4) * 4, kind=0))
        result = self.succeed_json("diff", "a.exr", "b.exr", "--mask", "left.png")
        self.assertEqual(result["pixels"], 16)
        self.assertAlmostEqual(result["mean_signed_error"], 0.5)
        self.assertIn("16 of 32 pixels", self.succeed("diff", "a.exr", "b.exr", "--mask", "left.png").out)
        # The reference's objects, not the picture's.
        self.assertEqual(self.succeed_json("diff", "a.exr", "b.exr", "--foreground")["pixels"], 8)
        self.write("right.png", png(8, 4, (b"\0" * 1 + b"\xff" * 7) * 4, kind=0))
        both = self.succeed_json("diff", "a.exr", "b.exr", "--foreground", "--mask", "right.png")
        self.assertEqual(both["pixels"], 4)

    def test_foreground_by_alpha(self):
        self.write("b.exr", exr(4, 1, {**rgb(1.0), "A": [1.0, 0.5, 0.0, 0.0]}))
        self.write("a.exr", exr(4, 1, rgb(2.0)))
        self.assertEqual(self.succeed_json("diff", "a.exr", "b.exr", "--foreground")["pixels"], 2)
        self.refuse("diff", "b.exr", "a.exr", "--foreground", says=["a.exr", "object.id", "alpha"])

    def test_pictures_of_a_display_are_compared_as_they_are(self):
        self.write("a.png", png(4, 4, bytes([100] * 48)))
        self.write("b.png", png(4, 4, bytes([120] * 48)))
        plain = self.succeed_json("diff", "a.png", "b.png")
        again = self.succeed_json("diff", "a.png", "b.png", "--tone-map", "none", "--exposure", "0")
        other = self.succeed_json("diff", "a.png", "b.png", "--tone-map", "aces", "--exposure", "auto")
        self.assertEqual(plain["ldr_flip"], again["ldr_flip"])
        self.assertNotEqual(plain["ldr_flip"], other["ldr_flip"])
        self.write("c.exr", exr(4, 4, rgb(0.2)))
        self.assertIn("radiance", self.succeed("diff", "a.png", "c.exr").err)
        # Grey is colour with equal channels.
        self.write("grey.png", png(4, 4, bytes([120] * 16), kind=0))
        self.assertEqual(self.succeed_json("diff", "grey.png", "b.png")["max_difference"], 0)

    def test_peak_and_distance_of_the_eye(self):
        self.pair()
        result = self.succeed_json("diff", "a.exr", "b.exr", "--peak", "1")
        self.assertAlmostEqual(result["psnr"], 10 * math.log10(1 / 0.125))
        near = self.succeed_json("diff", "a.exr", "b.exr", "--pixels-per-degree", "20")
        self.assertNotEqual(near["flip"], self.succeed_json("diff", "a.exr", "b.exr")["flip"])


class Bounds(DiffTest):
    def test_each_measure_has_one(self):
        self.pair()
        measured = self.succeed_json("diff", "a.exr", "b.exr")
        for key in MEASURES:
            higher = key in ("psnr", "ssim")
            option = ("--min-" if higher else "--max-") + key.removeprefix("max_").replace("_", "-")
            good, bad = abs(measured[key]) * 1.01, abs(measured[key]) * 0.99
            if higher:
                good, bad = bad, good
            self.succeed("diff", "a.exr", "b.exr", option, good)
            result = self.gloam("diff", "a.exr", "b.exr", option, bad, "--json")
            self.assertEqual(result.code, 1, str(result))
            self.assertEqual(json.loads(result.out)["exceeded"], [key])
            self.assertEqual(len(result.err.splitlines()), 1, str(result))
            self.assertIn(option, result.err)

    def test_several_and_energy_that_is_lost(self):
        self.pair()
        result = self.gloam("diff", "b.exr", "a.exr", "--max-rmse", "0", "--max-mean-signed-error", "0.1", "--quiet")
        self.assertEqual(result.code, 1)
        self.assertEqual(len(result.err.splitlines()), 2, str(result))
        self.refuse("diff", "a.exr", "b.exr", "--max-rmse", "much", says=["--max-rmse", "much"])
        self.refuse("diff", "a.exr", "b.exr", "--max-rmse", "nan", says="--max-rmse")
        self.refuse("diff", "a.exr", "b.exr", "--max-rmse=-1", says=["--max-rmse", "at least 0"])


class Pictures(DiffTest):
    def test_folder_and_single_files(self):
        self.pair()
        result = self.succeed_json("diff", "a.exr", "b.exr", "-o", "where", "--flip", "mine.png")
        self.assertEqual(result["outputs"], ["where/difference.png", "where/signed_difference.png",
                                             "where/false_color.png", "mine.png", "where/ldr_flip.png"])
        for name in result["outputs"]:
            self.assertEqual(self.picture(name)["size"], "8x4")
        self.succeed("diff", "a.exr", "b.exr", "-o", "where")  # again, over what is there
        self.assertTrue(self.path("where/flip.png").exists())

    def test_differences_are_none_where_equal_and_grow_with_their_factor(self):
        self.pair()
        self.succeed("diff", "b.exr", "b.exr", "-o", "none")
        self.assertEqual(self.means("none/difference.png")["R"], 0)
        self.assertAlmostEqual(self.means("none/signed_difference.png")["R"], GREY, delta=0.003)
        for a, b, sign in ("a.exr", "b.exr", 1), ("b.exr", "a.exr", -1):
            sizes, signed = [], []
            for factor in 1, 2, 4:
                self.succeed("diff", a, b, "--difference", "d.png", "--signed-difference", "s.png", "--factor", factor)
                sizes.append(self.means("d.png")["G"])
                signed.append(sign * (self.means("s.png")["G"] - GREY))
            self.assertTrue(0 < sizes[0] < sizes[1] < sizes[2], sizes)
            self.assertTrue(0 < signed[0] < signed[1] < signed[2], signed)

    def test_masked_pixels_show_no_difference(self):
        self.pair()
        self.write("right.png", png(8, 4, (b"\0" * 4 + b"\xff" * 4) * 4, kind=0))
        self.succeed("diff", "a.exr", "b.exr", "--mask", "right.png", "-o", "where")
        for channel in "RGB":
            self.assertAlmostEqual(self.means("where/signed_difference.png")[channel], GREY, delta=0.003)
            self.assertEqual(self.means("where/difference.png")[channel], 0)
            self.assertEqual(self.means("where/false_color.png")[channel], 0)

    def test_pictures_are_written_where_a_bound_is_exceeded(self):
        self.pair()
        self.assertEqual(self.gloam("diff", "a.exr", "b.exr", "--max-rmse", "0", "--flip", "f.png").code, 1)
        self.assertTrue(self.path("f.png").exists())

    def test_what_cannot_be_written(self):
        self.pair()
        self.write("file", b"")
        self.refuse("diff", "a.exr", "b.exr", "-o", "file", says="file")
        self.refuse("diff", "a.exr", "b.exr", "-o", "none/where", says="none/where")
        self.refuse("diff", "a.exr", "b.exr", "--flip", "f.exr", says=["f.exr", ".png"])
        self.refuse("diff", "a.exr", "b.exr", "--flip", "none/f.png", says="none")
        self.refuse("diff", "a.exr", "b.exr", "--flip", "f.png", "--difference", "./f.png", says="twice")
        self.write("p.png", png(8, 4, bytes(96)))
        self.refuse("diff", "p.png", "b.exr", "--flip", "p.png", says=["p.png", "destroy"])
        self.refuse("diff", "a.exr", "b.exr", "--mask", "p.png", "--flip", "p.png", says=["p.png", "destroy"])


class Refused(DiffTest):
    def refuse_pair(self, a, b, says, *more):
        self.refuse("diff", a, b, *more, "-o", "where", says=says)

    def test_pictures_that_cannot_be_compared(self):
        self.pair()
        nan = [1.0] * 32
        nan[11] = math.nan
        self.write("nan.exr", exr(8, 4, rgb(1.0, nan, 1.0)))
        self.write("small.exr", exr(4, 4, rgb(1.0)))
        self.write("text.exr", b"no picture")
        self.refuse_pair("small.exr", "b.exr", ["small.exr", "4x4", "8x4"])
        self.refuse_pair("nan.exr", "b.exr", ["nan.exr", "(3, 1)"])
        self.refuse_pair("a.exr", "nan.exr", ["nan.exr", "(3, 1)"])
        self.refuse("diff", "a.exr", "b.exr", "--mask", "nan.exr", says=["nan.exr", "(3, 1)", "mask"])
        self.refuse_pair("none.exr", "b.exr", "none.exr")
        self.refuse_pair("a.exr", "none.exr", "none.exr")
        self.refuse_pair("text.exr", "b.exr", "text.exr")
        self.refuse_pair("a.exr", "b.exr", ["small.exr", "4x4"], "--mask", "small.exr")
        self.write("black.png", png(8, 4, bytes(32), kind=0))
        self.refuse_pair("a.exr", "b.exr", ["black.png", "no pixel"], "--mask", "black.png")
        self.refuse_pair("a.exr", "b.exr", "none.png", "--mask", "none.png")

    def test_options_out_of_range(self):
        self.pair()
        for option, value in [("--pixels-per-degree", 0), ("--pixels-per-degree", "nan"), ("--peak", -1), ("--factor", 0),
                              ("--top", 0), ("--exposure", "bright"), ("--exposure", 99), ("--tone-map", "film")]:
            self.refuse_pair("a.exr", "b.exr", option, option, value)
        for option in "--factor", "--top":
            self.refuse("diff", "a.exr", "b.exr", option, "2", says=[option, "was expected with it"])
        self.refuse("diff", "a.exr", "b.exr", "--top", "2", "--flip", "f.png", says=["--top", "--false-color"])
        for option in "--mask", "--flip", "--false-color", "-o":
            self.refuse("diff", "a.exr", "b.exr", option, "", says="empty")
        self.refuse("diff", "", "b.exr", says="empty")
        self.refuse("diff", "a.exr", says=["diff: ", "missing"])
        self.refuse("diff", "a.exr", "b.exr", "--max-rsme", "1", says=["--max-rsme", "did you mean --max-rmse"])


class Rendered(CliTest):
    def test_layers_of_renders(self):
        self.succeed("render", "builtin:columns?detail=0.25", *SMALL, "-o", "a.exr")
        self.succeed("render", "builtin:columns?detail=0.25", *SMALL, "--env-intensity", "1.1", "-o", "b.exr")
        for layer in ["direct", "albedo"]:
            self.succeed("diff", "a.exr", "b.exr", "--layer", layer, "--foreground")
        self.assertEqual(self.succeed_json("diff", "a.exr", "b.exr", "--layer", "normal")["rmse"], 0)
        self.assertEqual(self.succeed_json("diff", "a.exr", "b.exr", "--layer", "depth")["max_difference"], 0)
        self.assertLess(self.succeed_json("diff", "a.exr", "b.exr")["mean_signed_error"], 0)


if __name__ == "__main__":
    unittest.main()
