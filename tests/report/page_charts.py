"""Charts of runs as plotly.js stores them, compared with figures.json, whose values tests/figures compares with run.h5: values, bands,
labels, logarithmic axes."""
import numpy as np

LOG_AXES = {"top_force": "xy", "scaling": "xy", "how_far": "y"}
# Label of a point with x, y and its standard error e.
LABELS = {"top_force": ("{x:.2f} mm, {phase}ing\n{y:.4g} N", " ± {e:.2g} N"), "scaling": ("{x:.4g} mN m\n{y:.4g} N", " ± {e:.2g} N"),
          "force_distribution": ("{x:.4g} mN\n{y:.3g} per mN", " ± {e:.2g}"),
          "coordination": ("{x:.2f} mm, {phase}ing\nZ = {y:.3f}", " ± {e:.2g}")}


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


def check_band(band, x, y, error, what):
    """Forward along mean + standard error, back along mean - standard error; at most two thirds below the mean."""
    assert band["fill"] == "toself" and band["hoverinfo"] == "skip", what
    low = np.where(y > 0, np.maximum(y - error, y / 3), y - error)
    expect_close(band["x"], np.append(x, x[::-1]), f"{what}: band along x")
    expect_close(band["y"], np.append(y + error, low[::-1]), f"{what}: band")


def check_labels(reader, chart, number, name, label, points):
    """At all points; both roundings of a number half-way between two are right."""
    for point, values in enumerate(points):
        shown, words = reader.hover(chart, number, point)
        either = [label.format(**dict(zip("xye", values * (1 + shift)))) for shift in (-1e-9, 1e-9)]
        assert any(same_words(words, one) for one in either), (chart, name, point, words, either)
        assert shown == name, (chart, shown, name)


def check_curve(reader, chart, traces, series, name, curve):
    """Takes the curve from the front of the traces, and its band if errors are known."""
    x, y, error = (np.array(curve[key], float) for key in ("x", "y", "standard_error"))
    what, has_errors, is_points = f"{chart}, {name}, {curve['phase']}", np.isfinite(error).all(), series["is_reference"] or chart == "scaling"
    if has_errors and not is_points:
        check_band(traces.pop(0)[1], x, y, error, what)
    number, trace = traces.pop(0)
    assert not trace["fill"] and plain(trace["name"]) == name, (what, trace["name"])
    expect_close(trace["x"], x, f"{what}: x")
    expect_close(trace["y"], y, f"{what}: y")
    assert trace["mode"] == ("markers" if is_points else "lines+markers"), what
    loads = curve["phase"] == "load" or chart == "force_distribution"
    if is_points:
        assert trace["marker"]["symbol"] == ("circle" if loads else "circle-open"), what
    else:
        assert trace["line"]["dash"] == ("solid" if loads else "dash"), what
    if has_errors:
        expect_close(trace["error_y"]["array"] if is_points else trace["customdata"], error, f"{what}: standard errors")
    label, of_error = LABELS[chart]
    check_labels(reader, chart, number, name, (label + of_error * has_errors).replace("{phase}", curve["phase"]), np.array([x, y, error]).T)


def check_chart(reader, chart, values):
    """All traces in order: curves, and for the scaling law a line from a thousandth of the largest product to the largest."""
    traces = list(enumerate(reader.traces(chart)))
    for series in values["series"]:
        name = series["words"] + (f", {series['remark']}" if series["remark"] and chart == "coordination" else "")
        for curve in series["curves"]:
            check_curve(reader, chart, traces, series, name, curve)
        if "slope" in series:
            number, line = traces.pop(0)
            ends = max(max(curve["x"]) for curve in series["curves"]) * np.array([1e-3, 1])
            expect_close([line["x"], line["y"]], [ends, series["slope"] * ends], f"{chart}, {name}: line", 1e-5)
            words = reader.hover(chart, number, 1)[1]
            assert same_words(words, f"slope {series['slope'] * 1e3:.4g} /m"), words
    assert traces == [], (chart, "more than expected", traces)


def check_run_charts(reader, figures):
    for chart in LABELS:
        check_chart(reader, chart, figures[chart])
    title = reader.element("figure:has(#force_distribution) h3").text
    assert title == f"Contact forces at {figures['force_distribution']['displacement_mm']:.1f} mm, unloading", title
    assert [kind for kind, _ in reader.axes("force_distribution")] == ["linear", "log"]


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
