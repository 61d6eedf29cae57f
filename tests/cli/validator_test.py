# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""What gloam writes, held against the Khronos glTF validator (npm's gltf-validator; skipped where node and npm lack)."""
import os
import pathlib
import shutil
import subprocess
import unittest

from harness import SOURCE, CliTest

SCENES = ["furnace", "furnace-concave", "bowl", "cornell", "spheres", "shadow", "bronze", "caustic", "columns",
          "gallery", "lamp", "textured", "walker", "mobile", "passing", "ring", "squirrel", "robot", "packages",
          "assembly", "balls", "pair", "bend", "box", "links", "bars", "furnace-pair"]


def missing():
    """Why the validator cannot run, or None."""
    if not shutil.which("node"):
        return "node is not installed"
    if (SOURCE / "assets/validator/index.js").exists():
        return None
    if not shutil.which("npm"):
        return "npm is not installed"
    done = subprocess.run([SOURCE / "tools/get-assets", "validator"], capture_output=True, text=True, check=False)
    return None if done.returncode == 0 else "the validator could not be fetched: " + done.stderr.strip()[:200]


WHY_NOT = missing()


@unittest.skipIf(WHY_NOT, f"Khronos validator: {WHY_NOT}")
class Validator(CliTest):
    def validate(self, files):
        done = subprocess.run(["node", SOURCE / "tools/validate-glb.mjs", *map(str, files)], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count(" 0 errors, 0 warnings"), len(files), done.stdout)

    def test_built_in_scenes(self):
        for name in SCENES:
            self.succeed("scene", f"{name}?detail=0.5", "-o", f"{name}.glb")
        self.validate(sorted(self.folder.glob("*.glb")))

    def test_bakes(self):
        bake = ["bake", "builtin:columns?detail=0.25", "--directions", "256", "--bounce-directions", "256"]
        self.succeed(*bake, "--bounces", "1", "-o", "di.glb")
        self.succeed(*bake, "--kind", "ds", "--half", "-o", "ds.glb")
        self.succeed(*bake, "--bounces", "1", "--pca", "4x8", "-o", "pca.glb")
        self.succeed(*bake, "--bounces", "1", "--pca", "300x3", "--half", "-o", "pca_half.glb")
        gallery = ["bake", "builtin:gallery?detail=0.25", "--directions", "256", "--bounce-directions", "256"]
        self.succeed(*gallery, "--texels", "16", "--half", "-o", "texels.glb")
        self.succeed(*gallery, "--tessellate", "0.2", "-o", "split.glb")
        gloss = ["bake", "builtin:bronze?detail=0.25", "--directions", "256", "--bounce-directions", "256", "--order", "3"]
        self.succeed(*gloss, "--bounces", "1", "-o", "gi.glb")
        self.succeed(*gloss, "--kind", "ds", "--bake-gloss", "4", "--half", "-o", "gs.glb")
        near = ["bake", "builtin:ring?detail=0.25", "--directions", "256", "--bounce-directions", "64", "--order", "3", "--grid", "4",
                "--neighbourhood", "ring"]
        self.succeed(*near, "-o", "near.glb")
        self.succeed(*near, "--half", "-o", "near_half.glb")
        cloud = ["bake", "builtin:cloud?detail=0.25", "--directions", "256", "--order", "3", "--bounces", "1", "--scatterings", "2"]
        self.succeed(*cloud, "-o", "cloud.glb")
        self.succeed(*cloud, "--half", "-o", "cloud_half.glb")
        self.validate([self.path(f"{name}.glb") for name in ("cloud", "cloud_half", "texels", "split", "di", "ds", "gi", "gs", "near", "near_half")])

    def test_what_the_writers_own_tests_write(self):
        scene_test = pathlib.Path(os.environ["SCENE_TEST"])
        subprocess.run([scene_test, "--gtest_filter=WriteGlb.*"], check=True, capture_output=True,
                       env=dict(os.environ, GLOAM_KEEP_WRITTEN=str(self.folder)))
        files = sorted(self.folder.glob("*.glb"))
        self.assertGreater(len(files), 2)
        self.validate(files)


if __name__ == "__main__":
    unittest.main()
