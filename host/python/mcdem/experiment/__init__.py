"""Experiment folders (host/experiment/README.md): reading, checking and writing measured compressions."""
