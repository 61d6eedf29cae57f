# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Built-in scenes that move, as another program reads them from .glb: nothing jumps from frame to frame."""
import bisect
import json
import math
import struct
import unittest

from harness import CliTest

FRAMES_PER_SECOND = 60
FASTEST_M = 8.0 / FRAMES_PER_SECOND  # a frame
MOST_RAD = 30.0 / FRAMES_PER_SECOND


class Animated:
    """Nodes and channels of a .glb as gloam writes it: floats, translation and rotation, nodes in trees."""

    def __init__(self, data):
        json_size = struct.unpack_from("<I", data, 12)[0]
        self.gltf = json.loads(data[20:20 + json_size])
        self.binary = data[20 + json_size + 8:]
        self.channels = []
        for animation in self.gltf.get("animations", []):
            for channel in animation["channels"]:
                sampler = animation["samplers"][channel["sampler"]]
                times = [t for t, in self.numbers(sampler["input"])]
                self.channels.append((channel["target"]["node"], channel["target"]["path"], times,
                                      self.numbers(sampler["output"]), sampler.get("interpolation", "LINEAR")))
        self.parent = {child: i for i, node in enumerate(self.gltf["nodes"]) for child in node.get("children", [])}

    def numbers(self, index):
        accessor = self.gltf["accessors"][index]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        assert accessor["componentType"] == 5126, accessor
        start = self.gltf["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
        flat = struct.unpack_from(f"<{width * accessor['count']}f", self.binary, start)
        return [flat[i:i + width] for i in range(0, len(flat), width)]

    def duration_s(self):
        return max((channel[2][-1] for channel in self.channels), default=0.0)

    def pose(self, time_s):
        """World place and rotation of each node."""
        local = [(node.get("translation", [0, 0, 0]), node.get("rotation", [0, 0, 0, 1])) for node in self.gltf["nodes"]]
        for node, path, times, values, interpolation in self.channels:
            value = sampled(times, values, interpolation, time_s)
            if path == "translation":
                local[node] = (value, local[node][1])
            elif path == "rotation":
                local[node] = (local[node][0], unit(value))
        world = {}

        def place(i):
            if i not in world:
                translation, rotation = local[i]
                if i in self.parent:
                    origin, turn = place(self.parent[i])
                    translation = [a + b for a, b in zip(origin, turned(turn, translation))]
                    rotation = times_quaternion(turn, rotation)
                world[i] = (translation, rotation)
            return world[i]

        return [place(i) for i in range(len(local))]


def sampled(times, values, interpolation, time_s):
    step = 3 if interpolation == "CUBICSPLINE" else 1
    first = values[step // 2::step] if step == 3 else values
    k = bisect.bisect_right(times, time_s) - 1
    if k < 0 or k + 1 >= len(times):
        return first[0] if k < 0 else first[-1]
    span = times[k + 1] - times[k]
    x = (time_s - times[k]) / span
    if interpolation == "STEP":
        return first[k]
    a, b = first[k], first[k + 1]
    if step == 3:
        out, into = values[3 * k + 2], values[3 * k + 3]
        h = (2 * x**3 - 3 * x**2 + 1, (x**3 - 2 * x**2 + x) * span, 3 * x**2 - 2 * x**3, (x**3 - x**2) * span)
        return [h[0] * p + h[1] * m + h[2] * q + h[3] * n for p, m, q, n in zip(a, out, b, into)]
    if len(a) == 4 and sum(p * q for p, q in zip(a, b)) < 0:
        b = [-q for q in b]
    return [p + x * (q - p) for p, q in zip(a, b)]


def unit(q):
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def times_quaternion(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]


def turned(q, v):
    inverse = [-q[0], -q[1], -q[2], q[3]]
    return times_quaternion(times_quaternion(q, [*v, 0.0]), inverse)[:3]


def angle_between(a, b):
    return 2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b)))))


class Motion(CliTest):
    def check(self, name):
        self.succeed("scene", f"{name}?detail=0.25", "-o", "a.glb")
        scene = Animated(self.path("a.glb").read_bytes())
        frames = round(scene.duration_s() * FRAMES_PER_SECOND)
        before = scene.pose(0.0)
        for frame in range(1, frames + 1):
            now = scene.pose(frame / FRAMES_PER_SECOND)
            for node, (was, is_now) in enumerate(zip(before, now)):
                where = f"{name}, {scene.gltf['nodes'][node].get('name')}, frame {frame}"
                self.assertLess(math.dist(was[0], is_now[0]), FASTEST_M, where)
                self.assertLess(angle_between(was[1], is_now[1]), MOST_RAD, where)
            before = now
        return frames

    def test_nothing_jumps(self):
        moving = {}
        for scene in self.succeed_json("list", "--scenes")["scenes"]:
            frames = self.check(scene["name"].removeprefix("builtin:"))
            if frames:
                moving[scene["name"].removeprefix("builtin:")] = frames
        for name in "squirrel", "robot", "packages", "assembly", "bend":
            self.assertEqual(moving[name], 4 * FRAMES_PER_SECOND, name)


if __name__ == "__main__":
    unittest.main()
