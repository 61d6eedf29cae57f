# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""The completion script, in a real bash."""
import subprocess
import unittest

from harness import GLOAM, CliTest

ASK = """
set -u
eval "$("$1" completion bash)"
compopt() { :; }  # works only while a person completes
COMP_LINE=$2 COMP_POINT=${#2} COMP_WORDS=($2)
_gloam
printf '%s\\n' "${COMPREPLY[@]}"
"""


class Completion(CliTest):
    def complete(self, line):
        process = subprocess.run(["bash", "--norc", "-c", ASK, "bash", GLOAM, line], cwd=self.folder, capture_output=True,
                                 text=True, check=False)
        self.assertEqual((process.returncode, process.stderr), (0, ""), line)
        return process.stdout.split()

    def test_verbs(self):
        self.assertEqual(self.complete("gloam ren"), ["render"])
        self.assertIn("bake", self.complete("gloam "))

    def test_options(self):
        self.assertEqual(set(self.complete("gloam render a.glb --env-")), {"--env-rotation", "--env-intensity"})
        self.assertEqual(self.complete("gloam bake --bounce-"), ["--bounce-directions"])

    def test_values(self):
        self.assertEqual(set(self.complete("gloam render --tone-map ")), {"none", "aces"})
        self.assertIn("irradiance", self.complete("gloam render --technique "))
        self.assertEqual(self.complete("gloam completion "), ["bash"])

    def test_names_with_colons_lose_what_bash_keeps(self):
        self.assertIn("cornell", self.complete("gloam render builtin:co"))
        self.assertIn("mild", self.complete("gloam render x.glb --env sky:"))

    def test_verbs_of_two_words(self):
        self.assertEqual(self.complete("gloam bake sph"), ["spheres"])
        self.assertEqual(self.complete("gloam bake spheres --eff"), ["--effort"])
        self.assertEqual(self.complete("gloam bake spheres --bounce"), [])

    def test_files(self):
        self.path("model.glb").write_bytes(b"")
        self.assertIn("model.glb", self.complete("gloam info mod"))


if __name__ == "__main__":
    unittest.main()
