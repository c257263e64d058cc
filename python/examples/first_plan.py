"""Plans a built-in scenario, looks at the arrays, and saves plan and page."""

import tempfile
from pathlib import Path

import regrasp as rg

plan = rg.plan("sphere", seed=1)
print(plan)
print(f"{len(plan.times)} states, {plan.duration:.2f} s, {plan.joints.shape[1]} joints")
for segment in plan:
    moving = "the object" if segment.kind == "transfer" else f"finger {segment.finger}"
    print(f"  {plan.times[segment.first]:5.2f} s  {segment.kind:<9} {moving}")
verdict = plan.verify()
print("valid" if verdict else verdict.failures)

folder = Path(tempfile.mkdtemp())
plan.save(folder / "plan.json")
(folder / "plan.html").write_text(plan.page())
print(f"saved; open {folder / 'plan.html'} in a browser")
