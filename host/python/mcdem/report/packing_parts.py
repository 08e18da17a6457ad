"""What all scans of a packing's 3D view have in common, made with plotly.py: looks of grains and force chains, walls, axes."""
from typing import Any

import numpy as np
import plotly.graph_objects as go

from ..results import Box, ContainerShape
from ..results.recording import Floats
from .page import CLEAR, FONT, LAYOUT

MM = 1e-3
WIDTHS = (1, 1.5, 2.5, 4, 6, 9)  # of force chains by class [pixels]
FORCE_SCALE = [[place, f"var(--force-{n})"] for n, place in enumerate((0, 0.15, 0.4, 0.7, 1))]
SIDES = 64  # of a drawn circle
FLOOR, PLATE, TOP = 0, 1, 2  # heights, as page_packing.js numbers them


def static_parts(largest_load: float) -> dict[str, Any]:
    """Traces without data, and unit spheres. `largest_load` [mN] ends the colours of grains."""
    grains = go.Mesh3d(
        name="grains", colorscale=FORCE_SCALE, cmin=0, cmax=largest_load, hoverinfo="text", flatshading=False, showscale=True,
        lighting={"ambient": 0.55, "diffuse": 0.65, "specular": 0.12, "roughness": 0.7}, lightposition={"x": 2000, "y": -4000, "z": 9000},
        colorbar={"title": {"text": "forces on a grain [mN]", "side": "right"}, "thickness": 12, "len": 0.75, "outlinewidth": 0})
    chains = [go.Scatter3d(mode="lines", name="force chains", hoverinfo="text", showlegend=False, connectgaps=False,
                           line={"width": width, "color": f"var(--chain-{n})"}) for n, width in enumerate(WIDTHS)]
    return {"grains": grains.to_plotly_json(), "chains": [one.to_plotly_json() for one in chains],
            "spheres": [sphere_mesh(times) for times in range(3)]}


def sphere_number(grains: int) -> int:
    return 2 if grains <= 200 else 1 if grains <= 5000 else 0


def sphere_mesh(times: int) -> dict[str, Any]:
    """The unit sphere as triangles: an icosahedron whose triangles are divided into four, `times` times."""
    t = (1 + 5**0.5) / 2
    points = np.array([(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1),
                       (-t, 0, -1), (-t, 0, 1)])
    faces = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                      (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    for _ in range(times):
        sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1)).reshape(-1, 2)
        edges, edge_of_side = np.unique(sides, axis=0, return_inverse=True)
        (a, b, c), (ab, bc, ca) = faces.T, len(points) + edge_of_side.reshape(-1, 3).T
        faces = np.concatenate([np.column_stack(corners) for corners in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
        points = np.concatenate([points, points[edges].mean(axis=1)])
    return {"points": np.round(points / np.linalg.norm(points, axis=1, keepdims=True), 4).tolist(), "faces": faces.tolist()}


def walls_of(box: Box) -> list[dict[str, Any]]:
    """The container's edges and, unless it is a cell, the plate: x and y over the container's sizes, z as FLOOR, PLATE or TOP."""
    turns = 2 * np.pi * np.arange(SIDES) / SIDES
    round_ones = [(float(x), float(y)) for x, y in np.round((1 + np.column_stack([np.cos(turns), np.sin(turns)])) / 2, 5)]
    corners = round_ones if box.shape == ContainerShape.cylinder else [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    strokes = [[(x, y, height) for x, y in (*corners, corners[0])] for height in (FLOOR, PLATE)]
    strokes += [[(x, y, FLOOR), (x, y, TOP)] for x, y in corners[::len(corners) // 4]]
    x, y, z = zip(*(point for stroke in strokes for point in (*stroke, (None, None, None))), strict=True)
    edges = go.Scatter3d(mode="lines", name="box", hoverinfo="skip", showlegend=False, line={"width": 2, "color": "var(--axis)"})
    drawn: list[dict[str, Any]] = [{**edges.to_plotly_json(), "x": x, "y": y, "z": z}]
    if not box.is_cell:
        fan = list(range(1, len(corners) - 1))
        plate = go.Mesh3d(name="plate", i=[0] * len(fan), j=fan, k=[n + 1 for n in fan], color="var(--soft)", opacity=0.18,
                          hoverinfo="skip", showscale=False)
        drawn.append({**plate.to_plotly_json(), "x": [x for x, _ in corners], "y": [y for _, y in corners], "z": [PLATE] * len(corners)})
    return drawn


def layout_of(sizes: Floats, largest_diameter: float) -> dict[str, Any]:
    """`sizes`: of the container up to the plate's highest position [mm]. Axes do not follow the drawn data, since contacts in a
    periodic cell extend beyond it."""
    past = 0.1 * largest_diameter  # grains overlap walls and would be cut off at the ends of the axes
    spans = sizes + 2 * past
    ratio = spans / np.cbrt(spans.prod())
    far = float(np.clip(sizes[2] / np.cbrt(sizes.prod()) / 1.3, 0.8, 1.2))
    axes = {f"{axis}axis": {"title": {"text": f"{axis} [mm]"}, "gridcolor": "var(--grid)", "showbackground": False, "zeroline": False,
                            "showspikes": False, "nticks": 5, "color": "var(--axis)", "range": [-past, float(size) + past]}
            for axis, size in zip("xyz", sizes, strict=True)}
    camera = {"eye": {"x": 1.2 * far, "y": -1.95 * far, "z": 0.55 * far}, "center": {"x": 0, "y": 0, "z": -0.08}}
    scene = {"aspectmode": "manual", "aspectratio": dict(zip("xyz", ratio.tolist(), strict=True)), "uirevision": "kept", "camera": camera,
             **axes}
    hover = {key: value for key, value in LAYOUT["hoverlabel"].items() if key != "namelength"}
    made = go.Layout(margin={side: 0 for side in "lrtb"}, paper_bgcolor=CLEAR, modebar=LAYOUT["modebar"], uirevision="kept",
                     font={"family": FONT, "size": 12, "color": "var(--ink)"}, hoverlabel=hover, scene=scene)
    return dict(made.to_plotly_json())
