"""Influence of a scene's numerics on its results: `mcdem converge`."""
