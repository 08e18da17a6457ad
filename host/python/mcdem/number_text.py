"""Numbers as text."""


def shortest(value: float) -> str:
    """The fewest digits that give the number back: "0.1", "23300", "1e-05", "nan"."""
    return repr(float(value)).removesuffix(".0")
