"""The blind challenge: simulated experiments with hidden effects, their diagnoses, and the score."""
