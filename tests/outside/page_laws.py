"""What every page must keep, whatever it shows: nothing is cut off, texts can be read, plots have axes, units and limits."""

# Texts that are seen: each with its place in the window and the element that it stands in.
TEXTS = """
    const texts = () => {
        const found = [];
        const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
        while (walker.nextNode()) {
            const node = walker.currentNode, element = node.parentElement;
            if (!node.textContent.trim() || element.closest("script, style, noscript, .unseen, legend, option")) continue;
            if (!element.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
            const range = document.createRange();
            range.selectNodeContents(node);
            const box = range.getBoundingClientRect();
            if (box.width > 0 && box.height > 0) found.push({ text: node.textContent.trim(), element, box });
        }
        return found;
    };
"""

# Texts and controls that stick out of the window at its sides, or out of what clips them.
CUT = (
    "() => {"
    + TEXTS
    + """
    const bad = [];
    const controls = [...document.querySelectorAll("button, input, select, canvas")].filter((e) => e.checkVisibility());
    const all = [...texts(), ...controls.map((element) => ({ text: element.outerHTML.slice(0, 60), element, box: element.getBoundingClientRect() }))];
    for (const { text, element, box } of all) {
        if (box.left < -1 || box.right > innerWidth + 1) bad.push(`${text}: ${box.left} to ${box.right} of ${innerWidth}`);
        for (let e = element; e && e !== document.documentElement; e = e.parentElement) {
            const { overflowX, overflowY } = getComputedStyle(e);
            const around = e.getBoundingClientRect();
            if (overflowX !== "visible" && (box.left < around.left - 1 || box.right > around.right + 1)) bad.push(`${text}: cut at the side by ${e.id || e.className || e.tagName}`);
            // A list may be scrolled up and down.
            if (["hidden", "clip"].includes(overflowY) && (box.top < around.top - 1 || box.bottom > around.bottom + 1)) bad.push(`${text}: cut by ${e.id || e.className}`);
        }
    }
    if (document.documentElement.scrollWidth > innerWidth) bad.push("the page is wider than the window");
    return bad;
}"""
)

# Texts whose colour is too like what is behind them (WCAG 2.2, 1.4.3: 4.5, or 3 where large).
CONTRAST = (
    "() => {"
    + TEXTS
    + """
    const parse = (color) => {
        const numbers = color.match(/[\\d.e-]+/g).map(Number);
        const scale = color.startsWith("color(") ? 1 : 1 / 255;
        return [...numbers.slice(0, 3).map((x) => x * scale), numbers[3] ?? 1];
    };
    const over = (top, below) => [0, 1, 2].map((i) => top[i] * top[3] + below[i] * (1 - top[3])).concat(1);
    const stage = () => parse(getComputedStyle(document.getElementById("stage")).backgroundColor);
    const behind = (element) => {
        const layers = [];
        for (let e = element; e; e = e.parentElement) layers.push(parse(getComputedStyle(e).backgroundColor));
        return layers.reverse().reduce((below, top) => over(top, below), [1, 1, 1, 1]);
    };
    const light = (color) => {
        const [r, g, b] = color.map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const bad = [];
    for (const { text, element } of texts()) {
        if (element.closest(":disabled")) continue;
        const style = getComputedStyle(element);
        const background = behind(element);
        const color = over(parse(element instanceof SVGElement ? style.fill : style.color), background);
        const [a, b] = [light(color), light(background)].sort((x, y) => y - x);
        const size = parseFloat(style.fontSize);
        const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
        const ratio = (a + 0.05) / (b + 0.05);
        if (ratio < (large ? 3 : 4.5)) bad.push(`${text}: ${ratio.toFixed(2)}`);
    }
    return bad;
}"""
)

# Each plot that is seen: its name, its ticks along both axes, the unit in its title, its limit's words, its summary.
PLOTS = """() => [...document.querySelectorAll(".curve")].filter((e) => e.checkVisibility()).map((e) => {
    const words = (selector) => [...e.querySelectorAll(selector)].map((t) => t.textContent);
    const place = (line) => Number(line.getAttribute("y1"));
    return {
        title: e.querySelector(".curve-title span").textContent,
        rows: words(".axis-y text"),
        columns: words(".axis-x text"),
        limits: words(".limit-label"),
        limit_heights: [...e.querySelectorAll("line.limit")].map(place),
        curves: e.querySelectorAll("path.line").length,
        summary: e.querySelector(".plot").getAttribute("aria-label"),
        height: e.querySelector("svg").clientHeight,
    };
})"""


def keeps_the_laws(page):
    """Nothing is cut, and everything can be read."""
    assert page.evaluate(CUT) == []
    assert page.evaluate(CONTRAST) == []


def show_all_plots(page):
    """Shows the plots that are not shown at first."""
    hidden = page.locator(".chip[aria-pressed=false]")
    while hidden.count():
        hidden.first.click()
    page.wait_for_function("[...document.querySelectorAll('.curve')].every((curve) => curve.querySelector('path.line'))")
