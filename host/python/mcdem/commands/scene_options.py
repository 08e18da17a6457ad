"""Options that name a scene, and the scene that they name."""
import argparse
from typing import TYPE_CHECKING

from ..program import say

if TYPE_CHECKING:
    from .._engine import Scene


def add_scene_options(parser: argparse.ArgumentParser, name: str = "SCENE",
                      text: str = "Scene file (TOML; scenes/README.md explains every key)") -> None:
    """`name`: a positional argument or a required option."""
    if name.startswith("-"):
        parser.add_argument(name, metavar="FILE", dest="SCENE", required=True, help=text)
    else:
        parser.add_argument(name, help=text)
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], dest="overrides",
                        help="Override a scene key; may be repeated")


def add_device_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--device", metavar="DEVICE", default="",
                        help="Number or part of the name of a device, as listed by `mcdem devices`")


def read_scene(options: argparse.Namespace) -> "Scene":
    """Raises InputError, RunError."""
    from .. import _engine
    scene, warnings = _engine.scene_of_options(options.SCENE, options.overrides)
    for warning in warnings:
        say(warning)
    return scene
