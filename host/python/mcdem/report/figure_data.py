"""What the figures of runs are made of: settings and a reference with their levels, scans and comparisons."""
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from ..observe.compare import Comparison, compare
from ..observe.levels import Levels, group_levels
from ..observe.programmes import MeanScan, are_cells, follows_programme, mean_scans
from ..observe.replicas import Setting
from .labels import SeriesStyle, reference_style, shortened, styles_of, words_for

KEY_CHARACTERS = 44  # longer labels would leave no space for the curves


@dataclass(frozen=True)
class FigureOptions:
    """`touch_force` is that of compare(); `comparisons` of the settings with the reference are computed where they are missing."""
    touch_force: float | None = None
    comparisons: tuple[Comparison, ...] = ()
    distribution_displacement: float = 18e-3  # of the force distribution: the level nearest to this [m]
    threshold: float = 0  # for Z, if no reference determines tau [N]


@dataclass(frozen=True, eq=False)
class Series:
    """One setting, or the reference."""
    words: str  # its name in the legend
    style: SeriesStyle
    setting: Setting
    levels: Levels  # empty for programmes
    comparison: Comparison | None = None  # with the reference
    is_reference: bool = False

    @property
    def is_programme(self) -> bool:
        return follows_programme(self.setting.replicas)

    @cached_property
    def scans(self) -> list[MeanScan]:
        return mean_scans(self.setting.replicas)


@dataclass(frozen=True)
class FigureData:
    """The settings that have scans after their discarded cycles."""
    simulated: tuple[Series, ...]
    reference: Series | None
    options: FigureOptions

    @property
    def strokes(self) -> list[Series]:
        """The series with levels, the reference last."""
        everyone = (*self.simulated, self.reference) if self.reference else self.simulated
        return [series for series in everyone if not series.is_programme]

    def programmes(self, cells: bool) -> list[Series]:
        """Those of cells, or those of plates."""
        return [series for series in self.simulated if series.is_programme and are_cells(series.setting.replicas) == cells]


def figure_data(settings: Sequence[Setting], reference: Setting | None, options: FigureOptions) -> FigureData:
    """Groups levels, and compares with the reference."""
    simulated = []
    for setting, style in zip(settings, styles_of(settings), strict=True):
        is_programme = follows_programme(setting.replicas)
        levels: Levels = [] if is_programme else group_levels(setting.replicas)
        if is_programme or levels:
            simulated.append(Series(_key_words(setting), style, setting, levels, _comparison_of(setting, reference, options)))
    over = Series(_key_words(reference), reference_style(), reference, group_levels(reference.replicas), is_reference=True) if reference \
        else None
    return FigureData(tuple(simulated), over, options)


def _key_words(setting: Setting) -> str:
    return shortened(words_for(setting.label), KEY_CHARACTERS)


def _comparison_of(setting: Setting, reference: Setting | None, options: FigureOptions) -> Comparison | None:
    if reference is None:
        return None
    known = (one for one in options.comparisons if one.setting == setting.label)
    return next(known, None) or compare(setting, reference.replicas, options.touch_force)
