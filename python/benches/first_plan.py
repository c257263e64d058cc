"""What a first plan takes from Python, beside the program: medians of fresh processes.

    python first_plan.py PATH_OF_REGRASP [--runs N]

`PATH_OF_REGRASP` is the program of the same version and profile. The call is timed within its process, from
the scenario's name to the verified plan; the program by what it reports itself, planning and verification.
"""

import argparse
import json
import statistics
import subprocess
import sys
import time

CALL = """
import json, time
a = time.perf_counter()
import regrasp
b = time.perf_counter()
plan = regrasp.plan("sphere")
c = time.perf_counter()
warm = []
for _ in range(20):
    d = time.perf_counter()
    again = regrasp.plan("sphere")
    warm.append((time.perf_counter() - d, again.planning_time + again.verification_time))
call, inside = min(warm)
own = plan.planning_time + plan.verification_time
print(json.dumps({"import": b - a, "call": c - b, "own": own, "warm call": call, "warm own": inside}))
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--runs", type=int, default=15)
    given = parser.parse_args()
    figures: dict[str, list[float]] = {}

    def note(name: str, value: float) -> None:
        figures.setdefault(name, []).append(1e3 * value)

    for _ in range(given.runs):
        start = time.perf_counter()
        said = subprocess.run([sys.executable, "-c", CALL], capture_output=True, text=True, check=True).stdout
        note("python: whole process, 21 plans", time.perf_counter() - start)
        for name, value in json.loads(said).items():
            note(f"python: {name}", value)
        start = time.perf_counter()
        said = subprocess.run(
            [given.program, "plan", "sphere", "--json"], capture_output=True, text=True, check=True
        ).stdout
        note("program: whole process", time.perf_counter() - start)
        answer = json.loads(said)
        note("program: own", answer["time_s"] + answer["verification_s"])
    for name, values in sorted(figures.items()):
        print(
            f"{name}: median {statistics.median(values):.2f} ms, least {min(values):.2f}, most {max(values):.2f}"
        )
    for other in ("program: own", "program: whole process"):
        over = statistics.median(figures["python: call"]) - statistics.median(figures[other])
        print(f"a first plan from Python takes {over:.2f} ms more than `{other}`")


if __name__ == "__main__":
    main()
