"""Experiment folders (host/python/mcdem/experiment/README.md): reading, checking and writing measured compressions."""
