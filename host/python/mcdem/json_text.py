"""Results as JSON."""
import json
import math
import re
from typing import Any


def finite(value: Any) -> Any:
    """The value with None for numbers that are not finite, and lists for tuples."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (tuple, list)):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def compact_json(document: Any) -> str:
    """In one line, keys sorted: the same text for the same document. All numbers must be finite."""
    return json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def json_text(document: Any, sort_keys: bool = False, indent: int = 2) -> str:
    """Indented, with a final line feed; what was invalid UTF-8 becomes replacement characters. All numbers must be finite."""
    text = json.dumps(document, indent=indent, ensure_ascii=False, allow_nan=False, sort_keys=sort_keys)
    return re.sub("[\ud800-\udfff]", "\ufffd", text) + "\n"
