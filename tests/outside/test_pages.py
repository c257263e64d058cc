"""Pages in a browser: plots, the verifier's table, forces and frames, several plans in step, recordings, hands and objects."""

import io
import json
import math
import os
import struct
import subprocess
import zipfile

import pytest
from page_laws import PLOTS, keeps_the_laws, show_all_plots
from pages import quiet, ready

WINDOWS = [(1280, 800), (390, 844)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory, regrasp):
    """Two plans of one problem, one past an obstacle, one with the graph of its search; pages of each."""
    folder = tmp_path_factory.mktemp("pages")
    regrasp("plan", "ellip-obst", "-o", "plan.json", cwd=folder)
    regrasp("plan", "ellip-obst", "--seed", "2", "-o", "second.json", cwd=folder)
    regrasp("view", "plan.json", cwd=folder)
    told = regrasp("view", "plan.json", "second.json", "-o", "both.html", cwd=folder)
    assert "both.html" in told
    regrasp("plan", "cubic", "--seed", "3", "-o", "graph.json", "--view-graph", cwd=folder)
    return folder


@pytest.fixture(scope="module")
def plan(folder):
    return json.loads((folder / "plan.json").read_text())


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", WINDOWS)
def test_nothing_is_cut_and_all_can_be_read(folder, visit, keep_picture, size, scheme):
    width, height = size
    for name in ("plan", "both", "graph"):
        seen = ready(visit, folder / f"{name}.html", width=width, height=height, color_scheme=scheme)
        page = seen.page
        for tab in page.get_by_role("tab").all():
            tab.click()
            show_all_plots(page)
            keeps_the_laws(page)
        page.evaluate("regrasp.app.section.toggle()")
        keeps_the_laws(page)
        keep_picture(page, f"page-{name}-{width}-{scheme}.png")
        quiet(seen, folder / f"{name}.html")


@pytest.mark.parametrize("size", WINDOWS)
def test_every_plot_has_axes_unit_and_limit(folder, visit, size):
    page = ready(visit, folder / "plan.html", width=size[0], height=size[1]).page
    show_all_plots(page)
    plots = page.evaluate(PLOTS)
    assert [p["title"].split(" (")[0] for p in plots] == ["Closure margin", "Clearance", "Friction needed", "Effort", "Speed"]
    for plot in plots:
        assert plot["title"].endswith(")"), "the unit stands behind the name"
        assert len(plot["rows"]) >= 2 and len(plot["columns"]) >= 2
        assert all(text.endswith(" s") for text in plot["columns"])
        assert len(plot["limits"]) == 1 and any(c.isdigit() for c in plot["limits"][0])
        assert 0 <= plot["limit_heights"][0] <= plot["height"]
        assert plot["limits"][0] in plot["summary"]
    assert [p["curves"] for p in plots] == [1, 1, 4, 4, 4], "one for each finger"
    assert page.locator(".plot-legend").inner_text().split() >= ["regrasp"]


def test_the_plots_are_the_plans_figures(folder, plan, visit):
    """Friction, efforts and speeds against the certificate and the plan file."""
    page = ready(visit, folder / "plan.html").page
    worst = page.evaluate(
        """() => Object.fromEntries(regrasp.app.plots.charts.map((c, i) => [regrasp.app.plots.list[i].key, [c.least, c.most]]))"""
    )
    holds = plan["certificate"]["holds"]
    assert worst["friction"][1] == pytest.approx(holds["friction"]["value"], rel=0.01)
    assert worst["effort"][1] == pytest.approx(holds["effort"]["value"], abs=2e-3)
    # The certificate bounds all times, the plot shows the states.
    least = plan["certificate"]["clearance"]["value"]
    assert least <= worst["clearance"][0] < least + 2e-4
    fastest = next(c for c in page.evaluate("regrasp.data.verdict") if c["name"] == "velocities")["worst"]
    assert 0.9 * fastest < worst["speed"][1] <= fastest * 1.001
    # One state by hand: the largest share of tangential in normal force.
    segment = plan["segments"][2]
    state = segment["states"][0]
    for finger, (force, contact) in enumerate(zip(state["forces"], state["contacts"])):
        if not force or not contact:
            continue
        n = contact["normal_O"]
        pressing = -sum(f * x for f, x in zip(force, n))
        along = math.sqrt(max(sum(f * f for f in force) - pressing**2, 0))
        found = page.evaluate(
            "([t, f]) => { const s = regrasp.app.plots.list.find((p) => p.key === 'friction').sets[0].series[f]; return s.values[s.times.lastIndexOf(t)]; }",
            [round(state["time"], 6), finger],
        )
        assert found == pytest.approx(along / pressing, abs=2e-3)


def test_values_are_shown_under_the_pointer(folder, visit):
    page = ready(visit, folder / "plan.html").page
    plot = page.locator(".curve", has_text="Friction needed").locator(".plot")
    box = plot.bounding_box()
    page.mouse.move(box["x"] + box["width"] * 0.6, box["y"] + 30)
    tip = plot.locator(".tip")
    assert tip.is_visible()
    lines = tip.inner_text().split("\n")
    assert lines[0].endswith(" s") and len(lines) == 5
    page.mouse.move(5, 5)
    assert not tip.is_visible()


def test_joints_of_a_finger_have_their_own_curves(folder, visit):
    page = ready(visit, folder / "plan.html").page
    page.get_by_role("button", name="Effort").click()
    menu = page.get_by_role("combobox", name="Curves of Effort")
    menu.select_option(label="joints of east")
    joints = page.evaluate("regrasp.data.hand.fingers[0].joints.length")
    assert page.locator(".curve", has_text="Effort").locator("path.line").count() == joints


def test_what_is_far_above_its_limit_is_capped_and_said(folder, plan, tmp_path, regrasp, visit):
    """Forces that no friction of the problem holds."""
    plan = json.loads(json.dumps(plan))
    for segment in plan["segments"]:
        for state in segment["states"]:
            for finger, (force, contact) in enumerate(zip(state["forces"], state["contacts"])):
                if force and contact:
                    n = contact["normal_O"]
                    pressing = -sum(f * x for f, x in zip(force, n))
                    state["forces"][finger] = [f + 0.95 * pressing * x for f, x in zip(force, n)]
    (tmp_path / "slips.json").write_text(json.dumps(plan))
    regrasp("view", "slips.json", cwd=tmp_path)
    page = ready(visit, tmp_path / "slips.html").page
    note = page.locator(".curve", has_text="Friction needed").locator(".capped").last.inner_text()
    assert "drawn up to 2.4" in note and "largest" in note


def test_the_verifiers_table_sorts_and_leads_to_the_place(folder, plan, visit):
    page = ready(visit, folder / "plan.html", width=1280, height=800).page
    page.get_by_role("tab", name="Plan").click()
    names = lambda: page.locator("tbody[data-check]").evaluate_all("rows => rows.map((row) => row.dataset.check)")
    first = names()
    page.get_by_role("button", name="Check").click()
    assert names() == sorted(first)
    page.get_by_role("button", name="Check").click()
    assert names() == sorted(first, reverse=True)
    assert page.locator("th[aria-sort=descending]").count() == 1
    page.get_by_role("button", name="Worst").click()
    page.get_by_role("button", name="Worst").click()
    assert names()[0] in ("velocities", "accelerations"), "the plan is as quick as its limits allow"
    where = plan["certificate"]["clearance"]["where"]
    before = page.evaluate("regrasp.app.stage.camera.position.toArray()")
    page.locator("tbody[data-check=clearance] button").click()
    assert page.evaluate("regrasp.time") == pytest.approx(where["time"], abs=0.02)
    assert page.evaluate("regrasp.app.spotlight.marks.length") > 0
    assert page.evaluate("regrasp.app.stage.camera.position.toArray()") != before
    assert "clearance" in page.locator("#caption").inner_text()
    page.keyboard.press("Home")
    assert page.evaluate("regrasp.app.spotlight.marks.length") == 0
    assert "Segment 1 " in page.locator("#caption").inner_text()


def test_forces_are_arrows_that_end_at_the_contacts(folder, plan, visit):
    page = ready(visit, folder / "plan.html").page
    state = plan["segments"][3]["states"][2]
    page.evaluate("t => regrasp.seek(t)", state["time"])
    found = page.evaluate(
        """() => {
            const { forces } = regrasp.app.actors[0];
            return forces.group.children.map((arrow) => {
                if (!arrow.visible) return null;
                const length = -arrow.children[0].position.z / forces.perNewton;
                const w = arrow.quaternion, z = arrow.position.clone().set(0, 0, 1).applyQuaternion(w);
                return { at: arrow.position.toArray(), force: z.multiplyScalar(length).toArray() };
            });
        }"""
    )
    for arrow, force, contact in zip(found, state["forces"], state["contacts"]):
        assert (arrow is None) == (force is None or contact is None)
        if arrow:
            assert arrow["at"] == pytest.approx(contact["point_O"], abs=1e-6)
            assert arrow["force"] == pytest.approx(force, abs=0.02)
    page.get_by_role("checkbox", name="Forces").uncheck()
    assert not page.evaluate("regrasp.app.actors[0].forces.group.visible")


def test_cones_ends_and_frames_come_on_request(folder, visit):
    page = ready(visit, folder / "plan.html").page
    shown = lambda key: page.evaluate("key => regrasp.app.stage.layers[key].map((part) => part.visible)", key)
    for key, name, count in (("cones", "Friction cones", 1), ("ends", "Start and goals", 2), ("frames", "Hand frames", 5)):
        assert shown(key) == [False] * count
        page.get_by_role("checkbox", name=name).check()
        assert shown(key) == [True] * count
    start, goal = page.evaluate("regrasp.app.stage.layers.ends.map((part) => part.position.toArray())")
    assert start == pytest.approx(page.evaluate("regrasp.at(0).object.p"), abs=1e-9)
    assert goal == pytest.approx(page.evaluate("regrasp.data.goals[0].slice(0, 3)"), abs=1e-9)


def test_obstacles_and_goals_are_inside_the_first_view(folder, visit):
    for width, height in WINDOWS:
        page = ready(visit, folder / "plan.html", width=width, height=height).page
        worst = page.evaluate(
            """() => {
                const { stage, actors: [actor] } = regrasp.app;
                let worst = 0;
                stage.camera.updateMatrixWorld();
                for (const part of [...actor.obstacles, actor.skin, actor.hand.palm]) {
                    part.traverse((mesh) => {
                        const position = mesh.isMesh && mesh.geometry.getAttribute("position");
                        for (let i = 0; position && i < position.count; i++) {
                            const p = actor.body.position.clone().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld).project(stage.camera);
                            worst = Math.max(worst, Math.abs(p.x), Math.abs(p.y));
                        }
                    });
                }
                return worst;
            }"""
        )
        assert 0.3 < worst <= 1, f"{worst} of half the window"


def test_a_section_plane_cuts_what_is_solid(folder, visit):
    page = ready(visit, folder / "plan.html").page
    cut = "regrasp.app.actors[0].skin.material.clippingPlanes?.[0].constant ?? null"
    assert page.evaluate(cut) is None
    page.keyboard.press("x")
    middle = page.evaluate(cut)
    slider = page.get_by_role("slider", name="Place of the section")
    slider.focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate(cut) > middle
    assert "mm" in slider.get_attribute("aria-valuetext")
    page.get_by_role("checkbox", name="Section").uncheck()
    assert page.evaluate(cut) is None


def test_failed_edges_are_not_drawn_at_first(folder, visit):
    page = ready(visit, folder / "graph.html").page
    page.get_by_role("tab", name="Graph").click()
    box = page.get_by_role("checkbox", name="failed")
    if box.count():
        assert not box.is_checked() and not page.locator(".edges.failed").is_visible()
        box.check()
        assert page.locator(".edges.failed path").count() > 0
    assert page.locator(".edges.used").is_visible()


def test_two_plans_play_in_step(folder, visit, keep_picture):
    seen = ready(visit, folder / "both.html", width=1280, height=800)
    page = seen.page
    ends = page.evaluate("regrasp.app.shown.map(({ motion }) => motion.end)")
    assert ends[0] != ends[1] and page.evaluate("regrasp.app.player.end") == max(ends)
    data = page.evaluate("[regrasp.app.shown[0].data.hand.name, regrasp.app.shown[1].data.hand.name]")
    assert data[0] == data[1], "what both share is there for both"
    page.get_by_role("combobox", name="In step by").select_option(label="same share of the motion")
    page.evaluate("regrasp.seek(regrasp.app.player.end / 2)")
    apart = page.evaluate(
        """() => regrasp.app.actors.map((actor, i) => {
            const { motion } = regrasp.app.shown[i];
            const wanted = motion.at(motion.begin + motion.duration / 2).object.p;
            return Math.hypot(...wanted.map((x, k) => x - actor.body.position.toArray()[k]));
        })"""
    )
    assert max(apart) < 1e-9
    assert page.evaluate("regrasp.app.actors.map((actor) => actor.marked.visible)") == [True, False], "the other one is faint"
    page.get_by_role("combobox", name="Plans").select_option(label="side by side")
    assert page.locator("#pane-names span").all_inner_texts() == ["plan.json", "second.json"]
    keep_picture(page, "view-both.png")
    page.get_by_role("combobox", name="Plan", exact=True).select_option(label="second.json")
    assert page.evaluate("regrasp.data.seed") == 2
    assert page.locator("#segment-list button").count() == page.evaluate("regrasp.data.motion.segments.length")
    assert "seed 2" in page.locator("#headline").inner_text()
    quiet(seen, folder / "both.html")


def test_plans_that_cannot_be_shown_together_are_named(folder, plan, tmp_path):
    (tmp_path / "good.json").write_text(json.dumps(plan))
    damaged = json.loads(json.dumps(plan))
    damaged["segments"][1]["states"][3]["joints"][0].pop()
    (tmp_path / "bad.json").write_text(json.dumps(damaged))

    def view(*words):
        done = subprocess.run([os.environ["REGRASP"], "view", *words], capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 2 and "panicked" not in done.stderr, done.stderr
        return done.stderr

    assert "bad.json" in view("good.json", "bad.json") and not (tmp_path / "good.html").exists()
    assert "1 to 6" in view(*["good.json"] * 7)
    assert "is an input" in view("good.json", "bad.json", "-o", "bad.json")


def png_size(picture):
    assert picture[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", picture[16:24])


def test_frames_come_as_pictures_in_an_archive(folder, visit):
    page = ready(visit, folder / "plan.html", width=640, height=480).page
    page.get_by_role("button", name="Record").click()
    page.get_by_role("combobox", name="Frames a second").select_option("10")
    page.evaluate("regrasp.app.player.setSpeed(8)")
    with page.expect_download(timeout=120_000) as download:
        page.get_by_role("button", name="PNG frames").click()
    assert download.value.suggested_filename == "ellip-obst.zip"
    archive = zipfile.ZipFile(io.BytesIO(download.value.path().read_bytes()))
    assert archive.testzip() is None
    names = archive.namelist()
    end = page.evaluate("regrasp.app.player.end")
    assert names == [f"frame-{k:05}.png" for k in range(math.floor(end / 0.8) + 1)]
    pictures = [archive.read(name) for name in names]
    assert len({png_size(picture) for picture in pictures}) == 1 and min(png_size(pictures[0])) > 200
    assert len(set(pictures)) == len(pictures), "every frame is another one"


def test_a_film_is_recorded(folder, visit):
    page = ready(visit, folder / "plan.html", width=640, height=480).page
    page.get_by_role("button", name="Record").click()
    page.evaluate("regrasp.app.player.setSpeed(4)")
    with page.expect_download(timeout=120_000) as download:
        page.get_by_role("button", name="WebM film").click()
    film = download.value.path().read_bytes()
    assert download.value.suggested_filename == "ellip-obst.webm"
    assert film[:4] == b"\x1a\x45\xdf\xa3" and len(film) > 10_000


def test_the_view_turns_by_keys(folder, visit):
    page = ready(visit, folder / "plan.html").page
    camera = lambda: page.evaluate("regrasp.app.stage.camera.position.toArray()")
    first = camera()
    time = page.evaluate("regrasp.time")
    for keys in ("Shift+ArrowLeft", "Shift+ArrowUp", "PageUp"):
        before = camera()
        page.keyboard.press(keys)
        assert camera() != before
    assert page.evaluate("regrasp.time") == time
    page.keyboard.press("0")
    assert camera() == pytest.approx(first, abs=1e-9)


def test_the_keyboard_reaches_everything_in_sight(folder, visit):
    """Tab goes round all controls, each with a mark of focus."""
    page = ready(visit, folder / "plan.html", width=1280, height=800).page
    seen, last = set(), None
    for _ in range(80):
        page.keyboard.press("Tab")
        here = page.evaluate(
            """() => {
                const e = document.activeElement, style = getComputedStyle(e);
                if (e === document.body) return null;
                return [e.id || e.getAttribute("aria-label") || e.closest("label")?.textContent || e.textContent, style.outlineStyle, parseFloat(style.outlineWidth)];
            }"""
        )
        if here is None:
            break
        assert here[1] != "none" and here[2] >= 1, here
        seen.add(here[0].strip())
    assert {"play", "back", "on", "scrub", "speed", "theme", "help-button", "record-button", "Contacts", "Section", "Clearance"} <= seen


def test_reduced_motion_is_kept(folder, visit):
    page = ready(visit, folder / "plan.html", reduced_motion="reduce").page
    moving = page.evaluate("[...document.querySelectorAll('*')].filter((e) => getComputedStyle(e).transitionDuration !== '0s').length")
    assert moving == 0
    assert not page.evaluate("regrasp.playing"), "nothing moves until it is asked to"
