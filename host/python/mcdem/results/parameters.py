"""Scene keys of a recording with their values, as TOML text (host/core/parameters.h)."""
import tomllib
from collections.abc import Mapping, Sequence

Parameters = dict[str, str]


def value_of(parameters: Parameters, key: str) -> str:
    """The text of a key's value; empty if it is missing."""
    return parameters.get(key, "")


def without_quotes(text: str) -> str:
    """A TOML string without its quotes; parameters may have them or not."""
    return text[1:-1] if len(text) >= 2 and text[0] == text[-1] == '"' else text


def typed_value(text: str) -> object:
    """The value that TOML text means: number, truth, text, list; the text itself where it is no TOML."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def has_programme(parameters: Mapping[str, object]) -> bool:
    """Whether the recording followed a [[programme]]."""
    return "programme.1.stage" in parameters


def keys_that_vary(everyone: Sequence[Mapping[str, object]]) -> list[str]:
    """Keys with different values among these, in alphabetical order."""
    keys = {key for parameters in everyone for key in parameters}
    return sorted(key for key in keys if len({parameters.get(key, "") for parameters in everyone}) > 1)
