"""The printed page: its headings as text, and colours in every figure. Reads the PDF with poppler's programs."""
import base64
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

import numpy as np

DOTS = 100  # per inch
PROGRAMS = ("pdftotext", "pdftoppm")


def need_programs():
    for program in PROGRAMS:
        if not shutil.which(program):
            print(f"skipped: no {program}; install poppler-utils")
            sys.exit(77)


def lines_of(pdf):
    """(page, upper edge [dots], words) of every line of text."""
    text = subprocess.run(["pdftotext", "-bbox-layout", pdf, "-"], check=True, capture_output=True, timeout=100).stdout
    root = xml.fromstring(re.sub(rb"[\x00-\x08\x0b\x0c\x0e-\x1f]", b"", text))
    pages = [element for element in root.iter() if element.tag.endswith("}page")]
    return [(number, float(line.get("yMin")) * DOTS / 72, " ".join(word.text or "" for word in line))
            for number, page in enumerate(pages) for line in page.iter() if line.tag.endswith("}line")]


def pictures_of(pdf):
    """Every page as an RGB array."""
    subprocess.run(["pdftoppm", "-r", str(DOTS), pdf, pdf.with_suffix("")], check=True, timeout=100)
    return [picture(file) for file in sorted(pdf.parent.glob(pdf.stem + "-*.ppm"))]


def picture(file):
    magic, size, _, pixels = file.read_bytes().split(b"\n", 3)
    assert magic == b"P6"
    width, height = map(int, size.split())
    return np.frombuffer(pixels, np.uint8).reshape(height, width, 3).astype(int)


def coloured(pixels):
    """Number of pixels that are not grey, without legends and colour bars on the right."""
    pixels = pixels[:, :pixels.shape[1] * 7 // 10]
    return int((pixels.max(axis=2) - pixels.min(axis=2) > 60).sum())


def squeezed(words):
    return "".join(words.split())


def place_of(title, lines, since):
    """Index of the first line from `since` on that equals this title."""
    for number in range(since, len(lines)):
        if squeezed(lines[number][2]) == squeezed(title):
            return number
    raise AssertionError(f"on paper there is no {title!r}")


def check_headings(headings, lines):
    """All headings in the page's order; lines with the position of the heading."""
    text, since = squeezed(" ".join(words for _, _, words in lines)), 0
    for heading in headings:
        since = text.find(squeezed(heading), since)
        assert since >= 0, f"on paper there is no {heading!r}, or not in its place"
        since += len(squeezed(heading))


def check_colours(figures, lines, pages):
    """The area below each figure's title, down to its caption, on one page."""
    since = 0
    for title, caption in figures:
        since = place_of(title, lines, since)
        page, top, _ = lines[since]
        below = [y for p, y, words in lines[since:] if p == page and squeezed(caption).startswith(squeezed(words))]
        assert below, f"{title!r}: caption and title are not on one page"
        count = coloured(pages[page][int(top):int(below[0])])
        assert count > 300, f"{title!r}: {count} coloured pixels on paper"


def check_print(reader):
    pdf = reader.folder / "report.pdf"
    for old in reader.folder.glob("report-*.ppm"):
        old.unlink()
    pdf.write_bytes(base64.b64decode(
        reader.command("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69, "printBackground": True})["data"]))
    lines = lines_of(pdf)
    check_headings([part["content"] for part in reader.parts() if part["tag"] in ("h1", "h2", "h3")], lines)
    figures = reader.script("[...document.querySelectorAll('figure')].map(figure => "
                            "['h3', 'figcaption'].map(part => figure.querySelector(part).textContent))")
    assert len(figures) >= 8, figures
    check_colours(figures, lines, pictures_of(pdf))
