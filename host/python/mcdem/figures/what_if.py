"""Figure of keys that are moved alone until a quantity is the wanted one."""
from typing import Any

from .style import GREY, INK, PAGE, key, line, new_axes, plain, styled
from .values import Source, read


TICKS = -100, -10, -1, 0, 1, 10, 100, 1000


@styled
def what_if(source: Source, axes: Any = None) -> Any:
    """Left: the target quantity over the change of each key; line: the target, large marker: where it is met (open: nearest to it).
    Right: the force on the plate of the scene and of each of these, with the experiment."""
    values = read(source, "what_if")
    axes = new_axes(PAGE, 70, ncols=2) if axes is None else axes
    left, right = axes
    left.axhline(values["target"], color=GREY, linewidth=0.7, linestyle=":")
    right.plot(values["displacement"], _numbers(values["scene_force"]), color=GREY, linestyle="--")
    entries = [(line(color=GREY, linestyle="--"), "scene")]
    for one in values["series"]:
        known = [k for k, change in enumerate(one["change"]) if change is not None]
        left.plot([one["change"][k] for k in known], _numbers([one["target"][k] for k in known]), color=one["colour"], marker=one["marker"],
                  markersize=2)
        if one["found"][0] is not None:
            left.plot(*one["found"], color=one["colour"], marker=one["marker"], markersize=6, markeredgecolor=INK,
                      markerfacecolor=one["colour"] if one["is_met"] else "white")
        right.plot(values["displacement"], _numbers(one["force"]), color=one["colour"])
        entries.append((line(color=one["colour"], marker=one["marker"]), one["words"]))
    if values["measured"]:
        right.plot(*map(_numbers, values["measured"]), color=INK, marker="o", markersize=2, linestyle="")
        entries.append((line(color=INK, marker="o", linestyle=""), "experiment"))
    elif values["top_force"] is not None:
        right.plot(values["displacement"][-1], values["top_force"], color=INK, marker="o", markersize=4, linestyle="", clip_on=False)
        entries.append((line(color=INK, marker="o", linestyle=""), "target"))
    left.set(xlabel=values["x_label"], ylabel=plain(values["y_label"]))
    left.set_xscale("symlog", linthresh=1)
    shown = [tick for tick in TICKS if left.get_xlim()[0] <= tick <= left.get_xlim()[1]]
    left.set_xticks(shown, [f"{tick:+}" if tick else "0" for tick in shown])
    left.minorticks_off()
    right.set(xlabel="plate displacement [mm]", ylabel="force on the plate [N]", ylim=(0, None))
    key(right, entries, "upper left")
    return axes


def _numbers(values: list[float | None]) -> list[float]:
    return [float("nan") if value is None else value for value in values]
