"""Results for readers: tables, figures' values, pages.

The package is also the function mcdem.report, which has its name.
"""
import pathlib
import sys
import types
from typing import Any


class _Room(types.ModuleType):
    def __call__(self, *sources: Any, **options: Any) -> pathlib.Path:
        from ..command import report
        return report(*sources, **options)


sys.modules[__name__].__class__ = _Room
