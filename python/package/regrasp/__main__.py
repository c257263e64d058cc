"""The command line of the package, for plugins in Python: ``plan sphere --load my_plugin.py``, and
``new-plugin sampler mine`` for one to start from.

Options and exit codes are those of the program ``regrasp``: 0 done; 2 bad input; 3 no plan; 4 a plan that
does not verify; 130 interrupted.
"""

from __future__ import annotations

import argparse
import importlib.util
import inspect
import json
import re
import sys
import traceback
from pathlib import Path
from typing import Any

import regrasp as rg

from . import _regrasp
from ._roles import ROLES, Plugin, plugin_id


def load(path: str) -> list[type[Plugin]]:
    """Registers the classes of plugins that a file defines, and gives them."""
    name = Path(path).stem
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None or not Path(path).is_file():
        raise rg.PluginError(f"`{path}` is no file of Python; give one that defines plugins")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    own = [kind for _, kind in inspect.getmembers(module, inspect.isclass) if kind.__module__ == name]
    plugins = [kind for kind in own if issubclass(kind, ROLES)]
    if not plugins:
        raise rg.PluginError(f"`{path}` defines no plugin; derive a class from a role, such as StabilityTest")
    return [rg.register(kind) for kind in plugins]


def value(text: str) -> Any:
    """A setting's value: JSON, or a word."""
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def pairs(texts: list[str]) -> dict[str, str]:
    """``KEY=VALUE`` as a dict."""
    wrong = [text for text in texts if not all(text.partition("=")[::2])]
    if wrong:
        raise rg.ArgumentError(f"`{wrong[0]}` is not of the form KEY=VALUE", key=wrong[0])
    return dict(text.split("=", 1) for text in texts)


def plan(given: argparse.Namespace) -> None:
    """``plan``."""
    settings = {key: value(text) for key, text in pairs(given.set).items()}
    options = {"seed": given.seed, "threads": given.threads, "time_limit": given.time_limit}
    made = rg.plan(
        given.scenario,
        use=pairs(given.use),
        settings=settings,
        preset=given.preset,
        max_nodes=given.max_nodes,
        **options,
    )
    print(made)
    if given.output:
        made.save(given.output)
        print("written to", given.output)


def compare(given: argparse.Namespace) -> None:
    """``compare``."""
    vary = {path: [value(word) for word in texts.split(",")] for path, texts in pairs(given.vary).items()}
    client = None
    if given.dask:
        import distributed

        connect: Any = distributed.Client
        client = connect(given.dask)
    study = rg.compare(
        given.scenario,
        vary,
        seeds=given.seeds,
        output=given.output,
        threads=given.threads,
        time_limit=given.time_limit,
        client=client,
    )
    print(study.summary)
    print("written to", study.folder)


def conform(given: argparse.Namespace) -> None:
    """``conform``."""
    reports = [rg.conformance.check(kind) for kind in given.loaded]
    print("\n".join(str(report) for report in reports))
    if not all(reports):
        raise rg.VerificationError("a plugin breaks the laws of its role")


def new_plugin(given: argparse.Namespace) -> None:
    """``new-plugin``."""
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", given.name):
        raise rg.ArgumentError(
            f"the name `{given.name}` is not in kebab case (lower-case letters and digits, words joined by "
            "`-`, a letter first)",
            key="name",
            value=given.name,
        )
    id = f"{given.role}/{given.name}"
    if any(plugin.id == id for plugin in rg.plugins()):
        raise rg.ArgumentError(f"there is a plugin `{id}`; choose another name", key="name", value=given.name)
    files = _regrasp.plugin_package(given.role, given.name)
    folder = Path(given.output or f"{given.name}-{given.role}")
    if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise rg.ArgumentError(f"`{folder}` exists; give another folder with `-o`", key="output")
    for path, text in files:
        place = folder / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")
    print(f"`{folder}` has the plugin `{id}`; it works as it is: cd {folder} && python -m pytest")


def parser() -> argparse.ArgumentParser:
    """The command line's form."""
    top = argparse.ArgumentParser(prog="python -m regrasp", description=inspect.getdoc(sys.modules[__name__]))
    commands = top.add_subparsers(required=True)
    form = commands.add_parser("new-plugin", help="write a package with a plugin of your own, and its test")
    form.set_defaults(run=new_plugin, load=[])
    form.add_argument("role", help="such as sampler")
    form.add_argument("name", help="in kebab case")
    form.add_argument("-o", "--output", metavar="FOLDER")
    for command, run in (("plan", plan), ("compare", compare), ("conform", conform)):
        form = commands.add_parser(command)
        form.set_defaults(run=run)
        form.add_argument("--load", action="append", default=[], metavar="FILE.py", help="define plugins")
        if command == "conform":
            continue
        form.add_argument("scenario", nargs="+" if command == "compare" else None)
        form.add_argument("--threads", type=int, default=1, metavar="N")
        form.add_argument("--time-limit", type=float, metavar="S")
        form.add_argument("-o", "--output", metavar="PLACE")
        if command == "plan":
            form.add_argument("--seed", type=int, default=0, metavar="N")
            form.add_argument("--preset", metavar="NAME")
            form.add_argument("--use", action="append", default=[], metavar="SLOT=ID")
            form.add_argument("--set", action="append", default=[], metavar="SLOT.KEY=VALUE")
            form.add_argument("--max-nodes", type=int, metavar="N")
        else:
            form.add_argument("--vary", action="append", default=[], metavar="SLOT=ID,ID")
            form.add_argument("--seeds", type=int, default=30, metavar="N")
            form.add_argument("--dask", metavar="ADDRESS", help="make the runs on this Dask cluster")
    return top


def main(arguments: list[str] | None = None) -> int:
    """Runs a command, and gives the exit code."""
    given = parser().parse_args(arguments)
    codes = {rg.NoPlan: 3, rg.VerificationError: 4}
    try:
        given.loaded = [kind for path in given.load for kind in load(path)]
        for kind in given.loaded:
            print("loaded", plugin_id(kind), file=sys.stderr)
        given.run(given)
    except rg.RegraspError as error:
        code = codes.get(type(error), 2)
        print(f"error: {error}" if code == 2 else error, file=sys.stderr)
        return code
    except KeyboardInterrupt:
        return 130
    except Exception:
        traceback.print_exc()
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
