"""mcdem challenge: the commands challenge make, run and score."""

EPILOG = """\
`make` simulates experiments with hidden effects and writes the truth to a separate file; `run`
diagnoses the experiments without that file; `score` compares the diagnoses with the truth.
Example:
  mcdem challenge make scenes/challenge.toml --out out/challenge
  mcdem challenge run out/challenge --scene scenes/challenge.toml --library out/library.json --out out/diagnoses
  mcdem challenge score out/challenge out/diagnoses"""
