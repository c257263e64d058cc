"""The page of `regrasp view` and of `plan --view-graph`, in a browser: it plays, it is exact, it is quick, and it asks nobody for anything."""

import copy
import json
import math
import os
import re
import subprocess
from pathlib import Path

import pytest
from pages import quiet, ready

# A modest window: what a browser draws in software, without a graphics processor, must still look like motion.
MODEST = {"width": 640, "height": 480}


@pytest.fixture(scope="module")
def folder(tmp_path_factory, regrasp):
    """A plan with obstacle, its page, and a page with the graph of the search."""
    folder = tmp_path_factory.mktemp("view")
    regrasp("plan", "ellip-obst", "-o", "plan.json", cwd=folder)
    told = regrasp("view", "plan.json", cwd=folder)
    assert "plan.html" in told
    regrasp("plan", "cubic", "--seed", "3", "-o", "graph.json", "--view-graph", cwd=folder)
    return folder


@pytest.fixture(scope="module")
def plan(folder):
    return json.loads((folder / "plan.json").read_text())


def canvas_colors(page):
    """How many different colours a fresh picture of the scene has."""
    return page.evaluate(
        """() => {
            const { stage } = regrasp.app;
            stage.stale = true;
            stage.render();
            const small = document.createElement("canvas");
            [small.width, small.height] = [160, 120];
            const context = small.getContext("2d");
            context.drawImage(document.getElementById("canvas"), 0, 0, 160, 120);
            const { data } = context.getImageData(0, 0, 160, 120);
            const colors = new Set();
            for (let i = 0; i < data.length; i += 4) colors.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
            return colors.size;
        }"""
    )


def test_the_page_loads_in_peace_and_shows_something(folder, visit, keep_picture):
    page = folder / "plan.html"
    seen = ready(visit, page, height=760)
    assert canvas_colors(seen.page) > 200
    assert seen.page.title().startswith("ellip-obst")
    # This picture, with fewer colours, is the README's.
    seen.page.evaluate("regrasp.seek(0.97 * regrasp.app.motion.end)")
    seen.page.wait_for_timeout(400)  # until colours that change have changed
    keep_picture(seen.page, "view.png")
    quiet(seen, page)


def test_play_advances_and_stops_at_the_end(folder, visit):
    seen = ready(visit, folder / "plan.html")
    page = seen.page
    before = page.evaluate("regrasp.at(regrasp.time).joints")
    page.get_by_role("button", name="Play", exact=True).click()
    page.wait_for_function("regrasp.time > 0.3")
    assert page.evaluate("regrasp.playing")
    assert page.evaluate("regrasp.at(regrasp.time).joints") != before
    page.get_by_role("button", name="Pause").click()
    stopped = page.evaluate("regrasp.time")
    page.wait_for_timeout(200)
    assert page.evaluate("regrasp.time") == stopped
    page.evaluate("regrasp.seek(regrasp.app.motion.end - 0.05)")
    page.evaluate("regrasp.play()")
    page.wait_for_function("!regrasp.playing")
    assert page.evaluate("regrasp.time === regrasp.app.motion.end")
    quiet(seen, folder / "plan.html")


def test_the_keyboard_drives_it(folder, plan, visit):
    page = ready(visit, folder / "plan.html").page
    starts = [segment["states"][0]["time"] for segment in plan["segments"]]
    page.keyboard.press("End")
    assert page.evaluate("regrasp.time === regrasp.app.motion.end")
    page.keyboard.press("Home")
    assert page.evaluate("regrasp.time") == 0
    page.keyboard.press("ArrowRight")
    assert page.evaluate("regrasp.time") == pytest.approx(starts[1], abs=1e-6)
    page.keyboard.press("ArrowLeft")
    page.keyboard.press(".")
    assert page.evaluate("regrasp.time") == pytest.approx(plan["segments"][0]["states"][1]["time"], abs=1e-6)
    page.keyboard.press(" ")
    page.wait_for_function("regrasp.playing")
    page.keyboard.press(" ")
    page.wait_for_function("!regrasp.playing")
    page.keyboard.press("+")
    assert page.locator("#speed").input_value() == "2"
    page.keyboard.press("f")
    assert page.get_by_role("checkbox", name="Friction cones").is_checked()
    page.keyboard.press("?")
    assert page.get_by_role("dialog").is_visible()
    page.keyboard.press("Escape")
    assert not page.get_by_role("dialog").is_visible()


def test_segments_can_be_chosen_and_follow_the_play_head(folder, plan, visit):
    page = ready(visit, folder / "plan.html").page
    entries = page.locator("#segment-list button")
    assert entries.count() == len(plan["segments"])
    fingers = plan["scenario"]["problem"]["hand"]["finger"]
    for entry, segment in zip(entries.all_inner_texts(), plan["segments"]):
        name = "Transfer" if segment["kind"] == "transfer" else f"Regrasp: {fingers[segment['finger']]['name']}"
        assert name in entry
    entries.nth(2).click()
    assert page.evaluate("regrasp.time") == pytest.approx(plan["segments"][2]["states"][0]["time"], abs=1e-6)
    assert entries.nth(2).get_attribute("aria-current") == "true"
    page.keyboard.press("End")
    assert entries.nth(2).get_attribute("aria-current") is None
    assert entries.last.get_attribute("aria-current") == "true"


def test_curves_have_the_play_head_and_take_clicks(folder, visit):
    page = ready(visit, folder / "plan.html").page
    plots = page.locator(".curve:visible")
    assert plots.count() == 3
    box = plots.nth(1).locator(".area").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + 20)
    half = page.evaluate("regrasp.app.motion.end") / 2
    assert page.evaluate("regrasp.time") == pytest.approx(half, rel=0.02)
    assert "mm" in page.locator(".reading").nth(1).inner_text()
    data = page.evaluate("regrasp.data.curves")
    assert min(data["clearance"]) > 0 and min(data["margin"]) > 0


# Independent kinematics: rotations as matrices, from the plan file alone.
def matrix(axis, angle):
    length = math.hypot(*axis)
    x, y, z = (a / length for a in axis)
    c, s = math.cos(angle), math.sin(angle)
    return [
        [c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
        [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
        [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)],
    ]


IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def described(pose):
    """A pose of the hand file: position and rotation."""
    rotation = IDENTITY
    if pose.get("axis"):
        rotation = matrix(pose["axis"], math.radians(pose["angle_deg"]))
    elif pose.get("orientation"):
        w, *v = pose["orientation"]
        rotation = matrix(v, 2 * math.atan2(math.hypot(*v), w)) if math.hypot(*v) else IDENTITY
    return rotation, pose.get("position", [0, 0, 0])


def times(a, b):
    (R, p), (S, q) = a, b
    product = [[sum(R[i][k] * S[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return product, [p[i] + sum(R[i][k] * q[k] for k in range(3)) for i in range(3)]


def tip(finger, joints):
    frame = described(finger["base"])
    for joint, q in zip(finger["joint"], joints):
        frame = times(frame, described(joint.get("origin", {})))
        frame = times(frame, (matrix(joint["axis"], q), [0, 0, 0]))
    return times(frame, (IDENTITY, finger["tip"]))[1]


def test_the_page_means_what_the_plan_means(folder, plan, visit):
    """At states and between them: joints and position straight, orientation by slerp, fingertips by the hand's own kinematics."""
    page = ready(visit, folder / "plan.html").page
    assert page.evaluate("regrasp.disagreement") < 1e-6, "the program's own fingertips"
    fingers = plan["scenario"]["problem"]["hand"]["finger"]
    for segment in plan["segments"]:
        for k in range(0, len(segment["states"]) - 1, 9):
            a, b = segment["states"][k], segment["states"][k + 1]
            for s in (0.25, 0.8):
                time = a["time"] + s * (b["time"] - a["time"])
                seen = page.evaluate("time => { const { object, tips } = regrasp.at(time); return { object, tips }; }", time)
                # The page's times are rounded to a microsecond: fractions differ by that over the step.
                slack = 1e-6 + 2e-6 / (b["time"] - a["time"]) * 2e-3
                for finger, found, q0, q1 in zip(fingers, seen["tips"], a["joints"], b["joints"]):
                    expected = tip(finger, [x + s * (y - x) for x, y in zip(q0, q1)])
                    assert math.dist(expected, found) < slack
                for x, y, found in zip(a["object"]["position"], b["object"]["position"], seen["object"]["p"]):
                    assert found == pytest.approx(x + s * (y - x), abs=slack)
                expected = slerp(a["object"]["orientation"], b["object"]["orientation"], s)
                assert abs(sum(x * y for x, y in zip(expected, seen["object"]["q"]))) > 1 - 1e-8


def slerp(a, b, s):
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-x for x in b], -cosine
    angle = math.acos(min(cosine, 1))
    if angle < 1e-9:
        return a
    return [(math.sin((1 - s) * angle) * x + math.sin(s * angle) * y) / math.sin(angle) for x, y in zip(a, b)]


def test_contacts_lie_where_fingertip_and_object_meet(folder, visit):
    page = ready(visit, folder / "plan.html").page
    worst = page.evaluate(
        """() => {
            const { motion } = regrasp.app;
            const turn = (q, v) => { // v + 2 w (u × v) + 2 u × (u × v)
                const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                const u = q.slice(1), t = cross(u, v).map((x) => 2 * x), w = cross(u, t);
                return v.map((x, i) => x + q[0] * t[i] + w[i]);
            };
            let worst = 0;
            for (let k = 0; k <= 50; k++) {
                const seen = motion.at((motion.end * k) / 50);
                seen.contacts.forEach((contact, f) => {
                    if (!contact) return;
                    const onObject = turn(seen.object.q, contact.point).map((x, i) => x + seen.object.p[i]);
                    const onTip = turn(seen.links[f].at(-1).q, contact.onTip).map((x, i) => x + seen.tips[f][i]);
                    worst = Math.max(worst, Math.hypot(...onObject.map((x, i) => x - onTip[i])));
                });
            }
            return worst;
        }"""
    )
    assert 0 < worst < 1e-4, "closure, and what a straight line between two states leaves of it"


def test_dark_and_light(folder, visit, keep_picture):
    backgrounds = {}
    for scheme in ("light", "dark"):
        seen = ready(visit, folder / "plan.html", color_scheme=scheme)
        backgrounds[scheme] = seen.page.evaluate("getComputedStyle(document.body).backgroundColor")
        keep_picture(seen.page, f"view-{scheme}.png")
    assert backgrounds["light"] != backgrounds["dark"]
    seen.page.get_by_role("button", name="Switch to light").click()
    assert seen.page.evaluate("getComputedStyle(document.body).backgroundColor") == backgrounds["light"]


def test_a_telephone_shows_it_all(folder, visit, keep_picture):
    seen = ready(visit, folder / "plan.html", width=390, height=780)
    page = seen.page
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "nothing sticks out at the side"
    for selector in ("#canvas", "#play", "#scrub", "#segment-list"):
        assert page.locator(selector).is_visible()
    keep_picture(page, "view-phone.png")


def test_everything_that_can_be_used_has_a_name(folder, visit):
    page = ready(visit, folder / "graph.html").page
    nameless = page.evaluate(
        """() => [...document.querySelectorAll("button, input, select, canvas, [role=img], [role=tab], [role=button]")]
            .filter((e) => !(e.getAttribute("aria-label") || e.textContent.trim() || e.closest("label")?.textContent.trim()))
            .map((e) => e.outerHTML)"""
    )
    assert nameless == []


def test_the_graph_has_its_tab(folder, visit, keep_picture):
    path = folder / "graph.html"
    seen = ready(visit, path)
    page = seen.page
    page.get_by_role("tab", name="Graph").click()
    graph = page.evaluate("regrasp.data.graph")
    nodes = page.locator(".node")
    assert nodes.count() == len(graph["components"]) > 4
    fates = {edge["fate"] for edge in graph["edges"]}
    assert "used" in fates
    assert page.locator(".edges.used path").count() > 0
    inside = [edge for edge in graph["edges"] if edge["kind"] == "grasp" and edge["fate"] != "failed"]
    for edge in inside:
        assert graph["grasp_components"][edge["from"]] == graph["grasp_components"][edge["to"]]
    assert f"alone in {len(set(graph['grasp_components']))} component" in page.locator("#graph .summary").inner_text()
    box = page.get_by_role("checkbox", name="transfers and regrasps")
    drawn = page.locator("path.transfer-regrasp:not(.off)")
    assert drawn.count() > 0
    box.uncheck()
    assert drawn.count() == 0
    page.get_by_role("combobox", name="Placed by").select_option(label="its orientation, SO(3)")
    assert nodes.count() == len(graph["components"]) and drawn.count() == 0, "drawn anew, and still hidden"
    box.check()
    assert drawn.count() > 0
    before = page.evaluate("regrasp.app.actors[0].body.position.toArray()")
    nodes.nth(2).dispatch_event("click")
    assert "Grasp 3" in page.locator(".node-details").inner_text()
    assert page.evaluate("regrasp.app.actors[0].body.position.toArray()") != before or len(set(map(str, graph["states"]["object"]))) < 8
    keep_picture(page, "view-graph.png")
    page.keyboard.press("Home")
    assert "Point at a grasp" in page.locator(".node-details").inner_text()
    quiet(seen, path)
    plain = ready(visit, folder / "plan.html")
    assert plain.page.get_by_role("tab", name="Graph").count() == 0


def test_a_search_without_a_plan_shows_its_graph(tmp_path, regrasp, visit):
    slippery = re.sub(r"(?m)^friction = .*", "friction = 0.35", regrasp("scenarios", "cubic"))
    (tmp_path / "slippery.toml").write_text(slippery)
    words = [os.environ["REGRASP"], "plan", tmp_path / "slippery.toml", "--max-nodes", "3", "--view-graph"]
    words += ["--set", "graph-strategy.relays=0"]
    # Without a display there is no browser: the program says where the page is.
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")} | {"TMPDIR": str(tmp_path)}
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    assert done.returncode == 3
    (page,) = tmp_path.glob("regrasp-view-*/plan.html")
    assert f"open the page in a browser: {page}" in done.stderr
    seen = ready(visit, page)
    assert seen.page.locator(".node").count() > 0
    quiet(seen, page)


def test_plan_opens_the_page_where_there_is_a_browser(tmp_path):
    opener = tmp_path / "bin" / "xdg-open"
    opener.parent.mkdir()
    opener.write_text(f'#!/bin/sh\necho "$1" > "{tmp_path}/opened"\n')
    opener.chmod(0o755)
    environment = os.environ | {"DISPLAY": ":7", "PATH": f"{opener.parent}:{os.environ['PATH']}"}
    words = [os.environ["REGRASP"], "plan", "sphere", "-o", "plan.json", "--view", "--json"]
    done = subprocess.run(words, capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout), "standard output is the report's alone"
    assert (tmp_path / "opened").read_text().strip() == "plan.html"
    assert "the page is opened: plan.html" in done.stderr


def test_names_cannot_do_harm(folder, plan, tmp_path, regrasp, visit):
    bad = '</script><script>window.harm = 1</script><img src=x onerror="window.harm = 2">'
    plan = copy.deepcopy(plan)
    plan["scenario"]["name"] = bad
    plan["scenario"]["problem"]["hand"]["finger"][0]["name"] = bad
    plan["scenario"]["problem"]["object"]["name"] = bad
    (tmp_path / "bad.json").write_text(json.dumps(plan))
    regrasp("view", "bad.json", cwd=tmp_path)
    seen = ready(visit, tmp_path / "bad.html")
    assert seen.page.evaluate("window.harm") is None
    assert bad in seen.page.locator("h1").inner_text()
    quiet(seen, tmp_path / "bad.html")


def test_bad_plans_are_refused_with_the_reason(folder, plan, tmp_path):
    def view(content, *words):
        (tmp_path / "bad.json").write_text(content)
        done = subprocess.run([os.environ["REGRASP"], "view", "bad.json", *words], capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 2 and "panicked" not in done.stderr, done.stderr
        assert not (tmp_path / "bad.html").exists()
        return done.stderr

    damaged = copy.deepcopy(plan)
    damaged["segments"][1]["states"][3]["joints"][0].pop()
    assert "segment 2, state 4" in view(json.dumps(damaged))
    assert "bad.json" in view("{")
    assert "is an input" in view(json.dumps(plan), "-o", "bad.json")
    assert "none" in view(json.dumps(plan), "-o", "none/page.html")
    (tmp_path / "replay.json").write_text('{"format": "x"}')
    assert "regrasp replay" in view(json.dumps(plan), "--replay", "replay.json")


def test_a_plan_that_does_not_verify_is_shown_with_what_is_wrong(folder, plan, tmp_path, regrasp, visit):
    plan = copy.deepcopy(plan)
    plan["segments"][0]["states"][2]["object"]["position"][2] += 0.004
    (tmp_path / "wrong.json").write_text(json.dumps(plan))
    regrasp("view", "wrong.json", cwd=tmp_path)
    page = ready(visit, tmp_path / "wrong.html").page
    assert "does not verify" in page.locator("#headline").inner_text()
    page.get_by_role("tab", name="Plan").click()
    failed = page.locator("tr.failed")
    assert "closure" in " ".join(failed.all_inner_texts())
    failed.filter(has_text="closure").get_by_role("button").first.click()
    assert page.evaluate("regrasp.time") > 0


def test_a_simulated_object_goes_beside_the_plan(folder, regrasp, visit, keep_picture):
    told = subprocess.run([os.environ["REGRASP"], "replay", "plan.json", "-o", "replay.json"], capture_output=True, text=True, cwd=folder)
    assert told.returncode in (0, 4), told.stderr
    regrasp("view", "plan.json", "--replay", "replay.json", "-o", "replay.html", cwd=folder)
    seen = ready(visit, folder / "replay.html")
    page = seen.page
    assert page.get_by_role("checkbox", name="Simulated object").is_checked()
    page.evaluate("regrasp.seek(0.5)")
    apart = page.evaluate("regrasp.app.actors[0].ghost.position.distanceTo(regrasp.app.actors[0].body.position)")
    assert 0 < apart < 0.02, "near the planned object, but not the same"
    keep_picture(page, "view-replay.png")
    quiet(seen, folder / "replay.html")


def test_large_meshes_are_drawn_with_fewer_facets_and_say_so(folder, plan, tmp_path, regrasp, visit):
    plan = copy.deepcopy(plan)
    plan["scenario"]["problem"]["object"]["shape"]["facets"] = 100_000
    (tmp_path / "large.json").write_text(json.dumps(plan))
    regrasp("view", "large.json", cwd=tmp_path)
    assert (tmp_path / "large.html").stat().st_size < 5e6
    seen = ready(visit, tmp_path / "large.html")
    count, drawn = seen.page.evaluate("[regrasp.data.object.count, regrasp.data.object.facets.length / 3]")
    assert count > 50_000 and 10_000 < drawn <= 40_000
    seen.page.get_by_role("tab", name="Plan").click()
    assert f"{count} facets (drawn with {drawn})" in seen.page.locator("#facts").inner_text()
    assert canvas_colors(seen.page) > 200
    quiet(seen, tmp_path / "large.html")


def test_a_picture_at_rest_is_drawn_with_more_care_than_one_that_moves(folder, visit):
    """In software: shadows, and four samples for each pixel, once nothing has changed for a moment."""
    page = ready(visit, folder / "plan.html", **MODEST).page
    width = "document.getElementById('canvas').width"
    page.wait_for_function(f"{width} === 2 * document.getElementById('canvas').clientWidth")
    page.evaluate("regrasp.play()")
    page.wait_for_function(f"{width} === document.getElementById('canvas').clientWidth")
    page.evaluate("regrasp.pause()")
    page.wait_for_function(f"{width} === 2 * document.getElementById('canvas').clientWidth")


def test_without_3d_the_rest_of_the_page_works(folder, browser):
    context = browser.new_context()
    context.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page = context.new_page()
    page.goto((folder / "graph.html").resolve().as_uri())
    page.wait_for_function("document.body.dataset.ready === 'true'")
    assert "WebGL" in page.locator("#problem").inner_text()
    page.evaluate("regrasp.play()")
    page.wait_for_function("regrasp.time > 0.1")
    page.get_by_role("tab", name="Graph").click()
    assert page.locator(".node").count() > 4
    context.close()


def finer(plan, wanted):
    """The same motion with at least so many states: each step is halved until there are enough."""
    plan = copy.deepcopy(plan)

    def halfway(a, b):
        if isinstance(a, list):
            return [halfway(x, y) for x, y in zip(a, b)]
        if isinstance(a, dict):
            return {key: halfway(a[key], b[key]) for key in a} if b else None
        return a if b is None or a is None or isinstance(a, str) else (a + b) / 2

    while sum(len(segment["states"]) for segment in plan["segments"]) < wanted:
        for segment in plan["segments"]:
            states = segment["states"]
            between = [halfway(a, b) for a, b in zip(states, states[1:])]
            segment["states"] = [state for pair in zip(states, between) for state in pair] + [states[-1]]
    return plan


def browser_seconds():
    """Processor time (s) of everything that this process started: the browser with the part of it that draws."""
    parents, spent = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue  # It has ended meanwhile.
        parents[int(stat.parent.name)] = int(fields[1])
        spent[int(stat.parent.name)] = int(fields[11]) + int(fields[12])

    def ours(process):
        while process in parents:
            process = parents[process]
            if process == os.getpid():
                return True
        return False

    return sum(ticks for process, ticks in spent.items() if ours(process)) / os.sysconf("SC_CLK_TCK")


def opening(visit, page):
    """Processor time (s) until the page is ready, the least of three: whatever else the machine does only adds. And the page, at rest."""
    costs, waits = [], []
    for _ in range(3):
        before = browser_seconds()
        seen = ready(visit, page, **MODEST)
        waits.append(seen.page.evaluate("regrasp.readyMs"))
        costs.append(browser_seconds() - before)
    print(f"\n{page.name}: {page.stat().st_size / 1e6:.1f} MB, ready in {min(waits):.0f} ms, {1000 * min(costs):.0f} of processor time")
    return min(costs), seen


def frame(seen):
    """Processor time (s) of a frame while the page plays slowly."""
    seen.page.evaluate("regrasp.app.player.setSpeed(0.25)")
    seen.page.evaluate("regrasp.play()")
    seen.page.evaluate(
        "window.drawn = 0; (function next() { window.drawn++; if (regrasp.playing) requestAnimationFrame(next); })()"
    )
    seen.page.wait_for_timeout(1000)
    begin, spent = seen.page.evaluate("window.drawn"), browser_seconds()
    seen.page.wait_for_timeout(4000)
    assert seen.page.evaluate("regrasp.playing")
    frames = seen.page.evaluate("window.drawn") - begin
    cost = (browser_seconds() - spent) / frames
    seen.page.evaluate("regrasp.pause()")
    width, height = MODEST.values()
    print(f"at {width} x {height} {frames / 4:.0f} frames a second, {1000 * cost:.0f} ms of processor time each")
    return cost


def test_six_times_the_states_open_and_play_as_quickly(folder, plan, tmp_path, regrasp, visit):
    """Beside a short plan on the same machine, since a limit in seconds would tell machines apart, not pages."""
    states = sum(len(segment["states"]) for segment in plan["segments"])
    assert states > 500
    (tmp_path / "long.json").write_text(json.dumps(finer(plan, 6 * states)))
    regrasp("view", "long.json", cwd=tmp_path)
    page = tmp_path / "long.html"
    assert page.stat().st_size < 6e6
    short_opening, short = opening(visit, folder / "plan.html")
    long_opening, long = opening(visit, page)
    # Reading the file costs six times as much, the rest does not.
    assert long_opening < 3 * short_opening
    # A page that walks through all states for each frame costs six times as much.
    assert frame(long) < 2 * frame(short)
    quiet(long, page)
