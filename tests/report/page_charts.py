"""Charts of runs and diagnoses as plotly.js stores them, compared with the data: values, bands, labels, logarithmic
axes."""
import dataclasses
import re

import numpy as np

from report import page_truth as truth

LOG_AXES = {"top_force": "xy", "scaling": "xy", "how_far": "y"}


@dataclasses.dataclass
class Drawn:
    """An expected curve. `label`: format of the hover text with x, y and e."""
    name: str
    curve: truth.Curve
    label: str
    points: bool = False
    dash: str | None = None
    symbol: str | None = None

    @property
    def has_errors(self):
        return bool(np.isfinite(self.curve.error).all())

    def words(self, point):
        """Both roundings of a number half-way between two."""
        label = self.label if self.has_errors else re.sub(r" ± \{e\S*( N)?", "", self.label)
        exact = np.array([self.curve.x[point], self.curve.y[point], self.curve.error[point]])
        return [label.format(**dict(zip("xye", exact * (1 + shift)))) for shift in (-1e-9, 1e-9)]


def expect_close(found, expected, what, relative=1e-6):
    np.testing.assert_allclose(np.array(found, float), expected, rtol=relative, atol=1e-12, err_msg=what)


def same_words(found, expected):
    """Accepts both ways of writing numbers."""
    def value(word):
        try:
            return float(word.replace("\u2212", "-"))
        except ValueError:
            return word
    return [value(word) for word in found.split()] == [value(word) for word in expected.split()]


def plain(words):
    return words.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")


def check_band(band, drawn, what):
    """A band: forward along mean + standard error, back along mean - standard error; at most two thirds below the
    mean."""
    c = drawn.curve
    assert band["fill"] == "toself" and band["hoverinfo"] == "skip", what
    low = np.where(c.y > 0, np.maximum(c.y - c.error, c.y / 3), c.y - c.error)
    expect_close(band["x"], np.append(c.x, c.x[::-1]), f"{what}: band along x")
    expect_close(band["y"], np.append(c.y + c.error, low[::-1]), f"{what}: band")


def check_curve(trace, drawn, what):
    c = drawn.curve
    assert not trace["fill"] and plain(trace["name"]) == drawn.name, (what, trace["name"], drawn.name)
    expect_close(trace["x"], c.x, f"{what}: x")
    expect_close(trace["y"], c.y, f"{what}: y")
    assert trace["mode"] == ("markers" if drawn.points else "lines+markers"), what
    if drawn.dash:
        assert trace["line"]["dash"] == drawn.dash, what
    if drawn.symbol:
        assert trace["marker"]["symbol"] == drawn.symbol, what
    if drawn.has_errors:
        expect_close(trace["customdata"], c.error, f"{what}: standard errors")
    if drawn.has_errors and drawn.points:
        expect_close(trace["error_y"]["array"], c.error, f"{what}: bars")


def check_labels(reader, chart, number, drawn):
    """Checks the labels at all points, and that there is one for each."""
    for point in range(len(drawn.curve.x)):
        name, words = reader.hover(chart, number, point)
        expected = drawn.words(point)
        assert any(same_words(words, either) for either in expected), (chart, drawn.name, point, words, expected)
        assert name == drawn.name, (chart, name, drawn.name)


def check_chart(reader, chart, expected):
    """All traces of a chart in order, a band before its line."""
    traces = list(enumerate(reader.traces(chart)))
    for drawn in expected:
        what = f"{chart}, {drawn.name}, {drawn.label}"
        if drawn.has_errors and not drawn.points:
            check_band(traces.pop(0)[1], drawn, what)
        number, trace = traces.pop(0)
        check_curve(trace, drawn, what)
        check_labels(reader, chart, number, drawn)
    assert traces == [], (chart, "more than expected", traces)


def both_phases(name, recordings, quantity, label, points):
    for phase, words, dash, symbol in ((0, "loading", "solid", "circle"), (1, "unloading", "dash", "circle-open")):
        yield Drawn(name, truth.curve(recordings, quantity, phase), "{x:.2f} mm, " + words + "\n" + label, points,
                    None if points else dash, symbol if points else None)


def check_top_force(reader, settings, references):
    expected = []
    for sources, points in ((settings, False), (references, True)):
        for name, recordings in sources.items():
            expected += both_phases(name, recordings, lambda r: r.top_force, "{y:.4g} N ± {e:.2g} N", points)
    check_chart(reader, "top_force", expected)


def check_distribution(reader, settings, references, displacement_mm):
    curves = truth.distributions({**settings, **references}, displacement_mm)
    check_chart(reader, "force_distribution",
                [Drawn(name, c, "{x:.4g} mN\n{y:.3g} per mN ± {e:.2g}", points=name in references)
                 for name, c in curves.items()])
    nearest = next(iter(settings.values()))
    reached = nearest[0].displacement_mm[truth.scan_nearest(nearest, displacement_mm)]
    title = reader.element("figure:has(#force_distribution) h3").text
    assert title == f"Contact forces at {reached:.1f} mm, unloading", title
    assert [kind for kind, _ in reader.axes("force_distribution")] == ["linear", "log"]


def check_coordination(reader, settings, references, thresholds):
    """`thresholds` [N] by setting; for a reference all contacts count."""
    expected = []
    for name, recordings in settings.items():
        tau = thresholds.get(name, 0)
        shown = f"{name}, tau {tau * 1e3:.2f} mN" if thresholds else name
        expected += both_phases(shown, recordings, lambda r, tau=tau: truth.contacts_per_grain(r, tau),
                                "Z = {y:.3f} ± {e:.2g}", False)
    for name, recordings in references.items():
        expected += both_phases(name, recordings, lambda r: truth.contacts_per_grain(r, 0),
                                "Z = {y:.3f} ± {e:.2g}", True)
    check_chart(reader, "coordination", expected)


def scaling_line(name, curves):
    """A line through zero, from a thousandth of the largest product to the largest."""
    slope, end = truth.slope_through_zero(curves), max(c.x.max() for c in curves)
    x = np.array([end / 1000, end])
    return name, x, slope * 1e-3 * x, f"slope {slope:.4g} /m"


def check_scaling(reader, settings):
    """Three traces per setting: loading, unloading, fitted line."""
    traces = reader.traces("scaling")
    assert len(traces) == 3 * len(settings), "experiments do not tell the packing fraction"
    for place, (name, recordings) in enumerate(settings.items()):
        curves = [truth.scaling_curve(recordings, phase) for phase in (0, 1)]
        for phase, c in enumerate(curves):
            drawn = Drawn(name, c, "{x:.4g} mN m\n{y:.4g} N ± {e:.2g} N", True, None, ("circle", "circle-open")[phase])
            check_curve(traces[3 * place + phase], drawn, f"scaling, {name}, {truth.PHASES[phase]}")
            check_labels(reader, "scaling", 3 * place + phase, drawn)
        _, x, y, label = scaling_line(name, curves)
        expect_close(traces[3 * place + 2]["x"], x, f"scaling, {name}: line")
        expect_close(traces[3 * place + 2]["y"], y, f"scaling, {name}: line", 1e-5)
        words = reader.hover("scaling", 3 * place + 2, 1)[1]
        assert same_words(words, label), (words, label)


def check_run_charts(reader, settings, references, displacement_mm, thresholds):
    check_top_force(reader, settings, references)
    check_distribution(reader, settings, references, displacement_mm)
    check_coordination(reader, settings, references, thresholds)
    check_scaling(reader, settings)


def press(reader, chart):
    button = reader.element(f"button[data-log={chart}]")
    before = button.get_attribute("aria-pressed")
    reader.click(button)
    assert {before, button.get_attribute("aria-pressed")} == {"true", "false"}, chart


def check_log_button(reader, chart, axes):
    """Switches to logarithmic axes, checks that they contain all positive values, and switches back."""
    before, traces = reader.axes(chart), reader.traces(chart)
    press(reader, chart)
    after = reader.axes(chart)
    for axis, (kind, shown), (kind_before, _) in zip("xy", after, before):
        assert kind == ("log" if axis in axes else kind_before) and kind_before != "log", (chart, axis, kind)
        values = np.array([v for trace in traces for v in trace[axis] if v and v > 0])
        if axis in axes:
            low, high = shown + np.array([-1e-9, 1e-9])
            assert low <= np.log10(values.min()) and high >= np.log10(values.max()), (chart, axis, shown)
    assert reader.traces(chart) == traces, f"{chart}: other values on logarithmic axes"
    reader.picture(f"log_{chart}.png", f"figure:has(#{chart})")
    press(reader, chart)
    assert reader.axes(chart) == before, chart


def check_log_buttons(reader):
    charts = [button.get_attribute("data-log") for button in reader.elements("button[data-log]")]
    assert charts == [chart for chart in LOG_AXES if reader.elements(f"#{chart}")] and "scaling" in charts, charts
    for chart in charts:
        check_log_button(reader, chart, LOG_AXES[chart])
