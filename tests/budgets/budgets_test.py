# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Holds every technique to its error budget: tests/budgets.json says, for each technique and small scene, how far its
picture may be from the path-traced reference of the same light and bounces.

Usage: budgets_test.py GLOAM BUDGETS.json [TECHNIQUE…]. Pictures and results stay in the folder of the first failure, for eyes.
"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

STAGE = ("scene", "environment", "bounces", "sh_order", "size", "spp")
# "bake": options of `gloam bake`, by which the scene is baked beforehand; without them by the defaults of compare.
MEASURES = ("rmse", "relative_squared_error", "flip", "mean_signed_error")
LAYERS = ("direct", "indirect")  # either may have bounds of its own: "most": {"flip": …, "direct": {"flip": …}}
FIELDS = {*STAGE, "technique", "settings", "most", "date", "reason"}


def bounds(budget):
    """(layer or None, measure, greatest value) of all that is bounded."""
    for name, most in budget["most"].items():
        if name in LAYERS:
            yield from ((name, measure, value) for measure, value in most.items())
        else:
            yield None, name, most


def read_budgets(path):
    budgets = json.loads(path.read_text(encoding="utf-8"))["budgets"]
    for budget in budgets:
        missing, unknown = FIELDS - set(budget), set(budget) - FIELDS - {"bake"}
        if missing or unknown or not budget["most"] or {name for _, name, _ in bounds(budget)} - set(MEASURES):
            raise SystemExit(f"{path}: {budget.get('technique')} on {budget.get('scene')}: missing {sorted(missing)}, "
                             f"unknown {sorted(unknown)}, or 'most' holds other measures than {', '.join(MEASURES)}, "
                             f"or layers than {', '.join(LAYERS)}")
    return budgets


def contender(budget):
    return ":".join([budget["technique"], *(f"{name}={value}" for name, value in budget["settings"].items())])


def stages(budgets):
    """Budgets that share a reference are compared in one run."""
    groups = {}
    for budget in budgets:
        stage = tuple(budget[name] for name in STAGE) + (tuple(budget.get("bake", ())),)
        groups.setdefault(stage, []).append(budget)
    return groups.items()


def run(command, folder):
    print("$", " ".join(command), flush=True)
    process = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False,
                             env=dict(os.environ, XDG_CACHE_HOME=str(folder.parent / "cache")))
    if process.returncode != 0:
        raise SystemExit(f"exit {process.returncode}\n{process.stderr}")
    return process.stdout


def compare(gloam, stage, budgets, folder):
    choice, bake = dict(zip(STAGE, stage)), stage[-1]
    if bake:
        baked = str(folder) + ".glb"
        run([gloam, "bake", choice["scene"], "--bounces", str(choice["bounces"]), *bake, "--quiet", "-o", baked], folder)
        choice["scene"] = baked
    command = [gloam, "compare", choice["scene"], "--env", choice["environment"], "--size", choice["size"],
               "--bounces", str(choice["bounces"]), "--spp", str(choice["spp"]), "--sh-order", str(choice["sh_order"]),
               "--techniques", ",".join(dict.fromkeys(map(contender, budgets))), "--frames", "1", "--quiet", "--json",
               "-o", str(folder)]
    return json.loads(run(command, folder))["techniques"]


def violations(budget, result):
    for layer, measure, most in bounds(budget):
        value = (result[layer] if layer else result)[measure]
        name = f"{layer}.{measure}" if layer else measure
        kept = value is not None and math.isfinite(value) and abs(value) <= most
        shown = "null" if value is None else f"{value:.5f}"
        print(f"  {contender(budget):<28} {name:<32} {shown:>10}  at most {most:<8g} {'' if kept else 'EXCEEDED'}")
        if not kept:
            yield f"{contender(budget)} on {budget['scene']}: {name} {value} is above {most} ({budget['date']}: {budget['reason']})"


def main():
    gloam, path = sys.argv[1], pathlib.Path(sys.argv[2])
    only = set(sys.argv[3:])
    folder = pathlib.Path(tempfile.mkdtemp(prefix="gloam-budgets-"))
    exceeded = []
    for number, (stage, budgets) in enumerate(stages([b for b in read_budgets(path) if not only or b["technique"] in only])):
        results = compare(gloam, stage, budgets, folder / str(number))
        order = list(dict.fromkeys(map(contender, budgets)))
        for budget in budgets:
            exceeded += violations(budget, results[order.index(contender(budget))])
    if exceeded:
        print(*exceeded, f"pictures: {folder}", sep="\n")
        sys.exit(1)
    shutil.rmtree(folder)


main()
