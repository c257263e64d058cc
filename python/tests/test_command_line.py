"""``python -m regrasp``: plugins from files, and exit codes."""

import subprocess
import sys

import regrasp as rg
from regrasp.__main__ import main

PLUGIN = '''
"""A plugin in a file."""
import regrasp as rg

class Reticent(rg.StabilityTest):
    """Force closure, said again."""

    references = ("V.-D. Nguyen, Constructing force-closure grasps, IJRR 1988",)

    def test(self, grasp):
        return bool(rg.force_closure(grasp.points, grasp.normals, grasp.friction))

    def margin(self, grasp, length, center):
        bounds = rg.closure_margin(grasp.points, grasp.normals, grasp.friction, center=center, length=length)
        return tuple(bounds)
'''


def test_a_plugin_from_a_file_plans_and_conforms(tmp_path, capsys) -> None:
    (tmp_path / "reticent.py").write_text(PLUGIN)
    output = tmp_path / "plan.json"
    words = ["plan", "sphere", "--seed", "1", "--load", str(tmp_path / "reticent.py")]
    assert main([*words, "--use", "stability-test=reticent", "-o", str(output)]) == 0
    assert rg.load(output).scenario["plugins"]["stability-test"]["id"] == "stability-test/reticent"
    assert main(["conform", "--load", str(tmp_path / "reticent.py")]) == 0
    assert "0 broken" in capsys.readouterr().out


def test_exit_codes_are_those_of_the_program(tmp_path, capsys) -> None:
    (tmp_path / "empty.py").write_text("")
    assert main(["plan", "spere"]) == 2
    slippery = tmp_path / "slippery.toml"
    slippery.write_text(rg.scenario_text("sphere").replace("friction = 0.8", "friction = 0.02"))
    assert main(["plan", str(slippery)]) == 3
    assert main(["plan", "sphere", "--load", str(tmp_path / "empty.py")]) == 2
    assert main(["plan", "sphere", "--load", str(tmp_path / "none.py")]) == 2
    assert main(["plan", "sphere", "--use", "sampler"]) == 2
    said = capsys.readouterr().err
    assert "did you mean `sphere`" in said and "defines no plugin" in said and "KEY=VALUE" in said


def test_the_module_runs() -> None:
    done = subprocess.run([sys.executable, "-m", "regrasp", "plan", "sphere"], capture_output=True, text=True)
    assert done.returncode == 0 and "<Plan 'sphere'" in done.stdout
