"""Evidence and findings of a diagnosis as JSON files, so that limits and ablations can be tried without new simulations."""
import dataclasses
import json
import math
import types
import typing
from collections.abc import Callable
from typing import Any, TypeVar

from ..errors import InputError
from ..files import read_input
from ..look import Path, leads_somewhere
from ..checked_json import Invalid, finite, value_of
from .decision import Findings
from .evidence import CandidateRange, Evidence, NuisancePrior
from .json_numbers import array_of, expect_json, matrix_of, number_list
from .library import Library

Document = TypeVar("Document")


def _written(kind: Any, value: Any) -> Any:
    """JSON of a value of this type; null for numbers that are not finite."""
    if dataclasses.is_dataclass(kind):
        return {name: _written(hint, getattr(value, name)) for name, hint in typing.get_type_hints(kind).items()}
    if typing.get_origin(kind) is list:
        return [_written(typing.get_args(kind)[0], item) for item in value]
    if isinstance(kind, types.UnionType):
        return None if value is None else _written(kind.__args__[0], value)
    return None if kind is float and not math.isfinite(value) else kind(value)


def _read(kind: Any, value: Any, place: str) -> Any:
    """The value as this type: a dataclass with all of its keys, a list, or as value_of. Raises Invalid."""
    if dataclasses.is_dataclass(kind):
        hints = typing.get_type_hints(kind)
        if not isinstance(value, dict) or not hints.keys() <= value.keys():
            raise Invalid(f"{place}: must be an object with the keys {', '.join(hints)}")
        return typing.cast(type, kind)(**{name: _read(hint, value[name], f"{place}.{name}") for name, hint in hints.items()})
    if typing.get_origin(kind) is list:
        if not isinstance(value, list):
            raise Invalid(f"{place}: must be a list")
        return [_read(typing.get_args(kind)[0], item, f"{place}[{k}]") for k, item in enumerate(value)]
    return value_of(kind, value, place)


def _text(document: dict[str, Any]) -> str:
    return json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _read_file(file: Path, what: str, document_of: Callable[[Any], Document]) -> Document:
    if not leads_somewhere(file):
        raise InputError(f"{file}: is missing; `mcdem challenge run` writes it")
    content = read_input(file)
    try:
        return document_of(json.loads(content, parse_float=finite, parse_constant=finite))
    except (OverflowError, RecursionError, ValueError) as problem:  # numbers that are too large, too many lists, no JSON
        raise InputError(f"{file}: not {what} ({problem})") from problem


def evidence_text(evidence: Evidence) -> str:
    """JSON of everything except the library, which all cases of a challenge share."""
    return _text({
        "seed": int(evidence.seed), "observed": number_list(evidence.observed), "baseline": number_list(evidence.baseline),
        "candidates": _written(list[CandidateRange], evidence.candidates), "nuisances": _written(list[NuisancePrior], evidence.nuisances)})


def read_evidence(file: Path, library: Library) -> Evidence:
    """Raises InputError if the file is not evidence, or does not match the cells of this library."""

    def evidence_of(document: Any) -> Evidence:
        expect_json(isinstance(document, dict) and {"seed", "observed", "baseline", "candidates", "nuisances"} <= document.keys(),
                    "it is no object with seed, observed, baseline, candidates and nuisances")
        evidence = Evidence(
            array_of(document["observed"]), matrix_of(document["baseline"]), library,
            _read(list[CandidateRange], document["candidates"], "candidates"), _read(list[NuisancePrior], document["nuisances"], "nuisances"),
            seed=_read(int, document["seed"], "seed"), library_is_own=False)  # a challenge has one library for all
        cells = library.baseline.shape[1]
        expect_json(len(evidence.observed) == cells and evidence.baseline.shape[1] == cells, "it has other observables than the library")
        effects, nuisances = ({signature.name for signature in signatures} for signatures in (library.effects, library.nuisances))
        expect_json(all(one.name in effects for one in evidence.candidates), "the library lacks an effect of it")
        expect_json(all(one.name in nuisances for one in evidence.nuisances), "the library lacks a nuisance of it")
        return evidence

    return _read_file(file, "evidence of this challenge", evidence_of)


def findings_text(findings: Findings) -> str:
    """JSON."""
    return _text(_written(Findings, findings))


def read_findings(file: Path) -> Findings:
    """Raises InputError if the file does not contain findings."""

    def findings_of(document: Any) -> Findings:
        findings: Findings = _read(Findings, document, "findings")
        expect_json(len(findings.names) == len(findings.gain), "one gain per candidate is required")
        proposed = [candidate for proposal in findings.proposals for candidate in proposal.candidates]
        expect_json(all(0 <= candidate < len(findings.names) for candidate in proposed), "it proposes a candidate that does not exist")
        return findings

    return _read_file(file, "findings of a diagnosis", findings_of)
