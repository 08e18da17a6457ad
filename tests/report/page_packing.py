"""The 3D packing compared with run.h5: grains, their forces, and every line of the force chains."""
import re

import numpy as np
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from report import page_truth as truth

WALLS = ["wall x min", "wall x max", "wall y min", "wall y max", "floor", "plate"]
CHAINS = ("document.getElementById('packing').data.filter(t => t.name === 'force chains')"
          ".map(t => [[t.x, t.y, t.z], t.text, t.line.width, t.line.color])")


def grains_on_page(reader, grains):
    """Centres [mm] of the spheres and the force on each [mN], from the corners of the drawn triangles."""
    mesh = reader.script("(() => { const t = document.getElementById('packing').data.find(t => t.name === 'grains');"
                         "return [t.x, t.y, t.z, t.intensity]; })()")
    x, y, z, intensity = (np.array(column).reshape(grains, -1) for column in mesh)
    return np.stack([x.mean(axis=1), y.mean(axis=1), z.mean(axis=1)], axis=1), intensity[:, 0]


def check_grains(reader, position, contacts):
    force = truth.forces_of(contacts) * 1e3
    load = np.zeros(len(position))
    np.add.at(load, contacts["grain"], force)
    pairs = contacts["partner"] >= 0
    np.add.at(load, contacts["partner"][pairs], force[pairs])
    centres, shown = grains_on_page(reader, len(position))
    np.testing.assert_allclose(centres, position, atol=6e-3, err_msg="centres [mm]")
    np.testing.assert_allclose(shown, load, rtol=1e-3, atol=1e-3, err_msg="forces on grains [mN]")


def ends_of(contact, position, walls):
    """Both centres, or a centre and the foot of the perpendicular on the wall [mm]."""
    start, partner = position[contact["grain"]], contact["partner"]
    if partner >= 0:
        return start, position[partner]
    wall, foot = -1 - partner, start.copy()
    foot[wall // 2] = walls[wall]
    return start, foot


def name_of(partner):
    return f"grain {partner}" if partner >= 0 else WALLS[-1 - partner]


def strongest(run, replicas):
    """The force [mN] that all but one in two hundred of the displayed contacts do not exceed."""
    forces = np.sort(np.concatenate([truth.forces_of(run[f"contacts/replica_{replica:05}/contact"][:])
                                     for replica in replicas]))
    return forces[len(forces) - 1 - len(forces) // 200] * 1e3


def brightness(colour):
    return sum(int(channel) for channel in re.findall(r"\d+", colour))


def check_looks(classes):
    """Stronger contacts are thicker and, on white, darker."""
    widths, colours = [c[2] for c in classes], [brightness(c[3]) for c in classes]
    assert all(b > 1.2 * a for a, b in zip(widths, widths[1:])) and widths[-1] > 5 * widths[0], widths
    assert all(b < a - 20 for a, b in zip(colours, colours[1:])), colours


def check_line(line, words, contact, ends, force):
    np.testing.assert_allclose(line, [ends[0], np.mean(ends, axis=0), ends[1]], atol=2e-3,
                               err_msg="start, middle and end of a contact's line [mm]")
    names, shown = words.split("<br>")
    assert names == f"grain {contact['grain']} and {name_of(contact['partner'])}", names
    np.testing.assert_allclose(float(shown.removesuffix(" mN")), force, rtol=1e-3, err_msg=names)


def check_chains(reader, position, contacts, walls, largest):
    """Every contact is drawn once, in the class of its force: equal parts of the range, the last one open."""
    classes = reader.script(CHAINS)
    check_looks(classes)
    force = truth.forces_of(contacts) * 1e3
    class_of = np.minimum(force / largest * len(classes), len(classes) - 1).astype(int)
    for number, (axes, words, _, _) in enumerate(classes):
        here = np.flatnonzero(class_of == number)
        assert len(words) == 4 * len(here) and all(axis[3::4] == [None] * len(here) for axis in axes), number
        points = np.array(axes, float).T.reshape(-1, 4, 3)
        for line, label, place in zip(points, words[::4], here):
            check_line(line[:3], label, contacts[place], ends_of(contacts[place], position, walls), force[place])
    return class_of


def check_packing(reader, run, replica, scan, largest):
    """Checks one drawn scan; returns the classes of its contacts."""
    particles = run[f"particles/replica_{replica:05}"]
    position = particles["position/value"][scan].astype(float) * 1e3
    width, depth, _ = particles["box"].attrs["edges"] * 1e3
    observed = run[f"observables/replica_{replica:05}"][scan]
    contacts = truth.contacts_of(run, replica, scan)
    check_grains(reader, position, contacts)
    assert f"top force {observed['wall_force'][truth.PLATE, 2]:.4g} N" in reader.element(".packing output").text
    return check_chains(reader, position, contacts, [0, width, 0, depth, 0, observed["plate_z"] * 1e3], largest)


def to_full_stroke(slider, scans):
    slider.send_keys(Keys.HOME, *[Keys.ARROW_RIGHT] * (scans // 2))


def check_slider(reader, run, first_replicas):
    """Opens at the scan with the largest load; steps through scans and settings; ends at full stroke, where all classes
    of chains occur."""
    slider, largest = reader.element(".packing input"), strongest(run, first_replicas)
    scans, classes = len(run["observables/replica_00000"]), set()
    assert slider.get_attribute("max") == str(scans - 1), "all scans of so small a run are shown"
    opened = int(run["observables/replica_00000"]["wall_force"][:, 5, 2].argmax())
    assert 0 < opened < scans and slider.get_attribute("value") == str(opened), (slider.get_attribute("value"), opened)
    classes |= set(check_packing(reader, run, 0, opened, largest))
    reader.picture("packing_opened.png", ".packing")
    for key, scan in ((Keys.HOME, 0), (Keys.ARROW_RIGHT, 1), (Keys.END, scans - 1), (Keys.HOME, 0)):
        slider.send_keys(key)
        classes |= set(check_packing(reader, run, 0, scan, largest))
    to_full_stroke(slider, scans)
    Select(reader.element(".packing .setting")).select_by_visible_text("MC-DEM")
    classes |= set(check_packing(reader, run, first_replicas[-1], scans // 2, largest))
    assert len(classes) == len(reader.script(CHAINS)), classes
    reader.picture("packing_full_stroke.png", ".packing")
    for what in ("grains", "chains"):
        Select(reader.element(".packing .what")).select_by_value(what)
        reader.picture(f"packing_{what}.png", ".packing")
    Select(reader.element(".packing .what")).select_by_value("both")
    slider.send_keys(Keys.END)
    reader.picture("packing_last.png", ".packing")
    to_full_stroke(slider, scans)
