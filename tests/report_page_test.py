"""A report as a reader sees it: opened in headless Chromium without a network, pointed at, moved, darkened, printed.

report_page_test.py PROGRAM FOLDER; makes a run, a diagnosis and their report in FOLDER, and leaves screenshots there.
Exit code 77: a program or module that it needs is not there.
"""
import base64
import json
import pathlib
import shutil
import subprocess
import sys

try:
    import h5py
    import numpy as np
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError as missing:
    print(f"skipped: {missing}; install python3-selenium, python3-h5py and python3-numpy")
    sys.exit(77)

PLATE = 5  # the wall's number in result files
SCENE = """
name = "small <img src=x onerror=alert(1)>"
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.09
end = 0.07
[protocol]
scans_per_stroke = 6
scan_at_start = true
[batch]
replicas = 2
[batch.vary]
"contact.model" = ["independent", "mc_dem"]
"""


def make_report(program, folder):
    """A run of two settings with two replicas each, a diagnosis of one against the other, and one page of both."""
    def mcdem(*words):
        subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, timeout=500)

    (folder / "scene.toml").write_text(SCENE)
    mcdem("run", "scene.toml", "--out", "run", "--no-figures")
    mcdem("experiment", "from-run", "run", "--replica", "mc_dem #1", "--out", "reality")
    mcdem("diagnose", "scene.toml", "--experiment", "reality", "--out", "diagnosis", "--replicates", "8",
          "--pairs", "2", "--confirmations", "2", "--candidates", "cross_contact,adhesion,friction,stiffening")
    mcdem("report", "run", "diagnosis", "--out", "report.html")


def browser():
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not chromium or not driver:
        print("skipped: no chromium or no chromedriver; install chromium and chromium-driver")
        sys.exit(77)
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for word in ("--headless=new", "--no-sandbox", "--window-size=1100,900", "--use-angle=swiftshader",
                 "--enable-unsafe-swiftshader", "--force-color-profile=srgb", "--hide-scrollbars"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(driver), options=options)


class Reader:
    """What a reader does with the page, and what stands on it."""

    def __init__(self, page, folder):
        self.driver, self.folder = browser(), folder
        self.command("Network.enable", {})
        self.command("Network.emulateNetworkConditions", {"offline": True, "latency": 0, "downloadThroughput": 0,
                                                          "uploadThroughput": 0})
        self.prefer("light")
        self.driver.get(page.as_uri())
        self.driver.set_script_timeout(60)
        WebDriverWait(self.driver, 120).until(lambda d: self.script("document.documentElement.dataset.ready") == "yes")

    def command(self, name, words):
        return self.driver.execute_cdp_cmd(name, words)

    def script(self, expression):
        return self.driver.execute_script(f"return {expression}")

    def element(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def prefer(self, scheme):
        self.command("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def traces(self, chart):
        return self.script(f"document.getElementById('{chart}').data.map(trace => Object.fromEntries("
                           "['name', 'x', 'y', 'z', 'customdata', 'mode', 'text'].map(key => [key, trace[key]])))")

    def picture(self, name, selector=None):
        if selector:
            self.driver.execute_script("arguments[0].scrollIntoView()", self.element(selector))
            self.element(selector).screenshot(str(self.folder / name))
            return
        height, step = self.script("document.documentElement.scrollHeight"), 1600
        for part, top in enumerate(range(0, height, step)):
            shot = self.command("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": {
                "x": 0, "y": top, "width": 1100, "height": min(step, height - top), "scale": 1}})
            (self.folder / f"{name}_{part}.png").write_bytes(base64.b64decode(shot["data"]))

    def requests(self):
        """Addresses that were asked for, the page's own and its own pictures left out."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        addresses = [event["params"]["request"]["url"] for event in events
                     if event["method"] == "Network.requestWillBeSent"]
        assert any(address.startswith("file:") for address in addresses), "the log of requests is empty"
        return [address for address in addresses
                if not address.startswith(("data:", "blob:")) and not address.endswith("/report.html")]

    def complaints(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]


def expect_close(found, expected, what, relative=1e-9):
    np.testing.assert_allclose(found, expected, rtol=relative, atol=1e-9, err_msg=what)


def loading(observables):
    return observables[observables["phase"] == 0]


def check_top_force(reader, run):
    """Means over replicas and their standard errors, and what the pointer reads."""
    curves = [trace for trace in reader.traces("top_force") if trace["name"] == "MC-DEM"]
    forces = np.array([loading(run[f"observables/replica_{r:05}"][:])["wall_force"][:, PLATE, 2] for r in (2, 3)])
    plate = loading(run["observables/replica_00002"][:])["plate_z"]
    start = run["particles/replica_00002/box"].attrs["edges"][2]
    expect_close(curves[0]["x"], (start - plate) * 1e3, "displacements", 1e-6)
    expect_close(curves[0]["y"], forces.mean(axis=0), "top forces")
    expect_close(curves[0]["customdata"], forces.std(axis=0, ddof=1) / np.sqrt(2), "standard errors")
    number = next(n for n, trace in enumerate(reader.traces("top_force"))
                  if trace["name"] == "MC-DEM" and trace["mode"] != "lines")
    last = len(curves[0]["y"]) - 1
    reader.driver.execute_script(
        f"Plotly.Fx.hover('top_force', [{{curveNumber: {number}, pointNumber: {last}}}])")
    words = reader.element("#top_force .hoverlayer").text
    assert f"{forces.mean(axis=0)[-1]:.4g} N ±" in words, (words, forces.mean(axis=0)[-1])


def check_log_axes(reader):
    button = reader.element("button[data-log=top_force]")
    axis = "document.getElementById('top_force').layout.yaxis.type"
    assert reader.script(axis) != "log"
    reader.driver.execute_script("arguments[0].click()", button)
    assert reader.script(axis) == "log" and button.get_attribute("aria-pressed") == "true"
    reader.picture("log_axes.png", "figure:has(#top_force)")
    reader.driver.execute_script("arguments[0].click()", button)
    assert reader.script(axis) != "log"


def grains_on_page(reader, grains):
    """Centres [mm] of the spheres, and the force on each [mN], from the drawn triangles' corners."""
    mesh = reader.script("(() => { const t = document.getElementById('packing').data.find(t => t.name === 'grains');"
                         "return [t.x, t.y, t.z, t.intensity]; })()")
    x, y, z, intensity = (np.array(column).reshape(grains, -1) for column in mesh)
    return np.stack([x.mean(axis=1), y.mean(axis=1), z.mean(axis=1)], axis=1), intensity[:, 0]


def check_packing(reader, run, replica, scan):
    """Positions and forces of one scan against the file."""
    where = run[f"particles/replica_{replica:05}"]
    expected = where["position/value"][scan] * 1e3
    offset = run[f"contacts/replica_{replica:05}/offset"][:]
    contacts = run[f"contacts/replica_{replica:05}/contact"][offset[scan]:offset[scan + 1]]
    force = np.linalg.norm(contacts["force"].astype(float), axis=1) * 1e3
    load = np.zeros(len(expected))
    np.add.at(load, contacts["grain"], force)
    np.add.at(load, contacts["partner"][contacts["partner"] >= 0], force[contacts["partner"] >= 0])
    centres, found = grains_on_page(reader, len(expected))
    np.testing.assert_allclose(centres, expected, atol=6e-3, err_msg="centres [mm]")
    np.testing.assert_allclose(found, load, rtol=1e-3, atol=1e-3, err_msg="forces on grains [mN]")
    lines = reader.script("document.getElementById('packing').data.filter(t => t.name === 'force chains')"
                          ".map(t => t.x.length / 4)")
    assert sum(lines) == len(contacts), (lines, len(contacts))
    plate = run[f"observables/replica_{replica:05}"][scan]["wall_force"][PLATE, 2]
    assert f"top force {plate:.4g} N" in reader.element(".packing output").text


def check_slider(reader, run):
    slider = reader.element(".packing input")
    scans = len(run["observables/replica_00000"])
    assert slider.get_attribute("max") == str(scans - 1), "all scans of so small a run are shown"
    check_packing(reader, run, 0, 0)
    reader.picture("packing_first.png", ".packing")
    for key, scan in ((Keys.ARROW_RIGHT, 1), (Keys.END, scans - 1), (Keys.HOME, 0)):
        slider.send_keys(key)
        check_packing(reader, run, 0, scan)
    for _ in range(scans // 2):  # full stroke
        slider.send_keys(Keys.ARROW_RIGHT)
    Select(reader.element(".packing .setting")).select_by_visible_text("MC-DEM")
    check_packing(reader, run, 2, scans // 2)
    reader.picture("packing_full_stroke.png", ".packing")
    for what in ("grains", "chains"):
        Select(reader.element(".packing .what")).select_by_value(what)
        reader.picture(f"packing_{what}.png", ".packing")
    Select(reader.element(".packing .what")).select_by_value("both")
    slider.send_keys(Keys.END)
    reader.picture("packing_last.png", ".packing")


def check_diagnosis(reader, diagnosis):
    scores = reader.traces("which")[0]["x"]
    expect_close(scores, [cause["score"] for cause in diagnosis["ranking"]], "scores")
    shown = [z for row in reader.traces("where")[0]["z"] for z in row if z is not None]
    expect_close(sorted(shown), sorted(cell["z_score"] for cell in diagnosis["cells"] if cell["z_score"] is not None),
                 "z scores")


def background(reader):
    return reader.script("getComputedStyle(document.body).backgroundColor")


def ink(reader):
    return reader.script("getComputedStyle(document.querySelector('#top_force .xtick text')).fill")


def check_themes(reader):
    """The screen's wish, then the reader's, which counts for more."""
    light, dark = "rgb(255, 255, 255)", "rgb(22, 24, 27)"
    assert background(reader) == light and ink(reader) == "rgb(28, 31, 35)"
    reader.picture("light")
    reader.prefer("dark")
    WebDriverWait(reader.driver, 30).until(lambda d: background(reader) == dark and ink(reader) == "rgb(230, 232, 235)")
    reader.picture("dark")
    reader.element("#theme").click()
    WebDriverWait(reader.driver, 30).until(lambda d: background(reader) == light and ink(reader) == "rgb(28, 31, 35)")
    reader.element("#theme").click()
    WebDriverWait(reader.driver, 30).until(lambda d: background(reader) == dark and ink(reader) == "rgb(230, 232, 235)")


def check_print(reader):
    """Whole, and the screen stays as it was."""
    pdf = base64.b64decode(reader.command("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})["data"])
    (reader.folder / "report.pdf").write_bytes(pdf)
    assert pdf.startswith(b"%PDF") and len(pdf) > 50_000
    assert background(reader) == "rgb(22, 24, 27)", "as before printing"


def check_texts(reader):
    assert "small <img src=x onerror=alert(1)>" in reader.element("h1").text
    assert not reader.driver.find_elements(By.CSS_SELECTOR, "img[src=x]")
    assert "SHA-256 of run.h5" in reader.element("main").text
    assert reader.element("#trouble").get_attribute("hidden") is not None


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    browser().quit()  # skips before the run is made
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    make_report(program, folder)
    reader = Reader(folder / "report.html", folder)
    try:
        check_texts(reader)
        with h5py.File(folder / "run/run.h5") as run:
            check_top_force(reader, run)
            check_log_axes(reader)
            check_slider(reader, run)
        check_diagnosis(reader, json.loads((folder / "diagnosis/diagnosis.json").read_text()))
        check_themes(reader)
        check_print(reader)
        assert reader.requests() == [], reader.requests()
        assert reader.complaints() == [], reader.complaints()
    finally:
        reader.driver.quit()


if __name__ == "__main__":
    main()
