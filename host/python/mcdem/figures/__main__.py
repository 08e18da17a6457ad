"""Draws every figure of a figures.json into its folder, as PDF, PNG and SVG: python3 -m mcdem.figures FILE."""
import sys

from mcdem.report.draw import draw_file

draw_file(sys.argv[1])
