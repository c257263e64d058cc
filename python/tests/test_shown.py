"""What shows a plan: plots, the page led from Python, and what notebooks get."""

import builtins
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import regrasp as rg


@pytest.fixture(scope="module")
def plan() -> rg.Plan:
    return rg.plan("cubic", seed=1)


@pytest.fixture(scope="module")
def bare(plan: rg.Plan) -> rg.Plan:
    """The same plan without forces."""
    tree = plan.to_dict()
    for segment in tree["segments"]:
        for state in segment["states"]:
            state.pop("forces")
    return rg.Plan.from_dict(tree)


@pytest.fixture(scope="module")
def held() -> rg.Plan:
    task = rg.Scenario(
        object=rg.Sphere(0.03, mass=0.05, friction=0.9),
        start=rg.pose(z=0.085),
        goals=[rg.pose(z=0.085, axis="z", angle_deg=40)],
        hold=rg.Hold(friction_factor=0.8),
    )
    return task.plan(seed=1)


def test_figures_are_those_of_the_certificate(plan: rg.Plan, bare: rg.Plan) -> None:
    figures, certificate = plan.figures, plan.certificate
    assert certificate is not None
    assert figures.margin.shape == figures.clearance.shape == plan.times.shape
    # Between states both can be smaller, and at places that the certificate names they are.
    assert np.nanmin(figures.margin) >= certificate["closure_margin"]["value"] - 1e-9
    assert np.nanmin(figures.clearance) >= certificate["clearance"]["value"] - 1e-9
    assert np.nanmin(figures.clearance) < 2 * certificate["clearance"]["value"] + 1e-3
    assert np.isnan(bare.figures.friction).all() and np.isnan(bare.figures.effort_share).all()


def test_forces_need_no_more_friction_and_effort_than_there_is(held: rg.Plan) -> None:
    friction = held.figures.friction
    assert np.isfinite(friction).any(axis=1).all() and np.isnan(friction[~held.contacts.holding]).all()
    assert 0 < np.nanmax(friction) <= 0.8 * 0.9 + 1e-6
    assert 0 < np.nanmax(held.figures.effort_share) <= 1


def test_a_plan_is_drawn_with_units_and_limits(bare: rg.Plan, held: rg.Plan, tmp_path) -> None:
    figure_kind = pytest.importorskip("matplotlib.figure").Figure
    drawn = bare.plot()
    labels = {ax.get_ylabel() for ax in drawn.axes}
    assert {"joints (rad)", "closure margin (1)", "clearance (mm)"} <= labels
    first = drawn.axes[0]
    lower = bare.scenario["problem"]["hand"]["finger"][0]["joint"][0]["lower"]
    heights = [line.get_ydata()[0] for line in first.lines if line.get_linestyle() == "--"]
    assert lower in heights and len(heights) == 6
    shaded = sum(segment.kind == "regrasp" for segment in bare)
    assert len(first.patches) == shaded > 0
    given = held.plot(figure_kind(figsize=(9, 8)))
    labels = {ax.get_ylabel() for ax in given.axes}
    assert {"efforts (N·m)", "friction needed (1)"} <= labels
    friction = next(ax for ax in given.axes if ax.get_ylabel() == "friction needed (1)")
    assert any(line.get_label() == "given" and line.get_ydata()[0] == 0.9 for line in friction.lines)
    given.savefig(tmp_path / "plan.png")
    assert (tmp_path / "plan.png").stat().st_size > 10_000


def test_a_study_is_drawn(tmp_path) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    study = rg.compare(
        "sphere", {"stability-test": ["force-closure", "socp"]}, seeds=3, output=tmp_path / "s"
    )
    (panel,) = study.plot().axes
    assert panel.get_title() == "sphere" and panel.get_xlabel() == "planning time (s)"
    assert len(panel.lines) == 2
    for line in panel.lines:
        assert line.get_label().endswith("3 of 3") and line.get_ydata()[-1] == 1


def test_the_view_is_led_from_python_and_tells_what_the_page_does() -> None:
    pytest.importorskip("anywidget")
    view = rg.plan("sphere", seed=0).view
    assert view.is_live
    view.time = 1.3
    view.play()
    assert view.time == 1.3 and view.playing
    page = view._widget
    assert page.get_state()["time"] == 1.3 and "window.regrasp" in page.get_state()["page"]
    page.set_state({"time": 0.4, "playing": False})
    assert view.time == 0.4 and not view.playing
    bundle, _ = view._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in bundle and "<script" not in bundle["text/html"]


@pytest.mark.parametrize("time", [-0.1, 1e9, float("nan")])
def test_times_outside_of_the_plan_are_refused(time: float) -> None:
    with pytest.raises(rg.ArgumentError, match="`time`"):
        rg.plan("sphere", seed=1).view.time = time


def test_without_anywidget_the_page_begins_where_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def refusing(name: str, *rest):
        if name == "anywidget":
            raise ImportError(name)
        return real(name, *rest)

    rg._view._widget_class.cache_clear()
    monkeypatch.setattr(builtins, "__import__", refusing)
    view = rg.plan("sphere", seed=0).view
    rg._view._widget_class.cache_clear()
    assert not view.is_live
    view.time = 1.3
    html = view._repr_mimebundle_()["text/html"]
    assert "window.regrasp.seek(1.3)" in html.replace("&quot;", '"') and "window.regrasp.play" in html
    assert view.time == 1.3 and not view.playing


def test_a_notebook_that_is_not_trusted_still_has_facts(plan: rg.Plan) -> None:
    html = plan._repr_html_()
    words = html[html.index("</iframe>") :]
    assert "<table>" in words and "transfers" in words and "certified clearance" in words
    assert "<script" not in words and "style" not in words


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

#: The widget's module with a model as Jupyter has it; what the page shows after each step is written down.
HARNESS = """<!doctype html><body><div id="el"></div><p id="said"></p><script type="module">
import widget from "./_view.js";
const listeners = {}, state = { page: await (await fetch("./plan.html")).text(), time: 1.3, playing: false };
const model = {
    get: (name) => state[name],
    set(name, value) { if (state[name] !== value) { state[name] = value; (listeners["change:" + name] ?? []).forEach((f) => f()); } },
    save_changes() {},
    on(name, f) { (listeners[name] ??= []).push(f); },
    off() {},
};
widget.render({ model, el: document.getElementById("el") });
const page = () => document.querySelector("iframe").contentWindow.regrasp;
const until = async (done) => { for (let i = 0; i < 300 && !done(); i++) await new Promise((r) => setTimeout(r, 50)); };
const said = [];
await until(() => page()?.time === 1.3);
said.push("first " + page()?.time);
model.set("time", 0.5);
said.push("led " + page().time);
page().seek(0.8);
await until(() => state.time === 0.8);
said.push("followed " + state.time);
model.set("playing", true);
await until(() => state.time > 0.9);
said.push("played " + (state.time > 0.9));
document.getElementById("said").textContent = said.join("; ");
await fetch("./done?" + encodeURIComponent(said.join("; ")));
</script>"""


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium to show it in")
def test_the_widget_leads_the_page_in_a_browser(tmp_path) -> None:
    import http.server
    import threading
    import urllib.parse

    (tmp_path / "plan.html").write_text(rg.plan("sphere", seed=0).page())
    shutil.copy(Path(rg.__file__).with_name("_view.js"), tmp_path)
    (tmp_path / "index.html").write_text(HARNESS)
    said: list[str] = []
    done = threading.Event()

    class Handler(http.server.SimpleHTTPRequestHandler):
        def __init__(self, *rest) -> None:
            super().__init__(*rest, directory=str(tmp_path))

        def do_GET(self) -> None:
            if self.path.startswith("/done?"):
                said.append(urllib.parse.unquote(self.path.partition("?")[2]))
                done.set()
            super().do_GET()

        def log_message(self, *rest) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    assert CHROMIUM is not None
    options = [
        "--headless",
        "--no-sandbox",
        "--enable-unsafe-swiftshader",
        f"--user-data-dir={tmp_path / 'user'}",
    ]
    address = f"http://127.0.0.1:{server.server_port}/index.html"
    browser = subprocess.Popen(
        [CHROMIUM, *options, "--remote-debugging-port=0", address],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        assert done.wait(150), "the page said nothing"
    finally:
        browser.kill()
        browser.wait()
        server.shutdown()
    assert said == ["first 1.3; led 0.5; followed 0.8; played true"]
