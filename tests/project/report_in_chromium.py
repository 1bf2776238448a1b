#!/usr/bin/env python3
"""Opens pages of `tethercalc report` in headless Chromium: nothing is fetched, nothing complains,
every section is there, nothing is wider than a phone, and text stands out in light and dark.

report_in_chromium.py TETHERCALC PROJECT FOLDER     screenshots and a PDF are left in FOLDER
"""

import base64
import fcntl
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

DESKTOP, PHONE, SMALLEST = 1280, 390, 320


class Browser:
    """Chromium, spoken to through a pair of pipes in its DevTools protocol."""

    def __init__(self, program, profile):
        to_browser, self.commands = os.pipe()
        self.answers, from_browser = os.pipe()

        def pipes_as_3_and_4():
            high = [fcntl.fcntl(fd, fcntl.F_DUPFD, 10) for fd in (to_browser, from_browser)]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--no-first-run", "--disable-background-networking", "--disable-extensions",
             "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={profile}",
             "--remote-debugging-pipe", "about:blank"],
            preexec_fn=pipes_as_3_and_4, pass_fds=(3, 4), stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.count = 0
        self.session = None
        self.events = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target,
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(domain + ".enable")

    def receive(self):
        while b"\0" not in self.buffer:
            chunk = os.read(self.answers, 1 << 16)
            if not chunk:
                raise RuntimeError("Chromium ended")
            self.buffer += chunk
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") != self.count:
                self.events.append(answer)
            elif "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']}")
            else:
                return answer["result"]

    def wait_for(self, event):
        while all(e.get("method") != event for e in self.events):
            self.events.append(self.receive())

    def open(self, page, width=DESKTOP, scheme="light", media=""):
        """Loads the page anew; returns every request that it made and all that was complained of."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900,
                  deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia", media=media,
                  features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.events.clear()
        self.call("Page.navigate", url=page.as_uri())
        self.wait_for("Page.loadEventFired")
        # Frames that a page draws and what it does on its own come after the load.
        self.value("new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))")
        requests = [e["params"]["request"]["url"] for e in self.events
                    if e.get("method") == "Network.requestWillBeSent"]
        complaints = [json.dumps(e["params"]) for e in self.events if e.get("method") in
                      ("Log.entryAdded", "Runtime.consoleAPICalled", "Runtime.exceptionThrown")]
        return requests, complaints

    def value(self, script):
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(json.dumps(result["exceptionDetails"]))
        return result["result"].get("value")

    def screenshot(self, file):
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        image = self.call("Page.captureScreenshot", captureBeyondViewport=True,
                          clip={"x": 0, "y": 0, "width": size["width"], "height": size["height"],
                                "scale": 1})
        file.write_bytes(base64.b64decode(image["data"]))

    def pdf(self, file):
        file.write_bytes(base64.b64decode(
            self.call("Page.printToPDF", preferCSSPageSize=True, paperWidth=8.27,
                      paperHeight=11.69)["data"]))

    def close(self):
        try:
            os.write(self.commands, b'{"id": 0, "method": "Browser.close"}\0')
            self.process.wait(10)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()


# Texts, those of figures included, whose contrast with what lies behind them is below 4.5 : 1 (WCAG
# 2.2, 1.4.3), and lines of figures below 2 : 1, which is what the lightest of the usual colours has
# on white.
LOW_CONTRAST = """(() => {
  const channels = c => c.match(/[\\d.]+/g).map(Number);
  const luminance = c => channels(c).slice(0, 3)
    .map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = e => {
    for (; e; e = e.parentElement) {
      const c = getComputedStyle(e).backgroundColor;
      const [, , , alpha = 1] = channels(c);
      if (alpha > 0) return c;
    }
    return 'rgb(255, 255, 255)';
  };
  const low = [];
  for (const e of document.querySelectorAll('body *:not(svg *), svg text, svg path[stroke]')) {
    const line = e.tagName === 'path' && !e.classList.contains('paper');
    if (!line && ![...e.childNodes].some(n => n.nodeType === 3 && n.data.trim())) continue;
    const own = getComputedStyle(e)[line ? 'stroke' : e.tagName === 'text' ? 'fill' : 'color'];
    const [a, b] = [luminance(own), luminance(behind(e))];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < (line ? 2 : 4.5)) low.push(`${e.tagName} "${e.textContent.slice(0, 30)}" ${ratio.toFixed(2)}`);
  }
  return low;
})()"""

# What lies outside of the page's width although no box around it scrolls or ends there.
OVERFLOWING = """(() => {
  const width = document.documentElement.clientWidth;
  const out = [`scrollWidth ${document.documentElement.scrollWidth} of ${width}`]
    .filter(() => document.documentElement.scrollWidth > width);
  for (const e of document.querySelectorAll('body *:not(svg *)')) {
    if (e.getBoundingClientRect().right > width + 0.5 && !e.closest('.scroll > *'))
      out.push(e.tagName + ' "' + e.textContent.slice(0, 30) + '"');
  }
  return out;
})()"""

# Boxes that scroll without showing it: nothing in them moves over the shades at their edges.
UNMARKED_SCROLLING = """[...document.querySelectorAll('.scroll')].filter(e =>
  e.scrollWidth > e.clientWidth && !(getComputedStyle(e).backgroundImage.includes('gradient') &&
  getComputedStyle(e).backgroundAttachment.includes('local'))).length"""

# Places where a text begins on a page, from top to bottom, of pages that Chromium writes.
def lines_of_pages(pdf):
    content = pdf.read_bytes()
    objects = {int(number): text for number, text in
               re.findall(rb"(\d+) 0 obj\s(.*?)endobj", content, re.S)}
    lines = []
    for text in objects.values():
        if not re.search(rb"/Type\s*/Page\b", text):
            continue
        stream = objects[int(re.search(rb"/Contents (\d+) 0 R", text).group(1))]
        # Not zlib.decompress: where the stream itself ends in a carriage return, the pattern takes it.
        packed = re.search(rb"stream\r?\n(.*?)\r?\nendstream", stream, re.S).group(1)
        drawn = zlib.decompressobj().decompress(packed)
        lines.append(drawn.count(b"BT"))
    return lines


failures = []


def expect(what, found, wanted):
    if found != wanted:
        failures.append(f"{what}: {found!r} instead of {wanted!r}")


def check_page(browser, page, sections):
    for scheme, width in (("light", DESKTOP), ("dark", PHONE), ("light", SMALLEST)):
        where = f"{page.name}, {scheme}, {width} wide"
        requests, complaints = browser.open(page, width, scheme)
        expect(f"{where}: requests", requests, [page.as_uri()])
        expect(f"{where}: console", complaints, [])
        expect(f"{where}: low contrast", browser.value(LOW_CONTRAST), [])
        expect(f"{where}: overflow", browser.value(OVERFLOWING), [])
        expect(f"{where}: scrolls and does not look like it", browser.value(UNMARKED_SCROLLING), 0)
        paper = browser.value("[...document.querySelectorAll('svg .paper')].map(e => "
                              "getComputedStyle(e).color === getComputedStyle(document.body)"
                              ".backgroundColor)")
        expect(f"{where}: figures on other paper than the page", paper.count(False), 0)
        if width == DESKTOP:
            expect(f"{where}: tables that need scrolling", browser.value(
                "[...document.querySelectorAll('div.scroll')].filter(e => e.scrollWidth >"
                " e.clientWidth).map(e => e.textContent.slice(0, 30))"), [])
        if width != SMALLEST:
            picture = page.with_name(f"{page.stem}-{width}-{scheme}.png")
            browser.screenshot(picture)
            wide, high = struct.unpack(">II", picture.read_bytes()[16:24])  # in a PNG's header
            expect(f"{where}: screenshot", (width - 20 <= wide <= width, high > 2000), (True, True))
    expect(f"{page.name}: sections",
           browser.value("[...document.querySelectorAll('main > section > h2')].map(h => h.id)"),
           sections)
    expect(f"{page.name}: figures that show nothing",
           browser.value("[...document.querySelectorAll('svg')].filter(s =>"
                         " s.getBBox().width < 100 || s.getClientRects()[0].width < 200).length"),
           0)
    expect(f"{page.name}: boxes that scroll and the keyboard cannot reach",
           browser.value("[...document.querySelectorAll('*')].filter(e => e.scrollWidth >"
                         " e.clientWidth && getComputedStyle(e).overflowX === 'auto' &&"
                         " e.tabIndex < 0).length"), 0)
    browser.open(page, scheme="dark", media="print")
    expect(f"{page.name}: colours of paper on paper",
           browser.value("getComputedStyle(document.querySelector('svg .blue')).color"),
           "rgb(0, 114, 178)")
    expect(f"{page.name}: contents on paper",
           browser.value("getComputedStyle(document.querySelector('nav')).display"), "none")
    browser.pdf(page.with_suffix(".pdf"))
    lines = lines_of_pages(page.with_suffix(".pdf"))
    expect(f"{page.name}: pages of the PDF", len(lines) >= len(sections) - 1, True)
    expect(f"{page.name}: pages of few texts", [n for n in lines if n < 12], [])


def check_policy(browser, page):
    """What a page must not do is noticed here, and is stopped by its own policy."""
    bad = page.with_name("with script and picture.html")
    bad.write_text(page.read_text().replace(
        "<main>", "<main><script>document.title = 'ran'</script>"
        "<img src='http://example.invalid/picture.png' alt=''/>"))
    _, complaints = browser.open(bad)
    expect("a script and a picture from elsewhere, refused", len(complaints), 2)
    expect("the script's doing", browser.value("document.title === 'ran'"), False)
    open_page = page.with_name("without policy.html")
    open_page.write_text(bad.read_text().replace("http-equiv=", "data-was="))
    requests, _ = browser.open(open_page)
    expect("a request of a page without a policy", requests[1:],
           ["http://example.invalid/picture.png"])


def main():
    command, project, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    if not program:
        print("SKIPPED: chromium is not installed")
        return 0
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    examples = project / "examples"
    spec = str(examples / "holybro-x500.json")
    flight = ["--flight", str(examples / "simulated-flight.csv"), "--mass-g", "1550"]
    hostile = "<script>alert(1)</script>]]>\"'&" + "W" * 270

    def report(name, arguments, code):
        page = folder.resolve() / f"{name}.html"
        done = subprocess.run([command, "report", *arguments, "--output", str(page)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        expect(f"{name}: exit code ({done.stderr})", done.returncode, code)
        return page

    around = ["answer", "cross-sections", "motors"], ["explained", "spec", "method"]
    pages = [
        (report("design", [spec], 0), around[0] + around[1]),
        (report("flight", [spec, *flight], 0), around[0] + ["drag", "flight-diagnosis"] + around[1]),
        (report("rules", [spec, "--rules", "eu-c3"], 0),
         around[0] + ["rules"] + around[1]),
        (report("<script>'\" &amp; #%41?", [spec, "--set", "supply.voltage_V=40", "--set",
                                            "name=" + hostile], 1), around[0] + around[1]),
    ]
    if failures:
        return report_failures()
    with tempfile.TemporaryDirectory() as profile:
        started = time.monotonic()
        browser = Browser(program, profile)
        try:
            for page, sections in pages:
                check_page(browser, page, sections)
            expect("the name", browser.value("document.querySelector('h1').textContent"), hostile)
            check_policy(browser, pages[0][0])
        finally:
            browser.close()
        print(f"{len(pages)} pages looked at in {time.monotonic() - started:.1f} s")
    return report_failures()


def report_failures():
    for failure in failures:
        print(failure, file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
