"""Metrics of runs: levels, force distributions, coordination, scaling law, comparisons with a reference."""
