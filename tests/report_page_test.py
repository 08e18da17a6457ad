"""Reports of a plate and of a cell, opened in headless Chromium without a network: hover, camera, dark theme, print.

report_page_test.py PROGRAM FOLDER; makes a run, a diagnosis and their reports in FOLDER, and saves screenshots there.
Exit code 77: a required program or module is missing.
"""
import json
import pathlib
import shutil
import subprocess
import sys

try:
    import h5py
    from selenium.webdriver.support.ui import WebDriverWait

    from report import page_cell, page_charts, page_packing, page_print, page_tables, page_truth
    from report.page_diagnosis import check_diagnosis_charts
    from report.page_reader import Reader, browser
except ImportError as missing:
    print(f"skipped: {missing}; install python3-selenium, python3-h5py and python3-numpy")
    sys.exit(77)

EXPERIMENTS = {"reality": "mc_dem #1", "repeated": "mc_dem #2"}
NAME = "small <img src=x onerror=alert(1)>"
REFERENCE = ", ".join(f"{NAME}, {replica}" for replica in EXPERIMENTS.values())


def make_reports(program, folder):
    """One page has two settings with two replicas each and a diagnosis; another compares the run with two
    experiments."""
    def mcdem(*words):
        subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, timeout=500)

    (folder / "scene.toml").write_text(f'name = "{NAME}"' + page_truth.PLATE_SCENE)
    (folder / "cell.toml").write_text(page_truth.CELL_SCENE)
    mcdem("run", "cell.toml", "--out", "cell", "--no-figures")
    mcdem("report", "cell", "--out", "cell.html")
    mcdem("run", "scene.toml", "--out", "run", "--no-figures")
    for number, (experiment, replica) in enumerate(EXPERIMENTS.items()):
        mcdem("experiment", "from-run", "run", "--replica", replica, "--seed", str(number), "--out", experiment)
    mcdem("diagnose", "scene.toml", "--experiment", "reality", "--out", "diagnosis", "--replicates", "8",
          "--pairs", "2", "--confirmations", "2", "--candidates", "cross_contact,adhesion,friction,stiffening")
    mcdem("report", "run", "diagnosis", "--out", "report.html")
    against = ("--against", "reality", "--against", "repeated", "--displacement", "0.011")
    mcdem("report", "run", *against, "--out", "against.html")
    mcdem("figures", "run", "--out", "figures")
    mcdem("figures", "run", *against, "--out", "figures_against")


def background(reader):
    return reader.script("getComputedStyle(document.body).backgroundColor")


def ink(reader):
    return reader.script("getComputedStyle(document.querySelector('#top_force .xtick text')).fill")


def check_themes(reader):
    """The theme of the system, and the reader's choice, which takes precedence."""
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


def check_texts(reader):
    assert NAME in reader.element("h1").text
    assert not reader.elements("img[src=x]")
    assert reader.element("#trouble").get_attribute("hidden") is not None


def check_tables(reader, program, run):
    parts = reader.parts()
    page_tables.check_run_origin(parts, run, reader.folder)
    page_tables.check_metrics(parts, program, reader.folder)


def check_report(reader, program, run):
    """Checks the page of the run alone and its diagnosis."""
    check_texts(reader)
    check_tables(reader, program, run)
    page_charts.check_run_charts(reader, values_of(reader.folder / "figures"))
    check_diagnosis_charts(reader, values_of(reader.folder / "diagnosis"), reader.folder / "reality")
    page_charts.check_log_buttons(reader)
    page_packing.check_slider(reader, run, (0, 2))
    check_themes(reader)
    page_cell.check_svg(reader, "top_force", ("plate displacement [mm]", "top force [N]", "MC-DEM"))
    page_print.check_print(reader)
    assert background(reader) == "rgb(22, 24, 27)", "as before printing"


def values_of(folder):
    return json.loads((folder / "figures.json").read_text())


def check_against(reader, program, run):
    """The run compared with experiments: their points, and contacts per grain above the best thresholds."""
    figures = values_of(reader.folder / "figures_against")
    assert [series["words"] for series in figures["top_force"]["series"]][2:] == [REFERENCE[:43] + "…"]
    assert [series["remark"][:4] for series in figures["coordination"]["series"]] == ["tau ", "tau ", ""]
    page_charts.check_run_charts(reader, figures)
    page_tables.check_comparison(reader.parts(), program, reader.folder, EXPERIMENTS, REFERENCE)


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    page_print.need_programs()  # skips before the run is made
    browser().quit()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    make_reports(program, folder)
    with h5py.File(folder / "run/run.h5") as run:
        for page, check in (("against.html", check_against), ("report.html", check_report)):
            with Reader(folder / page) as reader:
                check(reader, program, run)
                reader.check_alone()
    with h5py.File(folder / "cell/run.h5") as run, Reader(folder / "cell.html") as reader:
        page_cell.check_cell(reader, run)
        reader.check_alone()


if __name__ == "__main__":
    main()
