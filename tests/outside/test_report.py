"""report.html in a real browser: drawn, filtered, on a phone, in the dark, printed."""

import pytest
from study_fixture import HOSTILE, SEEDS, VARIANTS, runs, study  # noqa: F401


@pytest.fixture
def report(study, visit):  # noqa: F811
    """Opens the report: `report(width=…, color_scheme=…)`."""
    return lambda **options: visit(study / "report.html", **options)


def texts(page, selector):
    return [text.strip() for text in page.locator(selector).all_inner_texts()]


def brightness(page, selector, of):
    """0 to 255: the mean of red, green and blue of a colour of an element."""
    color = page.eval_on_selector(selector, f"node => getComputedStyle(node).{of}")
    channels = [float(part) for part in color[color.index("(") + 1 : -1].split(",")[:3]]
    return sum(channels) / 3


def test_nothing_is_asked_for_and_nothing_complained_of(report, study):  # noqa: F811
    opened = report()
    opened.page.wait_for_timeout(200)
    assert opened.complaints == []
    assert opened.foreign_requests(study / "report.html") == []


def test_every_chart_shows_every_variant(report, keep_picture):
    page = report().page
    assert page.locator(".card").count() == 2
    assert page.locator(".curve").count() == 2 * VARIANTS
    assert page.locator(".chart:not(.further) .box").count() == 2 * VARIANTS
    assert page.locator(".further").count() >= 2 * 6, "every other measure has boxes"
    assert page.locator(".bar").count() == 2 * VARIANTS
    assert page.locator(".bar [data-role=stability-test]").count() == 2 * VARIANTS
    assert page.locator(".rejections tbody tr").count() == 2 * VARIANTS
    # Three pairs with the first, two effects of factors and their interaction, each in every measure.
    assert page.locator(".matrix tbody tr").count() == 2 * (VARIANTS - 1 + 2 + 1)
    measures = texts(page, ".card:first-of-type .matrix thead th")[1:]
    assert {"solved", "planning", "verification", "memory", "regrasps", "motion", "margin", "clearance"} <= set(measures)
    assert page.locator(".winners tbody td").count() == 2 * VARIANTS
    assert page.locator(".winners td.best").count() == 2
    assert page.locator(".strip svg").count() == 2
    assert page.locator(".strip .rg-tip, .strip .rg-free").count() == 2 * 4 * 4, "four fingers at four moments"
    assert "The paper remarks" in page.locator("#remark").inner_text()
    keep_picture(page, "report.png")


def test_figures_are_those_of_the_table(report, runs):  # noqa: F811
    page = report().page
    first = page.locator(".card").first
    variant = runs[0]["variant"]
    mine = [run for run in runs if run["scenario"] == "sphere" and run["variant"] == variant]
    solved = [run for run in mine if run["status"] == "solved" and run["verified"] == "true"]
    row = first.locator(".plain tbody tr").first
    assert row.locator("td").first.inner_text() == f"{len(solved)}/{SEEDS}"
    assert "17.5 s" in first.locator(".paper").inner_text()
    # A curve ends at the share of the solved runs.
    end = first.locator(".curve title").first.text_content()
    assert end == f"{variant}: {100 * len(solved) // SEEDS} % solved"


def test_no_sentence_contradicts_the_matrix(report):
    page = report().page
    verdicts = {"same": "the same within", "not shown": "no difference shown", "too few": "too few seeds"}
    for card in page.locator(".card").all():
        measures = [text.strip() for text in card.locator(".matrix thead th").all_inner_texts()][1:]
        lines = [text.strip() for text in card.locator(".finding li").all_inner_texts()]
        rows = card.locator(".matrix tbody tr").all()
        assert len(lines) == len(rows)
        for line, row in zip(lines, rows, strict=True):
            assert line.startswith(row.locator("th").inner_text().strip() + ": ")
            parts = line.rstrip(".").split("; ")
            for measure, cell in zip(measures, row.locator("td").all(), strict=True):
                text = cell.inner_text().strip()
                said = [part for part in parts if measure in part.split(": ")[-1].split(", ") or f": {measure} " in part or part.startswith(f"{measure} ")]
                assert len(said) == 1, (measure, line)
                if text in verdicts:
                    assert verdicts[text] in said[0], (measure, text, line)
                else:
                    assert not any(verdict in said[0] for verdict in verdicts.values()), (measure, text, line)


def test_names_of_users_are_only_text(report):
    page = report().page
    assert texts(page, ".card h2") == ["sphere", HOSTILE]
    assert page.locator("img").count() == 0


def test_filters_hide_levels_and_scenarios(report):
    page = report().page
    lazy = page.get_by_role("button", name="lazy")
    lazy.click()
    assert lazy.get_attribute("aria-pressed") == "false"
    assert page.locator(".curve").count() == 2 * VARIANTS // 2
    assert not any("lazy" in text for text in texts(page, ".winners tbody th"))
    page.get_by_role("button", name="sphere").click()
    assert texts(page, ".card h2") == [HOSTILE]
    # The last one that is left cannot be hidden: an empty page would say nothing.
    page.get_by_role("button", name="<img").click()
    assert page.locator(".card").count() == 1
    lazy.click()
    assert page.locator(".curve").count() == VARIANTS


def test_a_phone_needs_no_sideways_scrolling(report, keep_picture):
    page = report(width=390, height=844, device_scale_factor=2).page
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    # Charts are drawn for this width, not shrunk: their letters stay as large as they are.
    assert page.eval_on_selector(".chart svg", "node => node.getBoundingClientRect().width / node.viewBox.baseVal.width") > 0.95
    keep_picture(page, "report-phone.png")
    page.set_viewport_size({"width": 320, "height": 640})
    page.wait_for_timeout(100)
    assert page.evaluate("document.documentElement.scrollWidth") == 320


def test_the_dark_is_dark(report, keep_picture):
    light, dark = report().page, report(color_scheme="dark").page
    assert brightness(light, "html", "backgroundColor") > 230 and brightness(light, "body", "color") < 90
    assert brightness(dark, "html", "backgroundColor") < 60 and brightness(dark, "body", "color") > 180
    assert brightness(dark, ".rg-tip", "fill") > 180, "pictures, too"
    keep_picture(dark, "report-dark.png")


def test_it_prints(report, pictures):
    page = report(color_scheme="dark").page
    page.emulate_media(media="print", color_scheme="dark")
    assert brightness(page, "html", "backgroundColor") > 230, "paper is white, whatever the screen is"
    assert not page.locator("#filters").is_visible()
    file = pictures / "report.pdf"
    page.pdf(path=file, format="A4", print_background=True)
    pages = file.read_bytes().count(b"/Type /Page\n") + file.read_bytes().count(b"/Type /Page ")
    assert pages >= 3, "an overview and a page for each scenario"
