"""Readable names of settings, their colours and markers, and units of stresses. For pages and figures for print."""
import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..observe.replicas import Setting, model_of
from ..results.names import ContactModel, parse

NO_NUMBER = "–"
MM = MN = 1e-3  # millimetres, millinewtons

MODEL_WORDS = dict(zip(ContactModel, ("Independent contacts", "Point force on sphere", "Sphere to sphere", "Elastic half space", "MC-DEM",
                                      "Elastic sphere", "Hyperelastic sphere"), strict=True))
# Okabe & Ito 2008, without yellow (too light on white) and black (the reference), in the order of ContactModel.
PALETTE = ("#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7", "#666666")
MARKERS = ("s", "^", "v", "D", "o", "p", "h")
# Colours of matplotlib's "viridis", without the yellow end: readable by colour-blind readers and in grey.
RAMP = ((0x44, 0x01, 0x54), (0x46, 0x32, 0x7E), (0x36, 0x5C, 0x8D), (0x27, 0x7F, 0x8E), (0x1F, 0xA1, 0x87), (0x4A, 0xC1, 0x6D),
        (0x7F, 0xD3, 0x4E), (0xC8, 0xE0, 0x20))
CONTROLS = {code: " " for code in (*range(0x20), 0x7F)}


def words_for(label: str) -> str:
    """Replaces contact models by their full names ("mc_dem, gamma = 1" becomes "MC-DEM, gamma = 1"); other labels do not change."""
    word = label.replace(",", " ").split(" ", 1)[0]
    model = parse(ContactModel, word)
    return MODEL_WORDS[model] + one_line(label[len(word):]) if model else one_line(label)


def one_line(text: str) -> str:
    """Without line breaks and control characters: a label from a file cannot control a terminal, break a table or end a script's line."""
    return text.translate(CONTROLS)


def shortened(text: str, most: int) -> str:
    """The text truncated to `most` characters, with an ellipsis if it was longer."""
    return text if len(text) <= most else text[:most - 1] + "…"


def number(value: float, form: str = ".3g") -> str:
    """The number in this format; a dash if it is not finite."""
    return f"{value:{form}}" if math.isfinite(value) else NO_NUMBER


def three_digits(value: float) -> str:
    """Three significant digits, without an exponent from 1e-4 to a million: "0.0123", "1000" for 999.9."""
    if not 99.95 <= abs(value) < 1e6:
        return f"{value:.3g}"
    last = 10 ** (math.floor(math.log10(abs(value)) + 1e-12) - 2)
    return f"{math.copysign(last * math.floor(abs(value) / last + 0.5), value):.0f}"


@dataclass(frozen=True)
class StressUnit:
    """`size` [Pa]"""

    name: str
    size: float


def stress_unit(largest: float) -> StressUnit:
    """A unit in which the largest of several stresses [Pa] has few digits."""
    if largest >= 1e7:
        return StressUnit("MPa", 1e6)
    return StressUnit("kPa", 1e3) if largest >= 1e4 else StressUnit("Pa", 1.0)


@dataclass(frozen=True)
class SeriesStyle:
    """`colour`: "#rrggbb"; `marker`: as in matplotlib."""

    colour: str
    marker: str


def reference_style() -> SeriesStyle:
    """Black circles."""
    return SeriesStyle("#000000", "o")


def style_number(index: int) -> SeriesStyle:
    """Style of the first, second, .. series."""
    return SeriesStyle(PALETTE[index % len(PALETTE)], MARKERS[index % len(MARKERS)])


def styles_of(settings: Sequence[Setting]) -> list[SeriesStyle]:
    """If every setting has a different contact model, a model has the same colour in all figures.

    Otherwise colours follow the order of the settings, with a gradual change if there are more than seven. They are suitable for
    colour-blind readers (Okabe and Ito; viridis).
    """
    models = [model for setting in settings if (model := model_of(setting.replicas))]
    if len(set(models)) == len(settings):
        return [style_number(list(ContactModel).index(model)) for model in models]
    styles, last = [style_number(number) for number in range(len(settings))], len(settings) - 1
    if len(settings) <= len(PALETTE):
        return styles
    return [SeriesStyle(_ramp_colour(number / last), style.marker) for number, style in enumerate(styles)]


def _ramp_colour(place: float) -> str:
    """Colour at `place` between 0 and 1 of the ramp."""
    at = place * (len(RAMP) - 1)
    low = min(int(at), len(RAMP) - 2)
    mixed = (math.floor(a + (at - low) * (b - a) + 0.5) for a, b in zip(RAMP[low], RAMP[low + 1], strict=True))
    return "#" + bytes(mixed).hex()
