"""Pages of hands and objects (`regrasp hand FILE --view`, `regrasp object FILE --view`) in a browser."""

import json
import math
import os
import random
import subprocess

import pytest
from page_laws import keeps_the_laws
from pages import ready

WINDOWS = [(1280, 800), (390, 844)]
MULTIPLIER, OFFSET = 0.6, 0.1


def finger(name, angle):
    """Four joints, the last one driven by the one before."""
    c, s = math.cos(angle), math.sin(angle)
    joints = [("abduction", f"{c} {s} 0", -0.5, 0.5), ("proximal", f"{-s} {c} 0", -1.0, 1.2), ("middle", f"{-s} {c} 0", 0.1, 1.4), ("distal", f"{-s} {c} 0", 0.1, 1.0)]
    before, text = "palm", ""
    for number, (joint, axis, low, high) in enumerate(joints):
        at = f"{0.04 * c} {0.04 * s} 0.01" if number == 0 else "0 0 0.001" if number == 1 else "0 0 0.045"
        mimic = f'<mimic joint="{name}-middle" multiplier="{MULTIPLIER}" offset="{OFFSET}"/>' if joint == "distal" else ""
        shape = '<collision><origin xyz="0 0 0.02"/><geometry><cylinder radius="0.007" length="0.03"/></geometry></collision>' if number else ""
        text += f"""
  <link name="{name}-{joint}-link">{shape}</link>
  <joint name="{name}-{joint}" type="revolute"><parent link="{before}"/><child link="{name}-{joint}-link"/><origin xyz="{at}"/>
    <axis xyz="{axis}"/><limit lower="{low}" upper="{high}" velocity="4" effort="1"/>{mimic}</joint>"""
        before = f"{name}-{joint}-link"
    return text + f"""
  <link name="{name}-tip"><collision><geometry><sphere radius="0.009"/></geometry></collision></link>
  <joint name="{name}-end" type="fixed"><parent link="{before}"/><child link="{name}-tip"/><origin xyz="0 0 0.04"/></joint>"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory, regrasp):
    """A hand of four fingers with driven joints; a rough ball; their pages."""
    folder = tmp_path_factory.mktemp("models")
    fingers = "".join(finger(name, k * math.pi / 2) for k, name in enumerate(("east", "north", "west", "south")))
    palm = '<link name="palm"><collision><geometry><box size="0.1 0.1 0.01"/></geometry></collision></link>'
    (folder / "hand.urdf").write_text(f'<robot name="mine">{palm}{fingers}\n</robot>')
    regrasp("plan", "sphere", "-o", "plan.json", cwd=folder)
    (folder / "scan.obj").write_text(scan(json.loads((folder / "plan.json").read_text())))
    regrasp("hand", "hand.urdf", "--page", "hand.html", cwd=folder)
    regrasp("object", "scan.obj", "--page", "scan.html", cwd=folder)
    return folder


def scan(plan):
    """The plan's ball as a scanner gives it: four times the facets, every vertex a little off."""
    surface = plan["object"]["surface"]
    vertices, facets, middles = [tuple(v) for v in surface["vertices"]], [], {}
    radius = math.hypot(*vertices[0])

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            p = [x + y for x, y in zip(vertices[a], vertices[b])]
            vertices.append(tuple(x * radius / math.hypot(*p) for x in p))
            middles[key] = len(vertices) - 1
        return middles[key]

    for a, b, c in surface["facets"]:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        facets += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    noise = random.Random(5)
    text = "".join("v {:.9f} {:.9f} {:.9f}\n".format(*(x + noise.gauss(0, 8e-5) for x in vertex)) for vertex in vertices)
    return text + "".join("f {} {} {}\n".format(*(k + 1 for k in facet)) for facet in facets)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", WINDOWS)
def test_nothing_is_cut_and_all_can_be_read(folder, visit, keep_picture, size, scheme):
    for name in ("hand", "scan"):
        path = folder / f"{name}.html"
        seen = ready(visit, path, width=size[0], height=size[1], color_scheme=scheme)
        for tab in seen.page.get_by_role("tab").all():
            tab.click()
            keeps_the_laws(seen.page)
        keep_picture(seen.page, f"model-{name}-{size[0]}-{scheme}.png")
        assert seen.complaints == [] and seen.foreign_requests(path) == []
        assert path.stat().st_size < 2.5e6


def test_a_slider_for_each_joint_moves_it_within_its_limits(folder, visit):
    page = ready(visit, folder / "hand.html").page
    assert page.evaluate("regrasp.disagreement") < 1e-6, "the program's own fingertips"
    sliders = page.locator("#move input[type=range]")
    assert sliders.count() == 16
    slider = page.get_by_role("slider", name="east-tip: east-proximal")
    assert [float(slider.get_attribute(end)) for end in ("min", "max")] == [-1.0, 1.2]
    before = page.evaluate("regrasp.app.tips")
    slider.focus()
    page.keyboard.press("ArrowRight")
    after = page.evaluate("regrasp.app.tips")
    assert after[0] != before[0] and after[1:] == before[1:]
    for _ in range(12):
        page.keyboard.press("PageUp")
    assert page.evaluate("regrasp.app.joints[1]") == 1.2, "no farther than its end"
    ends = slider.locator("xpath=..").locator(".ends span").all_inner_texts()
    assert ends == ["-57.3°", "68.8°"]


def test_driven_joints_follow(folder, visit):
    page = ready(visit, folder / "hand.html").page
    sliders = page.locator("#move input[type=range]")
    assert sliders.nth(3).is_disabled()
    sliders.nth(2).focus()
    for _ in range(5):
        page.keyboard.press("ArrowUp")
        middle, distal = page.evaluate("[regrasp.app.joints[2], regrasp.app.joints[3]]")
        assert distal == pytest.approx(MULTIPLIER * middle + OFFSET, abs=1e-12)
    assert "driven by" in page.locator(".joint-name").nth(3).inner_text()


def test_the_reach_is_the_reports(folder, regrasp, visit):
    page = ready(visit, folder / "hand.html").page
    told = json.loads(regrasp("hand", "hand.urdf", "--json", cwd=folder))
    boxes = page.evaluate(
        """() => regrasp.app.samples.map((samples) => [0, 1, 2].map((i) => {
            const all = samples.map(({ tip }) => tip[i]);
            return [Math.min(...all), Math.max(...all)];
        }))"""
    )
    for finger, box in zip(told["fingers"], boxes):
        for k, (low, high) in enumerate(box):
            assert low == pytest.approx(finger["reach"]["lower"][k], abs=6e-3)
            assert high == pytest.approx(finger["reach"]["upper"][k], abs=6e-3)
    page.get_by_role("checkbox", name="Reach").uncheck()
    assert page.evaluate("regrasp.app.clouds.map((cloud) => cloud.visible)") == [False] * 4


def test_the_place_of_a_ball_is_shown_with_how_good_it_is(folder, regrasp, visit):
    page = ready(visit, folder / "hand.html").page
    place = json.loads(regrasp("hand", "hand.urdf", "--json", cwd=folder))["object_place"]
    shown = page.evaluate("regrasp.app.stage.layers.ball[0].position.toArray()")
    assert shown == pytest.approx(place["position"])
    page.get_by_role("tab", name="Hand").click()
    assert f"quality {place['quality']:.2f} of 1" in page.locator(".quality").inner_text()
    page.get_by_role("tab", name="Joints").click()
    page.get_by_role("button", name="At the ball").click()
    reach = place["ball_radius"] + page.evaluate("regrasp.data.hand.tip_radius")
    off = [abs(math.dist(tip, place["position"]) - reach) for tip in page.evaluate("regrasp.app.tips")]
    assert max(off) < 3e-3


def test_names_lists_and_notes_are_there(folder, visit):
    page = ready(visit, folder / "hand.html").page
    names = page.locator(".finger legend").all_inner_texts()
    assert len(names) == 4 and len(set(names)) == 4
    assert page.evaluate("regrasp.app.words.length") == 4
    page.get_by_role("tab", name="Notes").click()
    headings = page.locator("#notes h2").all_inner_texts()
    assert "collision shapes" in headings
    assert page.locator("#notes li").count() >= 10


def test_an_object_shows_how_far_its_contact_surface_is(folder, regrasp, visit, keep_picture):
    page = ready(visit, folder / "scan.html", width=1280, height=800).page
    twin = json.loads(regrasp("object", "scan.obj", "--json", cwd=folder))["contact_surface"]
    assert twin is not None
    assert page.evaluate("regrasp.data.twin.count") == twin["facets"]
    shown = lambda: page.evaluate("['mesh', 'colored', 'twin'].map((part) => regrasp.app[part].visible)")
    assert shown() == [False, True, False]
    legend = page.locator(".scale")
    assert "mm" in legend.locator("figcaption").inner_text()
    most = page.evaluate("Math.max(...[...regrasp.data.twin.heights, ...regrasp.data.twin.of_mesh].map(Math.abs))")
    ticks = legend.locator(".ticks").first.locator("span").all_inner_texts()
    assert float(ticks[-1]) == pytest.approx(1000 * most, rel=0.06) and float(ticks[0]) == -float(ticks[-1]) and ticks[2] == "0"
    # The colours of the ends are those of the legend's bar.
    assert page.evaluate("[regrasp.colorOf(-1), regrasp.colorOf(0), regrasp.colorOf(1)]") == ["2166ac", "f2f2f2", "b2182b"]
    keep_picture(page, "view-object.png")
    for label, visible in (("The mesh as it is", [True, False, False]), ("The contact surface, coloured", [False, False, True]), ("Both", [True, False, True])):
        page.get_by_role("radio", name=label).check()
        assert shown() == visible


def test_the_facts_are_those_that_are_printed(folder, regrasp, visit):
    page = ready(visit, folder / "scan.html").page
    printed = regrasp("object", "scan.obj", cwd=folder)
    page.get_by_role("tab", name="Object").click()
    for row in page.locator("#facts dd").all_inner_texts():
        assert row in printed


def test_view_opens_the_page_where_there_is_a_browser(folder, tmp_path):
    opener = tmp_path / "bin" / "xdg-open"
    opener.parent.mkdir()
    opener.write_text(f'#!/bin/sh\necho "$1" > "{tmp_path}/opened"\n')
    opener.chmod(0o755)
    environment = os.environ | {"DISPLAY": ":7", "PATH": f"{opener.parent}:{os.environ['PATH']}", "TMPDIR": str(tmp_path)}
    done = subprocess.run([os.environ["REGRASP"], "hand", "hand.urdf", "--view", "--json"], capture_output=True, text=True, env=environment, cwd=folder)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout), "standard output is the report's alone"
    opened = (tmp_path / "opened").read_text().strip()
    assert opened.endswith("page.html") and "the page is opened" in done.stderr
    assert "handpage.js" in open(opened).read()


def test_without_3d_the_rest_of_the_page_works(folder, browser):
    for name in ("hand", "scan"):
        context = browser.new_context()
        context.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
        page = context.new_page()
        page.goto((folder / f"{name}.html").resolve().as_uri())
        page.wait_for_function("document.body.dataset.ready === 'true'")
        assert "WebGL" in page.locator("#problem").inner_text()
        assert page.get_by_role("tab").count() >= 2
        context.close()
