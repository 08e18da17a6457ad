"""The page of a cell: stresses and strains as in run.h5, and no text about plates and their forces."""
import xml.etree.ElementTree

import numpy as np
from selenium.webdriver.support.ui import WebDriverWait

from report import page_truth as truth


def check_line(reader, chart, x, y):
    trace, = reader.traces(chart)
    np.testing.assert_allclose(trace["x"], x, rtol=1e-6, atol=1e-9, err_msg=chart)
    np.testing.assert_allclose(trace["y"], y, rtol=1e-6, atol=1e-9, err_msg=chart)


def check_cell(reader, run):
    rows = run["observables/replica_00000"][:]
    p, q = truth.invariants(rows)
    volume = 100 * (1 - np.prod(1 - rows["strain"][:, :3], axis=1))
    check_line(reader, "pressure_strain", volume, p)
    check_line(reader, "stress_path", p, q)
    check_line(reader, "pressure_time", rows["time"], p)
    check_line(reader, "shear_stress_time", rows["time"], q)
    assert reader.element(".packing input").get_attribute("value") == str(p.argmax())
    head = reader.element(".lead").text
    assert "70 grains in a cell that repeats in all directions, deformed in 3 stages" in head, head
    assert f"{p.max():.3g} Pa" in head, (head, p.max())
    shown = reader.script("document.querySelector('main').innerText")
    for word in ("plate", "top force"):
        assert word not in shown.lower(), word
    reader.picture("cell")


def check_svg(reader, chart, words):
    """The button saves a vector graphic with the bright colours, whatever the page's theme."""
    reader.command("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(reader.folder)})
    file = reader.folder / f"{chart}.svg"
    reader.click(reader.element(f"button[data-svg={chart}]"))
    WebDriverWait(reader.driver, 30).until(lambda _: file.exists() and file.stat().st_size > 0)
    root = xml.etree.ElementTree.parse(file).getroot()
    texts = [text.text for text in root.iter("{http://www.w3.org/2000/svg}text")]
    assert set(words) <= set(texts), texts
    assert "rgb(230, 232, 235)" not in file.read_text(), "ink of the dark page"
