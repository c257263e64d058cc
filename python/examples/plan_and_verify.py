"""A plan, its file, and what the independent verifier says of it; of a spoilt one, too."""

import tempfile
from pathlib import Path

import regrasp as rg

if __name__ == "__main__":
    plan = rg.plan("sphere", seed=0)  # `rg.scenarios()` lists what is built in; a file's path works too

    # A plan file stands alone: problem, meshes, plugins, seed and motion are inside.
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "plan.json")
        plan.save(file)
        assert rg.load(file) == plan, "every number is read as it was written"
    print(plan)

    assert plan.verify() and plan.certificate is not None
    for what, scale, unit in (
        ("closure_margin", 1, ""),
        ("clearance", 1e3, " mm"),
        ("slip", 1e3, " mm"),
        ("closure_residual", 1e6, " µm"),
    ):
        print(f"  {what:<17} {scale * plan.certificate[what]['value']:.3f}{unit}")

    print("the ball lifted by half a millimetre in one state of the first transfer:")
    tree = plan.to_dict()
    states = next(part for part in tree["segments"] if part["kind"] == "transfer")["states"]
    states[len(states) // 2]["object"]["position"][2] += 0.0005
    verdict = rg.Plan.from_dict(tree).verify()
    print("  fails:", ", ".join(check.name for check in verdict.failures))
    assert not verdict and "closure" in [check.name for check in verdict.failures]
