"""Dense soft granular matter by MC-DEM: scenes, runs, results as NumPy arrays, diagnoses. SI units throughout."""
import importlib

__all__ = ["Failure", "Recording", "Run", "Scene", "__version__", "calibrate", "compare", "converge", "devices", "diagnose",
           "export", "read", "report", "run", "simulate"]


def __getattr__(name):
    """The compiled module is loaded by the first name that needs it: the commands written in Python do without."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = ".command" if name == "report" else "._engine"
    value = globals()[name] = getattr(importlib.import_module(home, __name__), name)
    return value


def __dir__():
    return sorted({*globals(), *__all__})
