"""Runs and experiments as values in NumPy arrays, read from result folders and files (host/io/README.md)."""
from .names import ContactModel, ContainerShape, FrictionLaw, Phase, Wall, parse
from .read import read_run
from .recording import NO_CONTACTS, Box, Contacts, Failure, Recording, Run, Scans

__all__ = ["NO_CONTACTS", "Box", "ContactModel", "Contacts", "ContainerShape", "Failure", "FrictionLaw", "Phase", "Recording", "Run",
           "Scans", "Wall", "parse", "read_run"]
