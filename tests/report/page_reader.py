"""Operates a page in headless Chromium without a network, and reads what is displayed."""
import base64
import json
import shutil
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

TRACE_KEYS = ["name", "x", "y", "z", "customdata", "mode", "text", "fill", "line", "marker", "error_x", "error_y",
              "hoverinfo"]
# Headings, tables, definitions and collapsed texts in the order of the page, each under its headings.
PARTS = """(() => {
  let section = '', heading = '';
  const text = node => node.textContent, parts = [];
  for (const node of document.querySelectorAll('main :is(h1, h2, h3, table, dl, pre)')) {
    const tag = node.tagName.toLowerCase();
    if (tag === 'h1' || tag === 'h2') { section = text(node); heading = ''; }
    if (tag === 'h3') heading = text(node);
    const content = tag === 'table' ? [...node.rows].map(row => [...row.cells].map(text))
      : tag === 'dl' ? [...node.querySelectorAll('dt')].map(dt => [text(dt), text(dt.nextElementSibling)]) : text(node);
    parts.push({tag, section, heading, content});
  }
  return parts;
})()"""


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
    def __init__(self, page):
        self.driver, self.folder, self.page = browser(), page.parent, page
        self.command("Network.enable", {})
        self.command("Network.emulateNetworkConditions", {"offline": True, "latency": 0, "downloadThroughput": 0,
                                                          "uploadThroughput": 0})
        self.prefer("light")
        self.driver.get(page.as_uri())
        self.driver.set_script_timeout(60)
        WebDriverWait(self.driver, 120).until(lambda d: self.script("document.documentElement.dataset.ready") == "yes")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def command(self, name, words):
        return self.driver.execute_cdp_cmd(name, words)

    def script(self, expression):
        return self.driver.execute_script(f"return {expression}")

    def element(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def elements(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def click(self, element):
        self.driver.execute_script("arguments[0].click()", element)

    def prefer(self, scheme):
        self.command("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def traces(self, chart):
        return self.script(f"document.getElementById('{chart}').data.map(trace => Object.fromEntries("
                           f"{TRACE_KEYS}.map(key => [key, trace[key]])))")

    def axes(self, chart):
        """Type and range of the x and y axes as drawn."""
        return self.script(f"['xaxis', 'yaxis'].map(axis => document.getElementById('{chart}')._fullLayout[axis])"
                           ".map(({type, range}) => [type, [...range]])")

    def hover(self, chart, trace, point):
        """Name and text of the label beside a point."""
        time.sleep(0.06)  # plotly.js delays events that come sooner
        self.driver.execute_script(
            f"Plotly.Fx.hover('{chart}', [{{curveNumber: {trace}, pointNumber: {point}}}])")
        return self.script(f"""['name', 'nums'].map(part => {{
            const text = document.querySelector('#{chart} .hoverlayer .hovertext text.' + part);
            const lines = text ? [...text.querySelectorAll('tspan.line')] : [];
            return lines.length ? lines.map(line => line.textContent).join('\\n') : text ? text.textContent : '';
        }})""")

    def parts(self):
        return self.script(PARTS)

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

    def check_alone(self):
        """Checks that only the page itself and its own pictures were requested, without errors."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        addresses = [event["params"]["request"]["url"] for event in events
                     if event["method"] == "Network.requestWillBeSent"]
        assert any(address.startswith("file:") for address in addresses), "the log of requests is empty"
        others = [address for address in addresses
                  if not address.startswith(("data:", "blob:")) and not address.endswith("/" + self.page.name)]
        assert others == [], others
        complaints = [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
        assert complaints == [], complaints
