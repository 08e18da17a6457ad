"""Finds gamma of MC-DEM, or Young's modulus for another model, from the top force of an experiment."""
