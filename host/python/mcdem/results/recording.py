"""Results of a run or an experiment as plain values (host/core/recording.h), in SI units.

The averages of all scans of a recording are arrays whose first axis counts the scans; unknown numbers are NaN.
"""
from dataclasses import dataclass, field
from functools import cached_property
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .names import ContactModel, ContainerShape, FrictionLaw, Wall, parse
from .parameters import Parameters, has_programme, typed_value, value_of, without_quotes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts of one scan (C of them) as seen from `grain`; a contact between two grains is listed once, with grain < partner."""

    grain: Ints  # (C,)
    partner: Ints  # (C,) a grain, or -1 - Wall
    point: Floats  # (C, 3) [m]
    force: Floats  # (C, 3) on `grain`, normal and tangential together [N]
    overlap: Floats  # (C,) corrected overlap [m]; NaN in measured data

    def __len__(self) -> int:
        return len(self.grain)

    @property
    def is_wall(self) -> Bools:
        """(C,)"""
        return self.partner < 0

    def rows(self, which: slice) -> "Contacts":
        """Some of the contacts."""
        return Contacts(self.grain[which], self.partner[which], self.point[which], self.force[which], self.overlap[which])


NO_CONTACTS = Contacts(np.zeros(0, int), np.zeros(0, int), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
NO_VECTORS: Floats = np.zeros((0, 3))


@dataclass(frozen=True, eq=False)
class Scans:
    """The S scans of one recording: the packing at the positions of the plate."""

    frame: Ints  # (S,) from 0
    cycle: Ints  # (S,) compression cycle, from 0
    phase: Ints  # (S,) Phase
    settled: Bools  # (S,) the plate stopped, and the settling criterion was met
    time: Floats  # (S,) [s]
    plate_z: Floats  # (S,) height of the plate; for a cell, of the cell [m]
    wall_force: Floats  # (S, 6, 3) on each Wall by the grains, or through each face of a cell [N]
    kinetic_energy: Floats  # (S,) [J]
    elastic_energy: Floats  # (S,) of contacts, surfaces and springs [J]
    wall_work: Floats  # (S,) energy budget since the first steps [J]: work on the grains and losses are positive
    weight_work: Floats
    damping_loss: Floats
    friction_loss: Floats
    drag_loss: Floats
    energy_error: Floats  # change of stored energy, plus losses, minus work
    rate_error: Floats  # (S,) estimated relative error of the mean force over packings, caused by the plate's speed
    coordination_number: Floats  # (S,) Z: contacts per grain, including walls
    mean_force: Floats  # (S,) <f> [N]
    packing_fraction: Floats  # (S,) phi
    branch_length: Floats  # (S,) <b> [m]
    max_overlap: Floats  # (S,) largest relative geometric overlap of two grains; 0: no contact
    stress: Floats  # (S, 3, 3) of the packing, compression positive [Pa]
    fabric: Floats  # (S, 3, 3) mean of n n over contacts between grains
    strain: Floats  # (S, 6) of a cell: compression along x, y and z, shears xy, xz and yz; zero otherwise
    position: tuple[Floats, ...] = ()  # by scan (N, 3) [m]; (0, 3) where not recorded or not read
    rotation: tuple[Floats, ...] = ()  # by scan (N, 3) since the start: axis times angle [rad]
    contacts: tuple[Contacts, ...] = ()  # by scan; empty where not recorded or not read

    def __len__(self) -> int:
        return len(self.frame)

    def chosen(self, which: Bools) -> "Scans":
        """The scans that `which` (S,) chooses."""
        chosen: dict[str, Any] = {name: value[which] if isinstance(value, np.ndarray) else tuple(compress(value, which))
                                  for name, value in vars(self).items()}
        return Scans(**chosen)

    @property
    def top_force(self) -> Floats:
        """(S,) upward force on the plate [N]."""
        return self.wall_force[:, Wall.plate, 2]

    @property
    def knows_contacts(self) -> Bools:
        """(S,) False where a scan has contacts but none is listed, because they were not recorded or not read."""
        return np.array([len(one) > 0 for one in self.contacts], bool) | ~(self.coordination_number > 0)


@dataclass(frozen=True)
class Failure:
    """Why a replica stopped before the end of its protocol."""

    step: int
    grain: int  # the user's number; -1 if no grain is the cause
    cause: str

    def text(self) -> str:
        """ "step 200, grain 3: the reason" """
        grain = "" if self.grain < 0 else f", grain {self.grain}"
        return f"step {self.step}{grain}: {self.cause}"


@dataclass(frozen=True)
class Box:
    """The container: floor at z = 0 (host/core/packing.h)."""

    size_x: float = 0.0  # [m]
    size_y: float = 0.0  # [m]
    shape: ContainerShape = ContainerShape.box
    height: float = 0.0  # only of a cell [m]

    @property
    def is_cell(self) -> bool:
        return self.shape == ContainerShape.cell

    @property
    def is_periodic(self) -> bool:
        """Along x and y."""
        return self.is_cell or self.shape == ContainerShape.periodic

    @property
    def is_cylinder(self) -> bool:
        return self.shape == ContainerShape.cylinder

    def has_wall(self, wall: Wall) -> bool:
        if self.is_cell:
            return False
        if wall in (Wall.floor, Wall.plate) or self.shape == ContainerShape.box:
            return True
        return self.is_cylinder and wall == Wall.x_min

    def wall_name(self, wall: Wall) -> str:
        """ "side" for a cylinder's curved wall."""
        return "side" if self.is_cylinder and wall == Wall.x_min else wall.name


@dataclass(frozen=True, eq=False)
class Recording:
    """Results of one packing: a replica of a run, or an experiment."""

    label: str  # distinguishes it within its run: "mc_dem #3"
    parameters: Parameters  # every scene key with its value for this replica, as text
    box: Box
    plate_start: float  # plate position at displacement zero [m]
    diameter: Floats  # (N,) [m]
    scans: Scans
    species: Ints = field(default_factory=lambda: np.zeros(0, int))  # (N,) index into species_names; empty without species
    species_names: tuple[str, ...] = ()
    failure: Failure | None = None

    @cached_property
    def displacement(self) -> Floats:
        """(S,) of the plate [m]."""
        return self.plate_start - self.scans.plate_z

    @property
    def has_start(self) -> bool:
        """Whether frame 0 has the positions of the grains, from which simulations start."""
        return len(self.scans) > 0 and len(self.scans.position[0]) > 0

    def value(self, key: str) -> Any:
        """The value of a scene key: number, truth, text, list; None if it is missing."""
        return typed_value(self.parameters[key]) if key in self.parameters else None

    @property
    def model(self) -> ContactModel | None:
        """Parameter `contact.model`."""
        return parse(ContactModel, without_quotes(value_of(self.parameters, "contact.model")))

    @property
    def friction_law(self) -> FrictionLaw | None:
        """Parameter `contact.friction_law`."""
        return parse(FrictionLaw, without_quotes(value_of(self.parameters, "contact.friction_law")))

    @property
    def has_programme(self) -> bool:
        return has_programme(self.parameters)


@dataclass(frozen=True, eq=False)
class Run:
    """A complete run: its provenance and its recordings."""

    name: str
    scene: str  # text of the scene, with overrides
    program: str  # version and commit
    device: str  # device and driver
    precision: str  # float or double
    recordings: tuple[Recording, ...]
