"""A plan's page in a notebook, led from Python."""

from __future__ import annotations

import html
import math
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._errors import ArgumentError

if TYPE_CHECKING:
    from ._plan import Plan

#: Runs in the page where there is no widget: as soon as the page can, it goes to its time.
SEEK = """<script>
const waiting = setInterval(() => {{
    if (!window.regrasp) return;
    clearInterval(waiting);
    window.regrasp.seek({time});
    if ({playing}) window.regrasp.play();
}}, 50);
</script>
"""


class View:
    """The page that plays a plan, as the last line of a notebook's cell.

    With `anywidget` it is live: it shows the time that is set here, and what is done in it is seen here.
    Without, what is set here counts for pages that are shown from then on.
    """

    def __init__(self, plan: Plan) -> None:
        self._page, self._duration, self._facts = plan.page(), plan.duration, facts(plan)
        self._time, self._playing = 0.0, False
        kind = _widget_class()
        self._widget = None if kind is None else kind(page=self._page)

    @property
    def is_live(self) -> bool:
        """Whether pages that are shown follow this object: `anywidget` is installed."""
        return self._widget is not None

    @property
    def time(self) -> float:
        """The time that is shown (s), from 0 to the plan's duration; may be set."""
        return self._time if self._widget is None else float(self._widget.time)

    @time.setter
    def time(self, time: float) -> None:
        time = float(time)
        if not (math.isfinite(time) and 0 <= time <= self._duration):
            allowed = f"0..={self._duration:.6g} s"
            message = f"`time` = {time} is outside {allowed}"
            raise ArgumentError(message, key="time", value=str(time), range=allowed)
        self._time = time
        if self._widget is not None:
            self._widget.time = time

    @property
    def playing(self) -> bool:
        """Whether the motion runs."""
        return self._playing if self._widget is None else bool(self._widget.playing)

    def play(self) -> None:
        """Lets the motion run from :attr:`time` on."""
        self._set_playing(True)

    def pause(self) -> None:
        """Stops the motion where it is."""
        self._set_playing(False)

    def _set_playing(self, playing: bool) -> None:
        self._playing = playing
        if self._widget is not None:
            self._widget.playing = playing

    def _repr_html_(self) -> str:
        seek = SEEK.format(time=self.time, playing=str(self.playing).lower())
        return frame(self._page.replace("</body>", f"{seek}</body>"), self._facts)

    def _repr_mimebundle_(self, **options: Any) -> Any:
        static = {"text/plain": repr(self), "text/html": self._repr_html_()}
        if self._widget is None:
            return static
        # Where widgets do not run, such as in a notebook that is not trusted, facts remain.
        live = self._widget._repr_mimebundle_(**options)
        data, metadata = live if isinstance(live, tuple) else (live or {}, {})
        return data | {"text/plain": repr(self), "text/html": self._facts}, metadata

    def __repr__(self) -> str:
        return f"<View at {self.time:.2f} of {self._duration:.2f} s>"


def frame(page: str, words: str) -> str:
    """A page in a frame of its own, so that its style and scripts do not meet the notebook's.

    Notebooks that are not trusted leave the frame out; `words` stand below it in any case.
    """
    quoted = page.replace("&", "&amp;").replace('"', "&quot;")
    style = "width:100%;height:620px;border:0"
    return f'<iframe srcdoc="{quoted}" style="{style}" allow="fullscreen"></iframe>\n{words}'


def facts(plan: Plan) -> str:
    """What a plan is, as HTML without scripts and styles."""
    rows = {"plan": repr(plan).strip("<>")}
    certificate = plan.certificate or {}
    for key, name, unit in (
        ("closure_margin", "certified margin", ""),
        ("clearance", "certified clearance", " m"),
    ):
        if certificate.get(key):
            rows[name] = f"{certificate[key]['value']:.3g}{unit}"
    cells = (
        f"<tr><th>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>" for name, text in rows.items()
    )
    return f"<table>{''.join(cells)}</table>"


@cache
def _widget_class() -> Any:
    """The widget's class; None where `anywidget` is not installed."""
    try:
        import anywidget
        import traitlets
    except ImportError:
        return None

    class Page(anywidget.AnyWidget):  # type: ignore[misc, unused-ignore]
        _esm = Path(__file__).with_name("_view.js")
        page = traitlets.Unicode().tag(sync=True)
        time = traitlets.Float(0.0).tag(sync=True)
        playing = traitlets.Bool(False).tag(sync=True)

    return Page
