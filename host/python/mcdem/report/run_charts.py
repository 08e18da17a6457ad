"""Charts of runs for a page, with titles and captions."""
from collections.abc import Sequence
from dataclasses import dataclass

from ..observe.replicas import Setting
from .charts import chart_figure
from .figure_data import FigureData, FigureOptions, figure_data
from .figure_values import RunFigure
from .page import Chart
from .run_figures import is_thresholded, run_figures

AXES = {"mean stress": "p: a third of the stress tensor's trace, compression positive.",
        "deviatoric stress": "q = √(3/2 s:s) of its deviator s.",
        "volume strain": "Volume strain: decrease of the volume over the initial volume.",
        "deviatoric strain": "Deviatoric strain: √(2/3 e:e), e the deviator of the logarithmic strain."}


@dataclass(frozen=True)
class RunCharts:
    """The charts that can be drawn; `notes` lists the others with reasons."""
    charts: list[Chart]
    notes: list[str]


def run_charts(settings: Sequence[Setting], reference: Setting | None, options: FigureOptions = FigureOptions()) -> RunCharts:
    data = figure_data(settings, reference, options)
    prepared = run_figures(data, options)
    return RunCharts([_chart(figure, data, options) for figure in prepared.figures],
                     [f"No chart of {missing}." for missing in prepared.missing])


def _bands(figure: RunFigure, what: str = "Bands") -> str:
    several = any(len(series.setting.replicas) > 1 for series in figure.series)
    return f" {what}: one standard error over replicas." if several else ""


def _phases(data: FigureData, figure: RunFigure) -> str:
    """Meaning of lines, points and bands."""
    points = " Points: the reference, filled: loading, open: unloading." if data.reference else ""
    return "Solid lines: loading, dashed: unloading." + points + _bands(figure, "Bands and bars")


def _chart(figure: RunFigure, data: FigureData, options: FigureOptions) -> Chart:
    """Title, caption and axes that can be made logarithmic."""
    log = ""
    if figure.name == "top_force":
        title, caption, log = "Force on the plate", _phases(data, figure), "xy"
    elif figure.name == "force_distribution":
        title = f"Contact forces at {figure.displacement:.1f} mm, {figure.series[0].curves[0].phase.name}ing"
        caption = "Probability density of the contact forces between grains, at one plate displacement." + _bands(figure)
    elif figure.name == "coordination":
        title = "Contacts per grain" + (", weak forces left out" if is_thresholded(data, options) else "")
        caption = _phases(data, figure)
    elif figure.name == "scaling":
        title, log = "Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩", "xy"
        caption = "Filled points: loading, open: unloading; lines through the origin are fitted to both."
    else:
        title, log = figure.title, "y" if figure.name == "pressure_strain" else ""
        axes = "".join(f" {words}" for quantity, words in AXES.items() if figure.x_label.startswith(quantity)
                       or figure.y_label.startswith(quantity))
        caption = "Scans in order of time." + axes + _bands(figure)
    return Chart(figure.name, title, caption, chart_figure(figure), log)
