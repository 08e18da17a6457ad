"""Numbers as text."""


def mm(length: float) -> str:
    """A length [m] in millimetres: two decimals, or three digits where that is less than 0.1."""
    return f"{1e3 * length:.2f}" if length == 0 or not abs(length) < 0.1e-3 else f"{1e3 * length:.3g}"


def shortest(value: float) -> str:
    """The fewest digits that give the number back: "0.1", "23300", "1e-05", "nan"."""
    return repr(float(value)).removesuffix(".0")
