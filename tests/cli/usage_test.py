# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Help, versions, exit codes; what is typed wrong."""
import re
import unittest

from harness import SOURCE, VERBS, CliTest


class Help(CliTest):
    def test_without_a_verb_lists_all_verbs(self):
        for arguments in [], ["--help"], ["-h"]:
            out = self.succeed(*arguments).out
            for verb in VERBS:
                self.assertRegex(out, rf"(?m)^  {verb} ")

    def test_every_verb_has_help_with_examples(self):
        for verb in VERBS:
            out = self.succeed(verb, "--help").out
            self.assertIn("Examples", out)
            self.assertRegex(out, rf"gloam {verb} ")
            self.assertNotIn("REQUIRED", out)
            self.assertLessEqual(max(map(len, out.splitlines())), 120, verb)

    def test_help_wins_over_missing_arguments(self):
        self.succeed("render", "--help", "--quiet")

    def test_version(self):
        self.assertRegex(self.succeed("--version").out, r"^gloam \d+\.\d+\.\d+\n$")

    def test_options_of_techniques_are_in_the_help(self):
        techniques = self.succeed_json("list", "--techniques")["techniques"]
        out = self.succeed("render", "--help").out
        for technique in techniques:
            self.assertIn(technique["name"], out)
            for option in technique["options"]:
                self.assertIn(f"--{technique['name']}.{option['name']}", out)


class Usage(CliTest):
    def test_unknown_verb_names_the_verbs(self):
        self.refuse("rendr", says=["rendr", "did you mean render", "bake"])
        self.refuse("", says="no verb")

    def test_unknown_option_names_a_near_one(self):
        self.refuse("render", "builtin:cornell", "--siez", "9", says=["gloam: render: ", "--siez", "did you mean --size"])
        self.refuse("list", "--frobnicate", says="--frobnicate")
        self.refuse("render", "builtin:cornell", "--irradiance.no_such", "1", says="--irradiance.no_such")

    def test_words_that_are_far_are_not_proposed(self):
        for command, far in (["completion", "zsh"], "did you mean"), (["bake", "builtin:cornell", "--kind", "xx"], "did you mean"):
            self.assertNotIn(far, self.refuse(*command, says=command[-1]))
        self.refuse("bake", "builtin:cornell", "--kind", "dx", says="did you mean du")

    def test_missing_argument(self):
        for verb in "render", "bake", "info", "scene":
            self.refuse(verb, says=[f"gloam: {verb}: ", "missing"])

    def test_missing_value(self):
        self.refuse("render", "builtin:cornell", "--size", says=["--size", "value"])
        self.refuse("render", "builtin:cornell", "--env=", "-o", "x.png", says=["--env", "value after '='"])

    def test_one_argument_too_many(self):
        self.refuse("render", "builtin:cornell", "other.glb", says="other.glb")

    def test_shell_that_is_not_known(self):
        self.refuse("completion", "fish", says=["fish", "bash"])


class Docs(CliTest):
    def test_every_option_is_in_the_docs(self):
        text = (SOURCE / "docs" / "cli.md").read_text(encoding="utf-8")
        for verb in VERBS:
            self.assertIn(f"## gloam {verb}", text)
            for option in re.findall(r"(?m)^  (?:-\w,)?(--[a-z-]+)(?=[ ,]|$)", self.succeed(verb, "--help").out):
                self.assertIn(option, text, f"gloam {verb}: docs/cli.md does not mention {option}")

    def test_the_page_of_rows_is_up_to_date(self):
        page = (SOURCE / "docs" / "rows.md").read_text(encoding="utf-8")
        self.assertEqual(page, self.succeed("list", "--rows", "--markdown").out,
                         "run: gloam list --rows --markdown > docs/rows.md")


if __name__ == "__main__":
    unittest.main()
