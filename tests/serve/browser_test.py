"""misfit open in a real browser (Debian's chromium, driven by python3-selenium). Called by browser_test.cpp: PROGRAM STUDY_FOLDER SCENARIO.

Ends with status 0, or says what was seen and ends with 1.
"""
import atexit
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

PROGRAM, FOLDER = sys.argv[1:3]
STUDY = os.path.join(FOLDER, "study.toml")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Server:
    def __init__(self):
        self.process = subprocess.Popen([PROGRAM, "open", STUDY], stdout=subprocess.PIPE, text=True)
        atexit.register(self.process.kill)
        for line in self.process.stdout:
            if line.startswith("http://127.0.0.1:"):
                self.address = line.strip()
                return
        raise AssertionError("no address was printed")

    def end(self, how=signal.SIGINT):
        self.process.send_signal(how)
        self.process.wait(60)


class Page:
    """The page, as somebody sees it who has eyes, a mouse and keys."""

    def __init__(self, address, scripts=True):
        options = Options()
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--window-size=1280,1000",
                         "--user-data-dir=" + tempfile.mkdtemp(dir=FOLDER)):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        if not scripts:
            options.add_experimental_option("prefs", {"profile.managed_default_content_settings.javascript": 2})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        atexit.register(self.quit)
        if scripts:
            self.open(address)
        else:
            self.driver.get(address)

    def quit(self):
        try:
            self.driver.quit()
        except Exception:  # it has ended already
            pass

    def open(self, address):
        self.driver.get(address)
        self.wait(lambda: self.js("return document.body.dataset.ready"), "the page is ready")

    def js(self, code, *arguments):
        return self.driver.execute_script(code, *arguments)

    def wait(self, done, what, seconds=300):
        end = time.time() + seconds
        while time.time() < end:
            try:
                value = done()
            except Exception:  # the page is being drawn anew
                value = None
            if value:
                return value
            time.sleep(0.1)
        raise AssertionError(f"{what}: not within {seconds} s. The page says: {self.text('body')[:3000]}")

    def frames(self):
        """What the mouse or a key has caused is drawn: two frames later."""
        self.driver.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))")

    def still(self, value, what):
        """The value, once it has not changed for a second."""
        def unchanged():
            before = value()
            time.sleep(1)
            return value() == before
        self.wait(unchanged, f"{what} changes no more")
        return value()

    def one(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector):
        return self.one(selector).text

    def click(self, selector):
        self.wait(lambda: self.one(selector).is_enabled(), f"{selector} can be clicked")
        self.js("arguments[0].scrollIntoView({block: 'center'})", self.one(selector))
        self.one(selector).click()

    def view(self, name):
        self.click(f"[data-view={name}][role=tab]")
        self.wait(lambda: self.one("#view").get_attribute("data-view") == name, f"view {name}")

    def job(self, state, number=None):
        def ended():
            seen = self.js("return {...document.querySelector('#job').dataset}")  # both at one moment
            return seen.get("state") == state and (number is None or seen.get("number") == str(number))
        self.wait(ended, f"the command is {state}")

    def no_faults(self, but="ERR_CONNECTION_REFUSED"):
        """Since the last time it was asked."""
        faults = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE" and but not in e["message"]]
        assert not faults, faults

    def end(self):
        self.no_faults()
        self.driver.quit()


def leave_the_server(page, server):
    """It ends while the page is open: a question that its end meets is refused, reset or empty."""
    page.no_faults()
    server.end()
    page.driver.get("about:blank")
    page.no_faults(but="net::ERR_")


def random_force(page):
    """[unit of the force] As the verdict has it: before, after."""
    match = re.search(r"random force: ([\d.]+)[^\n]*? to ([\d.]+)", page.text("#verdict"))
    assert match, page.text("#verdict")
    return float(match[1]), float(match[2])


def point_at_the_worst_place(page):
    """Over the place of the map whose amplitude is most sigmas from zero; the words that say what is marked."""
    page.wait(lambda: page.one("#view figure .u-over"), "the map")
    over = page.one("#view figure .u-over")
    page.js("arguments[0].scrollIntoView({block: 'center'})", over)
    width = over.size["width"]
    series = "return [...document.querySelectorAll('#time .u-wrap > canvas')].map((c) => c.toDataURL())"
    painted = page.js(series)
    seen = {}
    for k in range(1, 12):
        ActionChains(page.driver).move_to_element_with_offset(over, int(width * (k / 12 - 0.5)), 0).perform()
        page.frames()
        seen[page.text("#marked")] = k
    marked = [words for words in seen if re.match(r"Marked: [1-9]\d* samples with ", words)]
    assert len(marked) >= 4, seen
    assert page.js(series) == painted, "marks stand on a canvas of their own: 50 000 points are not drawn again for each step of the mouse"
    assert page.js("const c = document.querySelector('#motion .u-under canvas'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((v) => v > 0)")
    ActionChains(page.driver).move_to_element_with_offset(over, 0, 0).click_and_hold().move_to_element(page.one("h1")).release().perform()
    over.find_element(By.XPATH, "./ancestor::*[@class='plot']").send_keys("0")  # a drag that ended elsewhere was a zoom
    ActionChains(page.driver).move_to_element_with_offset(over, 0, 0).click().perform()
    page.wait(lambda: int(page.one("#time").get_attribute("data-marks")) > 0, "the marks")
    page.frames()
    fixed = page.text("#marked")
    ActionChains(page.driver).move_to_element(page.one("h1")).perform()
    page.frames()
    assert page.text("#marked") == fixed, "a click keeps the marks"
    return fixed


def keys_in_a_pair_map(page):
    """Every cell is reached, across and upwards, without a mouse; keys that are the browser's stay its own."""
    pair = page.js("return [...document.querySelectorAll('[data-map]')].find((b) => b.textContent.includes(' and '))")
    pair.send_keys(Keys.ENTER)
    plot = page.wait(lambda: page.one("#view figure[data-figure*=_and_] .plot"), "a map over two quantities")
    while page.js("return document.activeElement !== arguments[0]", plot):
        page.driver.switch_to.active_element.send_keys(Keys.SHIFT, Keys.TAB)

    def ranges(key):
        plot.send_keys(key)
        found = re.findall(r"from (\S+) to (\S+)", page.text("#marked"))
        assert len(found) == 2, page.text("#marked")
        return found
    across = [ranges(Keys.ARROW_RIGHT) for _ in range(3)]
    assert len({x for x, _ in across}) == 3, across
    while (lowest := ranges(Keys.ARROW_DOWN)) == ranges(Keys.ARROW_UP):  # back to a column of more than one cell
        assert ranges(Keys.ARROW_LEFT) != lowest, "a column of two cells"
    x, y = ranges(Keys.ARROW_DOWN)
    rows = [ranges(key) for key in (Keys.ARROW_UP, Keys.ARROW_UP, Keys.ARROW_DOWN)]
    assert {row[0] for row in rows} == {x} and len({row[1] for row in rows} | {y}) >= 2, rows
    assert ranges(Keys.ENTER) == rows[-1], "Enter keeps the cell of the cursor, not the first of its column"
    assert int(page.one("#time").get_attribute("data-marks")) > 0
    taken = """return ['+', '-', '0', 'ArrowLeft'].map((key) => !arguments[0].dispatchEvent(
        new KeyboardEvent('keydown', {key, ctrlKey: key !== 'ArrowLeft', altKey: key === 'ArrowLeft', bubbles: true, cancelable: true})))"""
    assert page.js(taken, plot) == [False] * 4, "with Ctrl or Alt they are the browser's"
    page.one("#effect").send_keys(Keys.ESCAPE)
    assert page.text("#marked") != "", "Escape in a list closes the list"
    plot.send_keys(Keys.ESCAPE)
    page.wait(lambda: page.text("#marked") == "", "no marks after Escape")


def what_is_in_hand_stays(page):
    """What is typed, while the study changes under it; the rest of the view when it is asked for."""
    text = read(STUDY)
    page.click("#settings summary")
    box = page.wait(lambda: page.one("[data-box]"), "the box of a roughness")
    box.send_keys("7")
    typed = box.get_attribute("value")
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(text + "no_key = 1\n")
    page.wait(lambda: page.one("#newer").is_displayed(), "something newer can be shown")
    assert box.get_attribute("value") == typed and page.one("#settings").get_attribute("open"), "what is typed stays"
    page.click("#newer button")
    page.wait(lambda: not page.driver.find_elements(By.CSS_SELECTOR, "[data-box]"), "it is shown: a study with an error has no settings")
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(text)
    page.wait(lambda: page.one("[data-box]").is_displayed() and page.one("#settings").get_attribute("open"), "unfolded as before")


def force_of_the_accepted(page, name):
    """Pointing shows the force that it adds, its button keeps it, another view removes it."""
    name = name.replace("_", " ")  # as it is read
    words = f"what {name} adds"
    ActionChains(page.driver).move_to_element(page.one("h1")).perform()
    page.wait(lambda: words not in page.text("#force"), "no force while nothing is pointed at")
    ActionChains(page.driver).move_to_element(page.one("#candidates tr.accepted td.number")).perform()
    page.wait(lambda: words in page.text("#force"), "its force while it is pointed at")
    ActionChains(page.driver).move_to_element(page.one("h1")).perform()
    page.wait(lambda: words not in page.text("#force"), "gone with the mouse")
    page.click("#candidates tr.accepted button.shows")
    ActionChains(page.driver).move_to_element(page.one("h1")).perform()
    page.wait(lambda: words in page.text("#force") and name in page.text("#force .legend"), "kept")
    page.view("ladder")
    page.wait(lambda: words not in page.text("#force"), "gone with the view")
    page.view("candidates")
    page.wait(lambda: page.one("#candidates tr.accepted button.adds"), "the candidates")


def move_the_roughness(page):
    """The curve follows the slider, and goes back."""
    def drawn():
        return page.js("return document.querySelector('#view .u-wrap > canvas').toDataURL()")

    page.view("curves")
    slider = page.wait(lambda: page.one(".slider input"), "the slider of a roughness")
    page.wait(lambda: page.one("#view canvas"), "the curve")
    before = page.still(drawn, "the curve")
    assert re.search(r"λ = [\d.]+\S* .* as fitted, .*; [\d.]+ effective degrees of freedom", page.text(".slider output")), page.text(".slider output")
    assert page.text(".slider").startswith("Smoothness of ") and page.text(".slider .soft:last-of-type") == "smooth", "larger to the right, as its name says"
    page.js("arguments[0].value = arguments[0].max; arguments[0].dispatchEvent(new Event('input'))", slider)
    page.wait(lambda: "(log marginal likelihood)" in page.text(".slider output"), "what the likelihood says")
    page.wait(lambda: drawn() != before, "another curve")
    assert float(re.search(r"([\d.e+]+) times as fitted", page.text(".slider output"))[1]) > 1, "smooth: a larger roughness than fitted"
    page.js("const [s] = [...document.querySelectorAll('.slider input')].slice(1); s.value = s.max; s.dispatchEvent(new Event('input'))")
    page.frames()
    assert drawn() != before, "another curve's slider leaves it"
    page.js("for (const b of document.querySelectorAll('.slider button')) if (b.textContent === 'As fitted') b.click()")
    page.wait(lambda: drawn() == before, "the curve as fitted")


def focused(page):
    return page.js("return document.activeElement.textContent")


def press(page, key):
    """On what has the focus; once more where that was drawn anew meanwhile."""
    page.wait(lambda: page.driver.switch_to.active_element.send_keys(key) is None, "the key is taken")


def remove_asks_first(page):
    """Once, where it stands; a doubt leads back, and the keys stay where they were."""
    number = page.one("#job").get_attribute("data-number")
    page.click("button.removes")
    page.wait(lambda: "Take this rung off the ladder?" in page.text(".asking"), "the question")
    assert focused(page) == "Keep", focused(page)
    text = read(STUDY)
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(text + "no_key = 1\n")
    page.wait(lambda: page.one("#newer").is_displayed(), "what is shown has changed")
    assert focused(page) == "Keep", "the view is not drawn anew under somebody who is asked"
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(text)
    page.wait(lambda: not page.one("#newer").is_displayed(), "it is as before")
    page.js("document.querySelector('#view > div').dataset.seen = 'before'")
    os.utime(os.path.join(FOLDER, "out", "run.json"))
    press(page, Keys.ESCAPE)
    page.wait(lambda: focused(page) == "Remove this rung", "back at the button")
    time.sleep(4)
    assert page.js("return document.querySelector('#view > div').dataset.seen") == "before", "where nothing has changed the view stays"
    press(page, Keys.ENTER)
    page.wait(lambda: focused(page) == "Keep", "asked by a key")
    press(page, Keys.ENTER)
    page.wait(lambda: focused(page) == "Remove this rung", "kept")
    assert page.one("#job").get_attribute("data-number") == number, "nothing was removed"


def zoom_by_dragging(page):
    """A drag over twice the width shows twice the time: it is one zoom, though several plots are synchronised. Keys mark a time."""
    over = page.one("#motion .u-over")
    page.js("arguments[0].scrollIntoView({block: 'center'})", over)
    shown = []
    for width in (60, 120):
        ActionChains(page.driver).move_to_element(over).click_and_hold().move_by_offset(width, 0).release().perform()
        low, high = (float(end) for end in page.wait(lambda: page.js("return document.querySelector('#time').dataset.window"), "the zoom").split())
        shown.append(high - low)
        page.one("#motion .plot").send_keys("0")
        page.wait(lambda: page.js("return document.querySelector('#time').dataset.window") == "", "the whole record")
    assert abs(shown[1] / shown[0] - 2.0) < 0.1, shown
    plot = page.one("#motion .plot")
    plot.send_keys(Keys.ARROW_RIGHT, "m")
    page.wait(lambda: "m again where it ends" in page.text("#marked"), "a mark is begun")
    plot.send_keys(Keys.SHIFT + Keys.ARROW_RIGHT, "m")
    page.wait(lambda: page.text("#marked").startswith("Marked: "), "a time is marked by keys")
    page.click("#unmark")


def plots_stand_still_and_are_seen_at_once(page, address):
    """The map is on the first screen, whole and above the motion where both do not stand side by side; a long text of what is marked moves nothing.
    The page scrolls as one, and every view can be chosen without scrolling aside."""
    places = "return [...document.querySelectorAll('#motion .u-over')].map((o) => o.getBoundingClientRect().top + scrollY)"
    for width, height in ((1280, 900), (800, 900), (400, 900)):
        page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
        page.driver.get("about:blank")
        page.open(address + "#view=where&model=0")
        top = page.wait(lambda: page.js(places), "the motion")[0]
        page.wait(lambda: page.one("#view figure .u-over"), "a map")
        first, last = page.js("const o = document.querySelector('#view figure .u-over').getBoundingClientRect(); return [o.top + scrollY, o.bottom + scrollY]")
        assert last < height, (width, last)
        assert width > 400 or first < top, (first, top)
        nested = """return ['#time', '#side', '#view', '#tabs', '.list'].filter((name) => {
            const e = document.querySelector(name); return e.scrollHeight > e.clientHeight + 1 && getComputedStyle(e).overflowY !== 'visible' || e.scrollWidth > e.clientWidth + 1; })"""
        assert page.js(nested) == [], page.js(nested)
        page.js("[...document.querySelectorAll('[data-map]')].find((b) => b.textContent.includes(' and ')).click()")
        over = page.wait(lambda: page.one("#view figure[data-figure*=_and_] .u-over"), "a map over two quantities")
        page.js("arguments[0].scrollIntoView({block: 'center'})", over)
        before, words = page.js(places), set()
        for k in range(1, 12, 2):
            ActionChains(page.driver).move_to_element_with_offset(over, int(over.size["width"] * (k / 12 - 0.5)), 0).perform()
            page.frames()
            words.add(page.text("#marked"))
            assert page.js(places) == before, f"at {width} pixels a plot moves with {page.text('#marked')}"
        assert len(words) > 3, words
    assert page.js("return !document.querySelector('#verdict details').open"), "on a phone the rest of the verdict is folded"
    page.click("#verdict summary")
    page.wait(lambda: "random force: " in page.text("#verdict"), "opened")
    page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    page.driver.get("about:blank")
    page.open(address)


def nothing_is_cut_off(page, where):
    page.js("for (const more of document.querySelectorAll('#view details')) more.open = true")
    cut = "return [...document.querySelectorAll('#view .wide, #view p, #view td')].filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent)"
    page.wait(lambda: page.js(cut) == [], f"tables and texts as wide as their place: {where}", 20)


def the_end_of_a_long_column_is_reached(page):
    """Beside a view that is longer the motion stays, with its end in sight."""
    page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1280, "height": 600, "deviceScaleFactor": 1, "mobile": False})
    page.js("scrollTo(0, document.documentElement.scrollHeight)")
    end = "return document.querySelector('#time').getBoundingClientRect().bottom"
    page.wait(lambda: 0 < page.js(end) <= 601, "the end of the motion", 20)
    page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def typed_text_is_kept(page):
    """While the study of a rung is looked at, which can only be read."""
    choose = "const m = document.querySelector('#model'); m.value = arguments[0]; m.dispatchEvent(new Event('change'))"
    area = lambda: page.one("#view textarea").get_attribute("value")
    page.js(choose, 0)
    page.view("study")
    page.wait(lambda: page.one("#save"), "the study's own text")
    page.js("const a = document.querySelector('#view textarea'); a.value += '# mine\\n'; a.dispatchEvent(new Event('input'))")
    page.wait(lambda: "not saved yet" in page.text("#check"), "it is checked")
    page.js(choose, 1)
    page.wait(lambda: "the study of rung 1" in page.text("#view") and "# mine" not in area(), "that of the rung")
    assert page.text("#check") == "Nothing is wrong with it.", page.text("#check")
    page.js(choose, 0)
    page.wait(lambda: area().endswith("# mine\n") and "not saved yet" in page.text("#check"), "what was typed")
    page.js("[...document.querySelectorAll('#view .buttons button')].find((b) => b.textContent === 'Undo all').click()")
    page.wait(lambda: "# mine" not in area(), "undone")
    page.js(choose, 1)


def find_and_add():
    """Run, find where it fails, add the first candidate, see the error fall, reload."""
    server = Server()
    page = Page(server.address)
    assert "There are no results yet" in page.text("#alerts")
    page.click("#run")
    page.wait(lambda: page.one("#job progress:not([hidden]), #job .costs figure"), "progress or cost of the fit")
    page.job("done", 1)
    assert page.text("#command").startswith("misfit run ")
    page.wait(lambda: "Missing:" in page.text("#verdict"), "the verdict")
    assert len(page.driver.find_elements(By.CSS_SELECTOR, "#motion .u-over")) >= 2, "measured, residual"
    assert len(page.driver.find_elements(By.CSS_SELECTOR, "#force .u-over")) >= 1
    page.view("where")
    ps = page.js("return [...document.querySelectorAll('#view .list small')].map((s) => Number(s.textContent.replace('p = ', '').replace('−', '-')))")
    assert len(ps) > 3 and ps == sorted(ps), ps
    point_at_the_worst_place(page)
    zoom_by_dragging(page)
    # The time cursor by keys, in all plots.
    plot = page.one("#motion .plot")
    plot.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    readouts = "return [...document.querySelectorAll('#motion .readout, #force .readout')].map((r) => r.textContent)"
    places = "return [...document.querySelectorAll('#time .u-over')].map((o) => [o.getBoundingClientRect().left, o.getBoundingClientRect().top + scrollY])"
    said = page.wait(lambda: all(page.js(readouts)) and page.js(readouts), "the values at the cursor, in all plots")
    assert re.match(r"[\d.]+ s · .*measured −?[\d.]+ · predicted one sample ahead −?[\d.]+\s±\s[\d.]+\spx", said[0]), said
    assert re.match(r"[\d.]+ s · moment_y −?[\d.]+\s±\s[\d.]+\sN m$", said[-2]), said
    before = page.js(places)
    for k in range(8):
        plot.send_keys(Keys.SHIFT, Keys.ARROW_RIGHT)
        assert page.js(places) == before, "the readout moves no plot"
    plot.send_keys(Keys.ESCAPE)
    page.wait(lambda: page.text("#marked") == "", "no marks after Escape")
    keys_in_a_pair_map(page)
    move_the_roughness(page)
    what_is_in_hand_stays(page)
    page.view("candidates")
    first = page.wait(lambda: page.one("#candidates tr.accepted button.adds"), "an accepted candidate").get_attribute("data-effect")
    force_of_the_accepted(page, first)
    page.click("#candidates tr.accepted button.adds")
    page.wait(lambda: "at work" in page.text("#candidates tr.accepted .began"), "its state at the button")
    page.wait(lambda: focused(page) == "Stop", "the focus is on the stop beside it")
    page.job("done", 2)
    page.wait(lambda: page.one("#model").get_attribute("value") == "1", "the new rung is shown")
    before, after = page.wait(lambda: random_force(page), "the random force before and after")
    assert after < before, (before, after)
    page.view("ladder")
    page.wait(lambda: page.one("#view [aria-pressed=true]").text == f"1: + {first}", "the rung")
    remove_asks_first(page)
    option = page.one(f"#effect option[value={first}]")
    assert not option.is_enabled() and "already in the model" in option.get_attribute("textContent"), "it cannot be added again"
    typed_text_is_kept(page)
    page.view("curves")
    page.wait(lambda: "own model (rung 0)" in page.text("#view"), "the curves as they were before")
    page.view("commands")
    page.wait(lambda: f"misfit add {STUDY} {first}" in page.text("#view pre"), "session.sh")
    verdict = page.text("#verdict")
    page.open(server.address)
    page.driver.refresh()
    page.wait(lambda: page.text("#verdict") == verdict, "the same after a reload")
    assert page.one("#model").get_attribute("value") == "1", "the printed address shows the model of which the verdict speaks"
    for view in ("where", "candidates", "curves", "calibration", "ladder", "study", "commands"):
        page.view(view)
        time.sleep(0.3)
        assert not page.driver.find_elements(By.CSS_SELECTOR, "#view > div > p.warning"), page.text("#view")
    plots_stand_still_and_are_seen_at_once(page, server.address)
    the_end_of_a_long_column_is_reached(page)
    for width in (1280, 800, 400):
        page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        page.wait(lambda: page.js("return document.documentElement.scrollWidth") <= width, f"nothing is wider than {width} pixels", 30)
        for view in ("where", "candidates", "ladder", "study"):
            page.view(view)
            nothing_is_cut_off(page, f"{view} at {width} pixels")
    leave_the_server(page, server)
    report_without_server(page, verdict)
    page.end()
    report_without_scripts()


def report_without_scripts():
    """It is a document, whose figures are seen."""
    page = Page("file://" + os.path.join(FOLDER, "out", "report.html"), scripts=False)
    drawings = page.driver.find_elements(By.CSS_SELECTOR, "body > main .drawing")
    assert len(drawings) > 3, len(drawings)
    assert all(one.is_displayed() and one.size["width"] > 100 and one.size["height"] > 50 for one in drawings)
    assert not page.driver.find_elements(By.CSS_SELECTOR, "#page"), "no script was run"
    page.end()


def report_without_server(page, verdict):
    """report.html in the run folder is the same page: everything but doing; what is printed is the document."""
    page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    page.open("file://" + os.path.join(FOLDER, "out", "report.html"))
    page.wait(lambda: page.text("#verdict") == verdict, "the same verdict without a server", 30)
    assert page.one("#model").get_attribute("value") == "1", "it begins with the model of which the verdict speaks"
    assert not page.one("#work").is_displayed()
    assert not page.one("body > main").is_displayed(), "the document is not seen while the page is"
    assert not page.driver.find_elements(By.CSS_SELECTOR, "button.adds, [data-view=commands]")
    page.js("document.querySelector('#model').value = 0; document.querySelector('#model').dispatchEvent(new Event('change'))")
    page.view("where")
    point_at_the_worst_place(page)
    move_the_roughness(page)
    page.view("candidates")
    page.click("#candidates tr.accepted button.shows")
    page.wait(lambda: "adds" in page.text("#force h3"), "the force of a candidate")
    for view in ("candidates", "curves", "calibration", "ladder", "study"):
        page.view(view)
        time.sleep(0.3)
        assert not page.driver.find_elements(By.CSS_SELECTOR, "#view > div > p.warning"), page.text("#view")
    assert page.js("return performance.getEntriesByType('resource').length") == 0, "nothing was asked of anybody"
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    assert not page.one("#page").is_displayed() and page.one("body > main").is_displayed(), "on paper it is the document"
    page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": False})
    cut = "return [...document.querySelectorAll('body > main .drawing')].filter((e) => e.scrollWidth > e.clientWidth + 1).length"
    assert page.js("return document.querySelectorAll('body > main .drawing').length") > 3 and page.js(cut) == 0, "no figure is cut on narrow paper"
    page.wait(lambda: page.js("return document.documentElement.scrollWidth") <= 400, "no table is wider than narrow paper", 10)
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    page.click("button.read")
    assert page.one("body > main").is_displayed() and not page.one("#page").is_displayed()
    page.click("button.explore")
    assert page.one("#page").is_displayed() and not page.one("body > main").is_displayed()
    page.driver.get("about:blank")
    page.open("file://" + os.path.join(FOLDER, "out", "report.html#section-3"))
    assert page.one("#section-3").is_displayed() and not page.one("#page").is_displayed(), "a section that is asked for is seen"
    assert page.js("return location.hash") == "#section-3", "and stays in the address"


def marks_do_not_go_with_another_recording(page):
    """Nor does a zoom, nor a mark that is begun."""
    choose = "const e = document.querySelector('#experiment'); e.value = arguments[0]; e.dispatchEvent(new Event('change'))"
    plot = page.one("#motion .plot")
    plot.send_keys(Keys.ARROW_RIGHT, "+", "m")
    page.wait(lambda: page.js("return document.querySelector('#time').dataset.window") != "", "a zoom")
    page.js(choose, "again")
    page.wait(lambda: page.js("return document.querySelector('#experiment').value") == "again", "another recording")
    assert not page.one("#holdout").is_displayed()
    assert page.text("#marked") == "" and page.js("return document.querySelector('#time').dataset.window") == ""
    page.wait(lambda: page.one("#motion .plot").send_keys(Keys.ARROW_RIGHT, "m") is None, "its motion")
    page.wait(lambda: "m again where it ends" in page.text("#marked"), "its own mark is begun, not ended")
    page.js(choose, "steps")
    page.wait(lambda: page.text("#marked") == "", "the first one again")


def settings():
    """A parameter is fixed and another part held out; both are lines of the study and commands of session.sh."""
    text = read(STUDY)
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(text.replace("[effects]", '[[experiment]]\nname = "again"\ndata = "d.csv"\n[effects]'))
    server = Server()
    page = Page(server.address)
    page.click("#run")
    page.job("done", 1)
    page.view("curves")
    page.click("#settings summary")
    assert re.search(r"k \[.*\] [\d.]+\s±\s[\d.]+\s.*estimated", page.text("#settings")), page.text("#settings")
    page.js("const e = document.querySelector('#effect'); e.value = 'cubic_damping'; e.dispatchEvent(new Event('change'))")
    assert page.text("#formula") == "cubic damping: F = -cubic_damping rate^3", page.text("#formula")
    page.click("[data-parameter=k]")
    page.job("done", 2)
    page.wait(lambda: "done" in page.text("#view .began"), "its end at the button")
    assert "k.free = false" in read(STUDY)
    page.wait(lambda: "Run makes them again" in page.text("#alerts"), "the results are outdated")
    page.wait(lambda: page.one("[data-parameter=k]"), "the parameter")
    page.wait(lambda: page.text("[data-parameter=k]") == "Estimate", "it is fixed")
    assert not page.one("#holdout").is_displayed()
    over = page.one("#motion .u-over")
    page.js("arguments[0].scrollIntoView({block: 'center'})", over)
    ActionChains(page.driver).move_to_element(over).key_down(Keys.SHIFT).click_and_hold().move_by_offset(60, 0).release().key_up(Keys.SHIFT).perform()
    page.wait(lambda: page.one("#holdout").is_displayed(), "a marked time can be held out")
    marks_do_not_go_with_another_recording(page)
    over = page.one("#motion .u-over")
    ActionChains(page.driver).move_to_element(over).key_down(Keys.SHIFT).click_and_hold().move_by_offset(60, 0).release().key_up(Keys.SHIFT).perform()
    page.click("#holdout")
    page.job("done", 3)
    assert re.search(r"validation = \[[\d.]+, [\d.]+\]", read(STUDY)), read(STUDY)
    page.click("#run")
    page.job("done", 4)
    page.wait(lambda: "held out from " in page.one("#motion .plot").get_attribute("aria-label"), "held-out time is told apart")
    assert "held out from " in page.one("#force .plot").get_attribute("aria-label"), "in the force, too"
    assert page.js("return document.querySelector('#method').value") == "filter_error"
    page.js("const m = document.querySelector('#method'); m.value = 'output_error'; m.dispatchEvent(new Event('change'))")
    page.click("#fit")
    page.job("done", 5)
    page.wait(lambda: page.js("return document.querySelector('#method').value") == "output_error", "a chosen method stays chosen")
    page.view("commands")
    page.wait(lambda: f"misfit set {STUDY} 'parameters.k.free=false'" in page.text("#view pre"), "session.sh")
    page.end()
    server.end()


def film():
    """The frame at the cursor, with the bob where it was measured and where it was predicted."""
    server = Server()
    page = Page(server.address)
    page.wait(lambda: "Frame at 0 s" in page.text("#frame-words"), "the first frame, before anything is fitted")
    page.click("#fit")
    page.job("done", 1)
    over = page.wait(lambda: page.one("#motion .u-over"), "the motion")
    page.js("arguments[0].scrollIntoView({block: 'center'})", over)
    ActionChains(page.driver).move_to_element(over).perform()
    page.wait(lambda: "predicted by" in page.text("#frame-words") and "measured" in page.text("#frame-words"), "both markers")
    page.wait(lambda: 8.0 < float(re.search(r"Frame at ([\d.]+) s", page.text("#frame-words"))[1]) < 12.0, "the frame of the cursor")
    width, height = page.js("const image = document.querySelector('#frame'); return [image.naturalWidth, image.naturalHeight]")
    assert width > 100 and height > 100, (width, height)
    x, y = (float(page.one("#marks circle").get_attribute(key)) for key in ("cx", "cy"))
    cross = [float(v) for v in re.match(r"M([-\d.]+) [-\d.]+h[-\d.]+M[-\d.]+ ([-\d.]+)v", page.one("#marks path").get_attribute("d")).groups()]
    assert abs(0.5 * (cross[0] + 0.02 * width + x) - x) < 3 and 0 < x < width and 0 < y < height, (x, y, cross)
    blue = page.js("""const [x, y] = arguments, image = document.querySelector('#frame'), canvas = document.createElement('canvas');
        [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
        canvas.getContext('2d').drawImage(image, 0, 0);
        const [r, g, b] = canvas.getContext('2d').getImageData(x, y, 1, 1).data;
        return b - g""", int(x), int(y))
    assert blue > 40, f"the bob is blue and violet, the wall brown: {blue}"
    marked_samples_in_the_film(page)
    page.end()
    server.end()


def two_pages():
    """The same study in two pages: both show what one of them does, and neither takes from the other what is in hand."""
    server = Server()
    page, other = Page(server.address), Page(server.address)
    page.click("#run")
    for one in (page, other):
        one.job("done", 1)
    for selector in ("#verdict", "#view", "#command"):
        other.wait(lambda: other.text(selector) == page.text(selector) != "", f"the same in {selector}")
    # In hand: marks, a zoom of time and of a map, what is unfolded.
    plot = other.one("#motion .plot")
    plot.send_keys(Keys.ARROW_RIGHT, "+", "m")
    plot.send_keys(Keys.SHIFT + Keys.ARROW_RIGHT, "m")
    other.wait(lambda: other.text("#marked").startswith("Marked: "), "a marked time")
    other.wait(lambda: other.one("#view figure .plot"), "a map").send_keys(Keys.ARROW_RIGHT, "+")
    other.wait(lambda: other.text("#marked").startswith("Marked: "), "a marked cell")
    other.js("[...document.querySelectorAll('#view summary')].at(-1).click()")
    in_hand = """return [document.querySelector('#marked').textContent, document.querySelector('#time').dataset.window,
        document.querySelector('#view figure').dataset.window, document.querySelector('#view details').open]"""
    before = other.js(in_hand)
    assert all(before), before
    other.js("document.querySelector('#view > div').dataset.seen = 'before'; document.querySelector('#run').focus()")
    subprocess.run([PROGRAM, "set", STUDY, "parameters.k.free=false"], check=True)
    page.click("#run")
    other.job("running", 2)
    other.wait(lambda: other.js("return document.activeElement.id") == "job", "the focus is not on Stop: this page has begun nothing")
    other.driver.switch_to.active_element.send_keys(Keys.ENTER)
    said = other.wait(lambda: other.js("return document.querySelector('#job details:not([hidden]) summary')"), "what it says")  # not before it has said something
    other.js("arguments[0].focus()", said)
    for one in (page, other):
        one.job("done", 2)
    assert other.js("return document.activeElement === arguments[0]", said), "the box of the command is the same all the time"
    other.wait(lambda: other.js("return document.querySelector('#view > div').dataset.seen !== 'before'"), "its new results are seen")
    other.wait(lambda: other.js(in_hand) == before, "and what was in hand is still there")
    other.wait(lambda: other.text("#verdict") == page.text("#verdict") and not other.text("#alerts"), "the same again")
    kept_force_stays_with_another_method(page)
    page.end()
    other.end()
    server.end()


def kept_force_stays_with_another_method(page):
    page.view("candidates")
    page.click("#candidates tr.accepted button.shows")
    page.wait(lambda: "adds" in page.text("#force h3"), "the force of a candidate")
    page.js("const m = document.querySelector('#method'); m.value = 'output_error'; m.dispatchEvent(new Event('change'))")
    page.wait(lambda: "output error" in page.one("#motion .plot").get_attribute("aria-label"), "the motion by another method")
    assert "adds" in page.text("#force h3"), page.text("#force")


def marked_samples_in_the_film(page):
    """Pointing at a place of a map shows the frame of one of its samples, and says so; the cursor leads back."""
    badge = lambda: page.one("#frame-badge").is_displayed()
    frame = lambda: page.text("#frame-words")
    page.click("#run")
    page.job("done", 2)
    ActionChains(page.driver).move_to_element(page.one("h1")).perform()
    plot = page.wait(lambda: page.one("#view figure .plot"), "a map")
    assert not badge()
    at_the_cursor, seen = page.still(frame, "the frame"), set()
    for _ in range(4):
        plot.send_keys(Keys.ARROW_RIGHT)
        page.wait(badge, "the frame is of a marked sample")
        seen.add(page.still(frame, "the frame"))
    assert len(seen) > 1, seen
    page.one("#motion .plot").send_keys(Keys.ESCAPE)
    page.wait(lambda: not badge(), "nothing is marked")
    page.wait(lambda: frame() == at_the_cursor, "the frame at the cursor again")


def cells_and_figures_are_as_they_should(page):
    """Parts of the page, each by itself."""
    said = page.driver.execute_async_script("""const done = arguments[0];
        Promise.all(['/cells.js', '/figure.js', '/dom.js'].map((name) => import(name))).then(([cells, figure, dom]) => {
          const t = [0, 1, 2, 3, 100, 101, 104], byCell = new cells.SamplesByCell(t, (i) => [0, 0, 1, 0, 0, 1, 0][i]);
          const series = (y, style) => ({ key: 'measured', legend: '', style, colour: '#000000', width: 1, x: 0, y, lo: [], hi: [], z: [] });
          const drawing = (x, ...all) => ({ name: 'a', title: '', caption: '', notes: [], xLabel: '', xUnit: '', xMarks: [], xs: [x],
              panels: [{ label: '', unit: '', height: 200, zero: false, marks: [], series: all }] });
          const drawn = new figure.Figure(document.body, drawing([0, 1, 2], series([0, 1, 0], 'line')));
          drawn.overlay = [{ ...series([0, 9, null], 'line'), x: [0, 1, 2], sorted: true }];
          drawn.redrawOver();
          const scales = new Map(), [large, small] = [8, 1].map((top) => new figure.Figure(document.body, drawing([0, 1], series([0, top], 'line')), { scales }));
          const banded = (lo, hi) => ({ ...series(undefined, 'band'), key: 'b', lo, hi });
          const narrow = new figure.Figure(document.body, drawing([0, 1, 2, 3], series([0, 0.1, 0, 0.1], 'line'), banded([-5, -5, -5, -90], [5, 5, 5, 90])));
          const gap = drawing([0, 1, 2, 9], series([5, 6, null, 8], 'points'));
          setTimeout(() => {
            const { max } = drawn.plots[0].u.scales.y;
            const kept = small.plots[0].u.scales.y.max;
            const { min: low, max: high } = narrow.plots[0].u.scales.y;
            for (const one of [drawn, large, small, narrow]) one.destroy();
            done([byCell.at(0), byCell.at(1).intervals, cells.rangeOf([0, 1, 2], 1), cells.rangeOf([0, 1, 2], 2) ?? null, max >= 9, kept >= 8,
                [1.2, 2, 5, 9.5].map((at) => figure.valueAt(gap, 'measured', at) ?? null),
                [dom.shownWithSigma(1234567, 2), dom.shownWithSigma(-12345678, 12345), dom.shownPlace(101325.7, 100, 4), dom.shown(-1.5e-7, 2)],
                [low <= -5 && high >= 5, low > -20 && high < 20], ['lateral_moment', 'x_px', [['C', 0], ['m', -1], [' of output_error', 0]]].map(dom.spaced)]);
          }, 100);
        })""")
    assert said[0] == {"times": [0, 1, 3, 100, 104], "intervals": [[-0.5, 1.5], [2.5, 100.5], [102.5, 105.5]]}, said[0]
    assert said[1] == [[1.5, 2.5], [100.5, 102.5]], "no sample between is marked"
    assert said[2:6] == [1, None, True, True], "a value at an edge is in the range above; a curve over the others is seen whole; one scale is kept"
    assert said[6] == [6, None, None, 8], "no marker of another time"
    assert said[7] == ["1234567.0\u00a0±\u00a02.0", "−1.2346e+7\u00a0±\u00a012000", "101325.7", "−1.5e−7"], said[7]
    assert said[8] == [True, True], "the axis holds the band, but not where it is much wider than usual"
    assert said[9] == ["lateral moment", "x_px", [["C", 0], ["m", -1], [" of output error", 0]]], "names as they are read; symbols stay"


def numbers_far_from_zero_are_told_apart(page):
    said = page.driver.execute_async_script("""const done = arguments[0];
        import('/dom.js').then((dom) => done([dom.tick(1700000010, 10), dom.tick(1700000020, 10), dom.tick(101325.5, 0.5), dom.tick(0.125, 0.125),
            dom.tick(-2000000, 500000), dom.tick(0, 1), dom.shownPlace(1700000012.3456, 79), dom.shownPlace(12.34567, 79), dom.shownPlace(0, 79)]))""")
    assert said == ["1700000010", "1700000020", "101325.5", "0.125", "−2e6", "0", "1700000012.35", "12.346", "0"], said


def mend():
    """A study with an error is mended in the page."""
    good = read(STUDY)
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(good.replace("seed = 1", "seeds = 1").replace("starts = 5", "start = 5") + "# a line\n" * 60)
    server = Server()
    page = Page(server.address)
    page.wait(lambda: "The study has an error" in page.text("#alerts"), "the error")
    assert not page.one("#run").is_enabled()
    numbers_far_from_zero_are_told_apart(page)
    cells_and_figures_are_as_they_should(page)
    page.click("#fault button")
    area = page.wait(lambda: page.one("#view textarea"), "the text")
    assert [bad.text for bad in page.driver.find_elements(By.CSS_SELECTOR, ".editor pre .bad")] == ["5", "16"], "every fault, at its line"
    assert "start" in page.text("#further"), page.text("#further")
    page.js("arguments[0].scrollTop = 1e9", area)
    page.wait(lambda: page.js("return document.querySelector('.editor pre').scrollTop") > 0, "the numbers follow")
    assert page.js("return document.querySelector('.editor pre').scrollTop - arguments[0].scrollTop", area) == 0, "at the end of the text, too"
    assert "seed" in page.text("#check")
    page.click("#check button")  # to line 5, which is then chosen
    area.send_keys("seed = 1")
    page.js("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))", area, page.js("return arguments[0].value", area).replace(
        "start = 5", "starts = 5").replace("# a line\n", ""))
    page.wait(lambda: "not saved yet" in page.text("#check"), "it is checked while typed")
    page.js("""document.querySelector('#save').click();  // and typed on before the answer
        arguments[0].value += '# more\\n'; arguments[0].dispatchEvent(new Event('input'))""", area)
    page.wait(lambda: read(STUDY) == good, "saved")
    page.wait(lambda: "not saved yet" in page.text("#check"), "what was typed since is not")
    assert area.get_attribute("value") == good + "# more\n"
    page.click("#save")
    page.wait(lambda: "Saved" in page.text("#check"), "saved")
    assert read(STUDY) == good + "# more\n"
    page.wait(lambda: page.one("#run").is_enabled(), "it can be run")
    somebody_else_saves(page)
    an_answer_is_lost(page)
    page.end()
    server.end()


def type_in(page, text):
    page.js("const a = document.querySelector('#view textarea'); a.value += arguments[0]; a.dispatchEvent(new Event('input'))", text)


def somebody_else_saves(page):
    """While something is typed: it is not called fine, and Undo leads to what was saved."""
    type_in(page, "# mine\n")
    page.wait(lambda: "not saved yet" in page.text("#check"), "it is checked")
    theirs = read(STUDY) + "# theirs\n"
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(theirs)
    page.wait(lambda: "changed by somebody else" in page.text("#check"), "it is said")
    type_in(page, "# more of mine\n")
    time.sleep(1)
    assert "changed by somebody else" in page.text("#check") and not page.one("#save").is_enabled(), page.text("#check")
    page.js("[...document.querySelectorAll('#view .buttons button')].find((b) => b.textContent === 'Undo all').click()")
    page.wait(lambda: page.one("#view textarea").get_attribute("value") == theirs, "the text of the file")
    page.wait(lambda: page.text("#check") == "Nothing is wrong with it.", "nothing is typed any more")


def an_answer_is_lost(page):
    """It is said as long as nobody answers; then the page goes on as it was, with what is typed. A fault of the page is no silence of misfit."""
    type_in(page, "# mine\n")
    page.wait(lambda: "not saved yet" in page.text("#check"), "it is checked, so that no answer is under way")
    alerts = page.text("#alerts")
    page.js("document.body.dataset.same = 'yes'; window.before = window.fetch; window.fetch = () => Promise.reject(new TypeError('no net'))")
    page.wait(lambda: "does not answer any more" in page.text("#alerts"), "nobody answers")
    page.js("window.fetch = async () => ({ ok: true, text: async () => '{}' })")
    page.wait(lambda: "Cannot read" in page.text("#alerts"), "an answer that the page cannot take")
    assert "does not answer" not in page.text("#alerts")
    page.js("window.fetch = window.before")
    page.wait(lambda: page.text("#alerts") == alerts, "all is well again")
    time.sleep(2)
    assert page.js("return document.body.dataset.same") == "yes", "it is not loaded again"
    assert page.one("#view textarea").get_attribute("value").endswith("# mine\n")
    page.js("[...document.querySelectorAll('#view .buttons button')].find((b) => b.textContent === 'Undo all').click()")


def stop_and_kill():
    """A command is stopped; the server is killed in the middle of another and opened again."""
    server = Server()
    page = Page(server.address)
    page.click("#run")
    page.job("running", 1)
    page.wait(lambda: focused(page) == "Stop", "the focus is where the next key is wanted")
    time.sleep(0.6)  # an Enter within half a second is the one that began it, pressed twice
    page.driver.switch_to.active_element.send_keys(Keys.ENTER)
    page.job("stopped", 1)
    page.wait(lambda: focused(page) == "Run", "and goes back to what began it")
    assert page.text("#work .began").startswith("stopped"), page.text("#work .began")
    page.click("#run")
    page.job("running", 2)
    time.sleep(0.5)
    server.end(signal.SIGKILL)
    page.wait(lambda: "does not answer any more" in page.text("#alerts"), "the page says that nobody answers")
    page.no_faults(but="net::ERR_")  # refused, reset or empty, as the kill met the question
    server = Server()
    page.open(server.address)

    def done():
        page.click("#run")
        page.wait(lambda: page.one("#job").get_attribute("data-state") in ("done", "failed"), "its end")
        return page.one("#job").get_attribute("data-state") == "done"
    page.wait(done, "done, when the command of the killed server has let go of the folder")
    page.wait(lambda: "Missing:" in page.text("#verdict"), "the verdict")
    page.end()
    server.end()


def hostile():
    """Names that are scripts stay names."""
    picture = "<img src=x onerror=document.title='hit'>"
    script = picture + "</script><script>document.title='hit'</script>"
    text = read(STUDY).replace('name = "an oscillator"', f'name = "{script}"').replace('name = "steps"', f'name = "{picture}"')
    text = text.replace('question = "What does it lack?"', f'question = "{script}"')
    with open(STUDY, "w", encoding="utf-8") as file:
        file.write(text)
    server = Server()
    page = Page(server.address)
    page.click("#run")
    page.job("done", 1)
    page.wait(lambda: page.text("h1") == script, "the name as a name")
    for view in ("where", "candidates", "curves", "study", "commands"):
        page.view(view)
        time.sleep(0.3)
    assert page.js("return document.title") == f"{script} · misfit"
    assert page.js("return document.querySelectorAll('body script:not([src]), body img:not(#frame)').length") == 0
    leave_the_server(page, server)
    page.open("file://" + os.path.join(FOLDER, "out", "report.html"))
    page.wait(lambda: page.text("h1") == script, "the name as a name, without a server")
    assert page.js("return document.title") == f"{script} · misfit"
    page.end()


def timing():
    """How long what is felt at once takes, as a table: no test. By hand, on any study that has been run: PROGRAM STUDY_FOLDER timing."""
    server = Server()
    page = Page(server.address)
    print(f"ready after {page.js('return performance.now()') / 1000:.2f} s (at most: asked for ten times a second)")
    # Every move leads far away: of a map into another cell.
    moves = """const [host, type, n] = arguments, box = host.getBoundingClientRect(), took = [];
        for (let k = 0; k < n; ++k) {
          const x = box.left + box.width * ((k * 61) % n + 0.5) / n, y = box.top + box.height * (0.5 + 0.3 * Math.sin(k));
          const begin = performance.now();
          if (type === 'input') { host.value = Number(host.max) * k / n; host.dispatchEvent(new Event('input')); }
          else host.dispatchEvent(new MouseEvent('mousemove', { clientX: x, clientY: y, bubbles: true, view: window }));
          host.getBoundingClientRect();
          await new Promise((go) => queueMicrotask(go));
          took.push(performance.now() - begin);
          if (k % 5 === 0) await new Promise(requestAnimationFrame);
        }
        took.sort((a, b) => a - b);
        return [took[n >> 1], took[Math.floor(0.95 * n)], took[n - 1]]"""

    def measure(what, selector, event="mousemove"):
        found = page.driver.find_elements(By.CSS_SELECTOR, selector)
        if not found:
            return print(f"{what}: there is none")
        page.js("arguments[0].scrollIntoView({block: 'center'})", found[0])
        page.js("arguments[0].dispatchEvent(new MouseEvent('mouseenter', {view: window}))", found[0])
        half, most, longest = page.js(f"return (async function () {{ {moves} }})(...arguments)", found[0], event, 200)
        print(f"{what}: half within {half:.1f} ms, 95 % within {most:.1f} ms, all within {longest:.1f} ms")
    measure("cursor over the motion", "#motion .u-over")
    page.view("where")
    page.wait(lambda: page.one("#view figure .u-over"), "a map", 60)
    time.sleep(2)
    measure("over a map", "#view figure .u-over")
    pair = page.js("return [...document.querySelectorAll('[data-map]')].find((b) => b.textContent.includes(' and '))")
    if pair:
        page.js("arguments[0].click()", pair)
        time.sleep(2)
        measure("over a map of two quantities", "#view figure[data-figure*=_and_] .u-over")
    page.view("curves")
    time.sleep(1)
    measure("the slider of a roughness", ".slider input", "input")
    print(f"JavaScript holds {page.js('return performance.memory.usedJSHeapSize') / 1e6:.0f} MB")
    page.end()
    server.end()


{"timing": timing, "two_pages": two_pages, "find_and_add": find_and_add, "mend": mend, "film": film, "settings": settings, "stop_and_kill": stop_and_kill, "hostile": hostile}[sys.argv[3]]()
