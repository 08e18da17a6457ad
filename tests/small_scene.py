"""A scene of 27 grains, which is simulated in a fraction of a second."""


def scene_text(name, end):
    """`end`: lowest position of the plate [m]"""
    return f"""name = "{name}"
[box]
size_x = 0.062
size_y = 0.062
[contact]
model = "independent"
[packing]
count = 27
packing_fraction = 0.59
[plate]
start = 0.0625
end = {end:.4f}
speed = 0.3
[protocol]
stop_at_scans = false
scans_per_stroke = 3
relax_time = 0.05
"""
