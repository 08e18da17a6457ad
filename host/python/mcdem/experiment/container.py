"""Containers of grains: their walls, and distances to them and between points [m]."""
import math

import numpy as np

from ..results.names import Wall
from ..results.recording import Box, Floats


def walls_of(box: Box) -> list[Wall]:
    """The walls that exist."""
    return [wall for wall in Wall if box.has_wall(wall)]


def container_words(box: Box) -> str:
    """ "box of 165 by 166 mm" """
    if box.is_cylinder:
        return f"cylinder with a radius of {1e3 * box.size_x / 2:.6g} mm"
    return f"{'periodic container' if box.is_periodic else 'box'} of {1e3 * box.size_x:.6g} by {1e3 * box.size_y:.6g} mm"


def floor_area(box: Box) -> float:
    """[m2]"""
    return box.size_x * box.size_y * (math.pi / 4 if box.is_cylinder else 1)


def apart(box: Box, start: Floats, end: Floats) -> Floats:
    """(N, 3) vectors between points; in a periodic container to the nearest image."""
    way = end - start
    if box.is_periodic:
        edges = box.size_x, box.size_y
        way[:, :2] -= np.rint(way[:, :2] / edges) * edges
    return way


def into_cell(box: Box, point: Floats) -> Floats:
    """(N, 3) the images of points inside a periodic container; in others the points themselves."""
    inside = point.copy()
    if box.is_periodic:
        edges = box.size_x, box.size_y
        inside[:, :2] -= np.floor(inside[:, :2] / edges) * edges
        inside[:, :2][~(inside[:, :2] < edges)] = 0  # rounding
    return inside


def from_axis(box: Box, point: Floats) -> Floats:
    """(N, 3) horizontal vectors from the axis of a cylinder to points."""
    return (point - (box.size_x / 2, box.size_y / 2, 0)) * (1, 1, 0)


def wall_distance(box: Box, wall: Wall, plate_z: float, point: Floats) -> Floats:
    """(N,) distances of points from an existing wall, negative outside."""
    if box.is_cylinder and wall == Wall.x_min:
        return np.asarray(box.size_x / 2 - np.linalg.norm(from_axis(box, point), axis=1))
    place, coordinate = (0, box.size_x, 0, box.size_y, 0, plate_z)[wall], point[:, wall // 2]
    return np.asarray(place - coordinate if wall % 2 else coordinate - place)


def towards_wall(box: Box, wall: Wall, point: Floats) -> Floats:
    """(N, 3) unit normals from points inside towards an existing wall."""
    if box.is_cylinder and wall == Wall.x_min:
        out = from_axis(box, point)
        out[~out.any(axis=1)] = 1, 0, 0
        return np.asarray(out / np.linalg.norm(out, axis=1, keepdims=True))
    normal = np.zeros_like(point)
    normal[:, wall // 2] = 1 if wall % 2 else -1
    return normal
