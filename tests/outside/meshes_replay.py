"""Carries out the plans that `meshes_table.py` kept (MESH_PLANS) in MuJoCo, the object being its true mesh: one convex piece below each facet.

    REGRASP=target/debug/regrasp python tests/outside/meshes_replay.py FOLDER > table.md

One line a plan, then the share that arrives; the exit code is 4 where that is below nine of ten.
"""

import json
import subprocess
import sys
from pathlib import Path

REPLAY = Path(__file__).with_name("mujoco_replay.py")
# How long one replay may take (s), and the share that is to arrive.
LIMIT, WANTED = 900, 0.9


def replayed(plan):
    """Whether the object arrives (`None`: not carried out), and what was measured or why not."""
    try:
        done = subprocess.run([sys.executable, REPLAY, plan, "--json"], capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return None, f"not carried out in {LIMIT} s"
    if done.returncode not in (0, 4):
        return None, done.stderr.strip().splitlines()[-1][:200]
    told = json.loads(done.stdout)
    end = f"{1e3 * told['end_distance_m']:.2f} mm, {57.2958 * told['end_angle_rad']:.2f}°"
    return told["arrived"], f"{end} | {told['segments_in_plan']} | {told['reason'] or ''}"


def main():
    arrived, ran = 0, 0
    print("| object | arrives | in the end off by | segments | what happened |\n|---|---|---|---|---|")
    others = (".partial", ".rejected", ".contact-surface")
    plans = [path for path in sorted(Path(sys.argv[1]).glob("*.json")) if not path.stem.endswith(others)]
    for plan in plans:
        verdict, told = replayed(plan)
        word = {True: "yes", False: "no", None: "-"}[verdict]
        print(f"| {plan.stem} | {word} | {told} |", flush=True)
        arrived, ran = arrived + (verdict is True), ran + (verdict is not None)
    print(f"\n{arrived} of {ran} plans arrive; {len(plans) - ran} were not carried out.")
    return 0 if ran and arrived >= WANTED * ran else 4


if __name__ == "__main__":
    sys.exit(main())
