"""Dense soft granular matter by MC-DEM: scenes, runs, results as NumPy arrays, diagnoses. SI units throughout."""
from ._engine import Failure, Recording, Run, Scene, __version__, converge, devices, diagnose, read, run, simulate

__all__ = ["Failure", "Recording", "Run", "Scene", "__version__", "converge", "devices", "diagnose", "read", "run", "simulate"]
