"""What a call of a plugin in Python costs above Python's own: medians of rounds, in processor time.

    pip install regrasp
    python role_cost.py [--rounds N]

`Bench.margins` asks a stability test for a verdict and a margin of each configuration, both in Python here;
the same two methods are then called from Python on a grasp that is there already, and the difference is
what a call costs on its way from the planner and back, the grasp that it is handed included.
"""

import argparse
import statistics
import time

import regrasp as rg


class Nothing(rg.StabilityTest):
    """Answers at once."""

    def test(self, grasp: rg.Grasp) -> bool:
        return True

    def margin(self, grasp: rg.Grasp, length: object, center: object) -> tuple[float, float]:
        return 0.5, 0.5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=30)
    rounds = parser.parse_args().rounds
    configurations = rg.sample_grasps("sphere", 100, seed=1) * 20
    bench, count = rg.Bench("sphere", use={"stability-test": Nothing}), len(configurations)
    normals = [[1, 0, 0], [-1, 0, 0], [0, 1, 0]]
    plugin, grasp = Nothing(), rg.Grasp(normals, normals)
    through, own = [], []
    for _ in range(rounds):
        start = time.process_time()
        bench.margins(configurations)
        middle = time.process_time()
        for _ in range(count):
            plugin.test(grasp)
            plugin.margin(grasp, None, None)
        through.append((middle - start) / count)
        own.append((time.process_time() - middle) / count)
    both, python = 1e6 * statistics.median(through), 1e6 * statistics.median(own)
    print(f"two calls from the planner {both:.2f} µs, from Python {python:.2f} µs")
    print(f"a call costs {(both - python) / 2:.2f} µs above Python's own")


if __name__ == "__main__":
    main()
