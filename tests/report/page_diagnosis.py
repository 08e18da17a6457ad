"""Charts of a diagnosis compared with diagnosis.json, and the experiment's forces with its own table."""
import numpy as np

from report import page_truth as truth
from report.page_charts import expect_close, same_words


def numbers(values):
    return np.array([np.nan if value is None else value for value in values], float)


def check_which_and_where(reader, diagnosis):
    expect_close(reader.traces("which")[0]["x"], [cause["score"] for cause in diagnosis["ranking"]], "scores")
    shown = [z for row in reader.traces("where")[0]["z"] for z in row if z is not None]
    expect_close(sorted(shown), sorted(cell["z_score"] for cell in diagnosis["cells"] if cell["z_score"] is not None),
                 "z scores")


def experiment_forces(folder):
    """Forces while loading, at displacements [mm]."""
    experiment = truth.recording_of_experiment(folder)
    loading = experiment.phase == 0
    return experiment.displacement_mm[loading], experiment.top_force[loading]


def check_forces(reader, shrink, experiment):
    """Three curves over the displacements at which all are known."""
    rows = numbers([list(row.values()) for row in shrink["top_force"]])
    assert list(shrink["top_force"][0]) == ["displacement_mm", "experiment_N", "before_N", "after_N"]
    rows = rows[np.isfinite(rows).all(axis=1)]
    assert len(rows) > 1
    traces = reader.traces("how_far")
    assert [trace["name"] for trace in traces][::2] == ["simulated before", "experiment"] and len(traces) == 3
    for number, column in enumerate((2, 3, 1)):
        expect_close(traces[number]["x"], rows[:, 0], "how far: x")
        expect_close(traces[number]["y"], rows[:, column], f"how far: {traces[number]['name']}")
        words = reader.hover("how_far", number, len(rows) - 1)[1]
        assert same_words(words, f"{rows[-1, 0]:.2f} mm\n{rows[-1, column]:.4g} N"), words
    displacement, force = experiment_forces(experiment)
    expect_close(traces[2]["y"], np.interp(traces[2]["x"], displacement, force), "the experiment's forces", 1e-5)


def gaps_left(shrink):
    """Values and ends of the intervals [%] of each bar."""
    after = [1 - shrink["fraction"], 1 - shrink["interval"][1], 1 - shrink["interval"][0]]
    bars = [[1, None, None], after]
    if shrink["confirmed"] is not None:
        bars.append([1 - shrink["confirmed"], None, None])
    return np.array([numbers(bar) for bar in [*bars, [1 - shrink["placebo"], None, None]]]) * 100


def check_gaps(reader, shrink):
    value, low, high = gaps_left(shrink).T
    bars, = reader.traces("gap_left")
    expect_close(bars["x"], value, "gaps that are left")
    expect_close(numbers(bars["error_x"]["array"]), high - value, "intervals above")
    expect_close(numbers(bars["error_x"]["arrayminus"]), value - low, "intervals below")
    names = reader.script("document.getElementById('gap_left').layout.yaxis.ticktext")
    assert [name.split(": ")[1] for name in names] == [f"{v + 0.0:.0f} %" for v in value], names
    for point, expected in enumerate(value):
        words = reader.hover("gap_left", 0, point)[1]
        assert same_words(words, f"{expected:.1f} %"), (words, expected)


def check_diagnosis_charts(reader, diagnosis, experiment):
    check_which_and_where(reader, diagnosis)
    if not diagnosis["shrink"]:
        assert not reader.elements("#how_far, #gap_left"), "nothing tells how far"
        return
    check_forces(reader, diagnosis["shrink"], experiment)
    check_gaps(reader, diagnosis["shrink"])
