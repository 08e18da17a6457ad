"""Draws every figure of a figures.json into its folder, as PDF, PNG and SVG: python3 -m mcdem.figures FILE."""
import pathlib
import sys

import matplotlib

matplotlib.use("agg")  # works without a display
matplotlib.rcdefaults()  # ignores the user's settings


def main(file):
    import matplotlib.pyplot as plt

    from mcdem import figures
    for name in figures.read(file):
        axes = getattr(figures, name)(file)
        for kind in ("pdf", "png", "svg"):
            figures.save(axes, pathlib.Path(file).parent / f"{name}.{kind}")
        plt.close("all")


main(sys.argv[1])
