"""Dense soft granular matter by MC-DEM: scenes, runs, results as NumPy arrays, diagnoses. SI units throughout."""
import importlib

__all__ = ["Failure", "Recording", "Run", "Scene", "__version__", "calibrate", "compare", "converge", "devices", "diagnose",
           "export", "forces_along", "read", "report", "run", "simulate"]


def __getattr__(name):
    """Loads the compiled module when a name needs it, because commands written in Python do not."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = {"export": ".command", "report": ".command", "calibrate": ".calibration.calibrate", "compare": ".comparing",
            "converge": ".convergence.converge", "diagnose": ".diagnosing"}.get(name, "._engine")
    value = globals()[name] = getattr(importlib.import_module(home, __name__), name)
    return value


def __dir__():
    return sorted({*globals(), *__all__})
