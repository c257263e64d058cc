"""What `new-plugin` writes works as it is, for every role."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from regrasp.__main__ import main

ROLES = ("contact-model", "stability-test", "surface", "sampler", "local-planner", "graph-strategy")


@pytest.mark.parametrize("role", ROLES)
def test_the_written_package_passes_its_own_test(role: str, tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    assert main(["new-plugin", role, "my-own", "-o", str(folder)]) == 0
    plain = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}
    test = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(test, cwd=folder, env=plain, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0 and "2 passed" in done.stdout, done.stdout + done.stderr
    types = [sys.executable, "-m", "mypy", "--strict", f"my_own_{role.replace('-', '_')}.py", "tests"]
    done = subprocess.run(types, cwd=folder, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout


def test_it_writes_only_where_nothing_is_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "kept.txt").write_text("mine")
    cases = [
        (["sampler", "own", "-o", str(tmp_path)], "exists"),
        (["samplr", "own", "-o", str(tmp_path / "a")], "`role` = samplr is outside contact-model,"),
        (["sampler", "rlg", "-o", str(tmp_path / "b")], "there is a plugin `sampler/rlg`"),
        (["sampler", "My_Own", "-o", str(tmp_path / "c")], "kebab case"),
    ]
    for arguments, why in cases:
        assert main(["new-plugin", *arguments]) == 2
        assert why in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["kept.txt"]
