"""Charts of a diagnosis compared with its figures.json, and the experiment's forces with its own table."""
import numpy as np

from report import page_truth as truth
from report.page_charts import expect_close, same_words


def check_label(reader, chart, number, point, expected):
    words = reader.hover(chart, number, point)[1]
    assert same_words(words, expected), (chart, words, expected)


def check_where_and_which(reader, figures):
    for trace, panel in zip((trace for trace in reader.traces("where") if trace["z"]), figures["where"]["panels"], strict=True):
        expect_close(sorted(z for row in trace["z"] for z in row if z is not None), sorted(cell["z_score"] for cell in panel["cells"]), "z")
    expect_close(reader.traces("which")[0]["x"], [row["gain"] for row in figures["which"]["rows"]], "gains")


def check_forces(reader, forces, experiment):
    """Three curves; that of the experiment is also as in its own table."""
    traces = reader.traces("how_far")
    assert [trace["name"] for trace in traces] == [forces["words_before"], forces["words_after"], "experiment"]
    for number, key in enumerate(("before", "after", "experiment")):
        expect_close(traces[number]["x"], forces["x"], f"how far, {key}: x")
        expect_close(traces[number]["y"], forces[key], f"how far, {key}")
        check_label(reader, "how_far", number, len(forces["x"]) - 1, f"{forces['x'][-1]:.2f} mm\n{forces[key][-1]:.4g} N")
    measured = truth.recording_of_experiment(experiment)
    loading = measured.phase == 0
    expect_close(traces[2]["y"], np.interp(traces[2]["x"], measured.displacement_mm[loading], measured.top_force[loading]),
                 "the experiment's forces", 1e-5)


def check_gaps(reader, values):
    bars, = reader.traces("gap_left")
    left = [bar["gap_left"] for bar in values["bars"]]
    expect_close(bars["x"], left, "gaps that are left")
    for bar, value, above, below in zip(values["bars"], left, bars["error_x"]["array"], bars["error_x"]["arrayminus"], strict=True):
        low, high = bar.get("interval", (None, None))
        assert (above is None) == (high is None), bar
        if high is not None:
            expect_close([below, above], [value - low, high - value], "interval")
    for point, value in enumerate(left):
        check_label(reader, "gap_left", 0, point, f"{value:.1f} %")


def check_diagnosis_charts(reader, figures, experiment):
    check_where_and_which(reader, figures)
    if "how_far" not in figures:
        assert not reader.elements("#how_far, #gap_left"), "nothing tells how far"
        return
    check_forces(reader, figures["how_far"]["forces"], experiment)
    check_gaps(reader, figures["how_far"])
