#!/usr/bin/env python3
"""Reports in a browser: headless Chromium opens pages written by the program.

usage: test_page.py LENSPROF    exit 0 if all tests pass, 77 if Chromium is missing

A script in a copy of each page collects console messages, errors and violations of the content security policy,
operates the page as a reader would, and stores its findings in the document.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77
LEAST_CONTRAST = 4.5  # WCAG 2.1, level AA, for text
LENSFUN = pathlib.Path("/usr/share/lensfun/version_1")

LISTEN = """<script>
const messages = [];
for (const kind of ['log', 'info', 'warn', 'error', 'debug'])
  console[kind] = (...words) => messages.push(kind + ': ' + words.join(' '));
addEventListener('error', (event) => messages.push('error: ' + event.message));
addEventListener('securitypolicyviolation', (event) => messages.push('policy: ' + event.violatedDirective));
</script>"""

OPERATE = """<script>
function luminance(colour) {
  const part = (value) => { value /= 255; return value <= 0.03928 ? value / 12.92 : Math.pow((value + 0.055) / 1.055, 2.4); };
  return 0.2126 * part(colour[0]) + 0.7152 * part(colour[1]) + 0.0722 * part(colour[2]);
}
const colourOf = (text) => text.match(/[0-9.]+/g).map(Number);
function backgroundOf(element) {
  for (; element; element = element.parentElement) {
    const colour = colourOf(getComputedStyle(element).backgroundColor);
    if (colour.length < 4 || colour[3] === 1) return colour;
  }
  return [255, 255, 255];
}
function contrasts() {
  const found = {least: 99, text: '', count: 0};
  for (const element of document.querySelectorAll('h1, h2, p, dt, dd, td, th, text, summary, strong, figcaption, label, button')) {
    if (!element.textContent.trim() || element.closest('.compare') || element.querySelector('img')) continue;
    const style = getComputedStyle(element), inSvg = element.namespaceURI.endsWith('svg');
    const a = luminance(colourOf(inSvg ? style.fill : style.color)), b = luminance(backgroundOf(element));
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    found.count++;
    if (contrast < found.least) { found.least = contrast; found.text = element.textContent.slice(0, 40); }
  }
  return found;
}
addEventListener('load', () => setTimeout(() => {
  const found = {contrast: contrasts(), charts: document.querySelectorAll('svg.chart').length,
    paths: document.querySelectorAll('svg .curve').length, headings: document.querySelectorAll('h2').length,
    overflow: document.documentElement.scrollWidth - innerWidth};
  const slider = document.querySelector('.compare input');
  if (slider) {
    const box = slider.parentElement;
    slider.focus();
    found.focused = document.activeElement === slider;
    slider.value = 20;
    slider.dispatchEvent(new Event('input'));
    found.cut = getComputedStyle(box.querySelector('.after')).clipPath;
    found.pictures = [...box.querySelectorAll('img')].map((image) => image.naturalWidth);
    const buttons = document.querySelectorAll('.views button');
    found.views = buttons.length;
    buttons[1].click();
    found.second = document.querySelector('.compare img').alt;
  }
  const search = document.querySelector('input[type=search]');
  if (search) {
    const rows = () => document.querySelectorAll('.lenses tbody tr').length;
    found.all = rows();
    search.value = 'canon 24-70';
    search.dispatchEvent(new Event('input'));
    found.matching = rows();
    document.querySelector('.lenses button').click();
    found.shown = document.querySelectorAll('h2')[1].textContent;
    found.curves = document.querySelectorAll('svg .curve').length;
  }
  found.messages = messages;
  const result = document.createElement('pre');
  result.id = 'checked';
  result.textContent = JSON.stringify(found);
  document.body.append(result);
}, 300));
</script>"""


def chromium():
    return next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None)


class Browser:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, page, width, is_dark, *more):
        words = [self.program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run",
                 f"--user-data-dir={self.folder / 'browser'}", f"--window-size={width},2000",
                 "--virtual-time-budget=4000", *(["--blink-settings=preferredColorScheme=0"] if is_dark else []), *more,
                 page.as_uri()]
        return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=120, check=False).stdout

    def check(self, page, width=1200, is_dark=False):
        """The findings of OPERATE."""
        text = page.read_text(encoding="utf-8")
        copy = page.with_name("checked-" + page.name)
        copy.write_text(text.replace("<link", LISTEN + "<link", 1).replace("</body>", OPERATE + "</body>"), encoding="utf-8")
        found = re.search(r'<pre id="checked">(.*?)</pre>', self.run(copy, width, is_dark, "--dump-dom").decode(), re.DOTALL)
        assert found, f"{page}: the page did not finish"
        unescaped = found[1].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
        return json.loads(unescaped)

    def screenshot_bytes(self, page, width, is_dark):
        target = self.folder / f"{page.stem}-{width}-{'dark' if is_dark else 'light'}.png"
        self.run(page, width, is_dark, f"--screenshot={target}")
        return target.stat().st_size


DESKTOP, PHONE, DARK = (1200, False), (500, False), (1200, True)


def check_page(browser, page, least_charts, ways):
    """No messages, nothing wider than the page, sufficient contrast."""
    for width, is_dark in ways:
        found = browser.check(page, width, is_dark)
        where = f"{page.name}, width {width}, {'dark' if is_dark else 'light'}: {found}"
        assert found["messages"] == [], where
        assert found["charts"] >= least_charts and found["paths"] >= 1, where
        assert found["overflow"] <= 0, where
        assert found["contrast"]["count"] > 10 and found["contrast"]["least"] >= LEAST_CONTRAST, where
        assert browser.screenshot_bytes(page, width, is_dark) > 60000, f"{where}: the screenshot is blank"
    return found


def write_card(path, corner):
    """A grey PNG of 16 bits of an even light, whose corners are darker by this share."""
    width, height = 96, 64
    rows = b""
    for y in range(height):
        values = (40000 * (1 - corner * (((x - 47.5) ** 2 + (y - 31.5) ** 2) / 3328)) for x in range(width))
        rows += b"\0" + b"".join(int(value).to_bytes(2, "big") for value in values)
    head = width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([16, 0, 0, 0, 0])

    def chunk(kind, data):
        return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")

    path.parent.mkdir(parents=True)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    )


def main():
    lensprof = pathlib.Path(sys.argv[1]).resolve()
    if not chromium():
        print("skipped: Chromium is not installed (packages-test.txt)")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        browser = Browser(chromium(), folder)

        def run(*words, code=0):
            ended = subprocess.run([lensprof, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            assert ended.returncode == code, words

        run("simulate", "-o", "pictures", "--images", "4", "--size", "640x480")
        run("report", "pictures/pano.pto", "-o", "fit.html")
        found = check_page(browser, folder / "fit.html", 8, (PHONE, DARK, DESKTOP))
        assert found["focused"] and "20%" in found["cut"], found
        assert all(width > 300 for width in found["pictures"]) and len(found["pictures"]) == 2, found
        assert found["views"] == 5 and "img000.png" in found["second"], found

        run("profile", "import", "--db", "lenses.db", *sorted(map(str, LENSFUN.glob("slr-*.xml"))))
        run("report", "lenses.db", "-o", "lenses.html")
        found = check_page(browser, folder / "lenses.html", 1, (PHONE, DESKTOP))
        assert found["all"] > found["matching"] > 0, found
        assert "24-70" in found["shown"] and found["curves"] >= 2, found

        doctor = subprocess.run([lensprof, "doctor"], stdout=subprocess.PIPE, check=True).stdout
        if re.search(rb"OpenCV +yes", doctor):
            run("calibrate", "pictures", "-o", "out", "--db", "own.db", "--report", "folder.html")
            found = check_page(browser, folder / "folder.html", 8, (PHONE, DESKTOP))
            assert found["views"] == 5 and "img000.png" in found["second"], found

        run("report", "--db", "lenses.db", "--profile", "1", "-o", "one.html")
        check_page(browser, folder / "one.html", 2, (DARK,))

        for unit, corner in (("a", 0.3), ("b", 0.301), ("c", 0.302), ("d", 0.4)):
            write_card(folder / "line" / unit / "card.png", corner)
        run("flat", "line", "--linear", "--no-store", "--units", "by=folder", "--report", "units.html", code=4)
        check_page(browser, folder / "units.html", 6, (PHONE, DARK, DESKTOP))
    print("all pages work")


if __name__ == "__main__":
    main()
