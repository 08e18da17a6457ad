"""Containers of grains: their walls, and distances to them and between points [m]."""
import math

import numpy as np

from ..results.names import Wall
from ..results.recording import Box, Floats, Ints


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


def lengths(vectors: Floats) -> Floats:
    """(N,) of vectors (N, 3)."""
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


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


def wall_distance(box: Box, wall: Wall | Ints, plate_z: float | Floats, point: Floats) -> Floats:
    """(N,) distances of points from existing walls, negative outside; one wall and plate position [m] for all points, or (N,)."""
    place = np.where(wall == Wall.plate, plate_z, np.array([0, box.size_x, 0, box.size_y, 0, 0])[wall])
    coordinate = point[np.arange(len(point)), np.asarray(wall) // 2]
    distance = np.where(np.asarray(wall) % 2, place - coordinate, coordinate - place)
    if box.is_cylinder:
        curved = np.broadcast_to(wall == Wall.x_min, len(point))
        distance[curved] = box.size_x / 2 - lengths(from_axis(box, point[curved]))
    return distance


def towards_wall(box: Box, wall: Wall | Ints, point: Floats) -> Floats:
    """(N, 3) unit normals from points inside towards existing walls: one for all points, or (N,)."""
    normal = np.zeros(point.shape)
    normal[np.arange(len(point)), np.asarray(wall) // 2] = np.where(np.asarray(wall) % 2, 1.0, -1.0)
    if box.is_cylinder:
        curved = np.broadcast_to(wall == Wall.x_min, len(point))
        out = from_axis(box, point[curved])
        out[~out.any(axis=1)] = 1, 0, 0
        normal[curved] = out / lengths(out)[:, np.newaxis]
    return normal
