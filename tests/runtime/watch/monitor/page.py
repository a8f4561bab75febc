#!/usr/bin/env python3
"""The page of a run in a real browser, driven over Chromium's debugging pipe: page.py STENCIL CHROMIUM [FOLDER].

It fails unless the page shows the run, in the light, in the dark and on a phone; that the pointer shows values, and that the slider
shows the past. Without a browser (cmake/setup.sh --with-browser) the test is skipped: exit code 77. With FOLDER it takes the pictures of
runtime/guide/see_a_run.md instead, in two minutes:

    tests/runtime/watch/monitor/page.py build/release/bin/stencil "$(command -v chromium)" runtime/watch/monitor
"""
import base64
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from collections import Counter

stencil, chromium = sys.argv[1:3]
folder = sys.argv[3] if len(sys.argv) > 3 else None
if not os.access(chromium, os.X_OK):
    print('skipped: there is no Chromium; cmake/setup.sh --with-browser installs it, then configure again')
    sys.exit(77)


class Page:
    """A page of a headless browser."""

    def __init__(self, profile):
        to_browser, self.to = os.pipe()
        self.of, from_browser = os.pipe()

        def as_3_and_4():
            at = [os.dup(fd) for fd in (to_browser, from_browser)]
            os.dup2(at[0], 3)
            os.dup2(at[1], 4)

        self.browser = subprocess.Popen([chromium, '--headless', '--no-sandbox', '--disable-gpu', '--hide-scrollbars', f'--user-data-dir={profile}',
                                         '--remote-debugging-pipe'], preexec_fn=as_3_and_4, close_fds=False, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.n, self.session, self.text = 0, None, b''
        target = self.ask('Target.createTarget', url='about:blank')['targetId']
        self.session = self.ask('Target.attachToTarget', targetId=target, flatten=True)['sessionId']

    def ask(self, method, **params):
        self.n += 1
        message = {'id': self.n, 'method': method, 'params': params}
        if self.session:
            message['sessionId'] = self.session
        os.write(self.to, json.dumps(message).encode() + b'\0')
        while True:
            while b'\0' not in self.text:
                more = os.read(self.of, 1 << 20)
                if not more:
                    sys.exit('FAILED: the browser has ended')
                self.text += more
            line, self.text = self.text.split(b'\0', 1)
            answer = json.loads(line)
            if answer.get('id') == self.n:
                return answer['result']

    def value(self, expression):
        """What a JavaScript expression gives on the page; a text that names the error if it throws."""
        answer = self.ask('Runtime.evaluate', expression=expression, returnByValue=True)
        if 'exceptionDetails' in answer:
            return 'error: ' + answer['exceptionDetails']['exception'].get('description', '')
        return answer['result'].get('value')

    def screen(self, width, height, dark=False):
        self.ask('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=1, mobile=width < 500)
        self.ask('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}])
        for _ in range(100):
            time.sleep(0.3)
            if self.value('typeof drawn !== "undefined" && !drawn') is not False:
                break

    def point(self, place, x, y):
        """Moves the pointer over an element, to parts of its width and height."""
        for _ in range(3):  # what is drawn meanwhile may move it
            box = self.value(f"$('{place}').scrollIntoView({{block: 'center'}}); (b => [b.left, b.top, b.width, b.height])($('{place}').getBoundingClientRect())")
            self.ask('Input.dispatchMouseEvent', type='mouseMoved', x=box[0] + x * box[2], y=box[1] + y * box[3])
            time.sleep(0.2)

    def close(self):
        self.session = None
        self.ask('Browser.close')
        self.browser.wait()


n_failed = 0


def check(what, holds, seen=None):
    global n_failed
    if not holds:
        n_failed += 1
        print(f'FAILED: {what}: {seen}')


def check_page(page):
    def text(place):
        return page.value(f"$('{place}').textContent")

    def wait(what, expression):
        for _ in range(200):
            seen = page.value(expression)
            if seen is True:
                return
            time.sleep(0.1)
        check(what, False, seen)

    def soon(pattern, read):
        """The match of what is drawn within two seconds."""
        for _ in range(20):
            if match := re.search(pattern, read()):
                return match
            time.sleep(0.1)
        return None

    wait('it shows the run', "frames.length > 6 && live && maps > 0 && pictures.size > 0 && $('entries').children.length > 0")
    check('it names the program', text('program') == 'stencil' and page.value('document.title') == 'stencil (Tessera)', text('program'))
    check('the command line, without its token', '--pes 2 --monitor 0 --monitor-token … --size 256' in text('command'), text('command'))
    check('PEs and processes', re.match(r'\d+\.\d s of run time, 2 PEs in 1 process, ', text('now')), text('now'))
    check('chares', 'stencil::Block1688' in text('chares'), text('chares'))
    check('a picture', page.value("pictures.get('temperature').canvas.width") == 256)
    check('a heat map', page.value("$('heat').width") == 4 and 'hottest [' in text('heatkey'), text('heatkey'))

    bars = page.value("[...$('entries').children].map(bar => [...bar.children].map(part => part.textContent))")
    check('a bar per entry method, at most ten', 2 <= len(bars) <= 10, bars)
    check('entry methods by name', 'stencil::Block::step' in [bar[0] for bar in bars], bars)
    parts = [float(bar[2].split()[0]) for bar in bars]
    check('the greatest first, of all time', parts == sorted(parts, reverse=True) and 0 < sum(parts) <= 101, bars)
    check('in milliseconds', all(re.match(r'[\d.]+ (k |M )?ms$', bar[1]) for bar in bars), bars)

    for place in ('rate', 'queue', 'imbalance', 'memory'):
        labels = page.value(f"[...$('{place}').querySelectorAll('text')].map(label => label.textContent)")
        check(f'labels of {place} differ', len(set(labels)) == len(labels), labels)
        check(f'axes of {place}', sum(label.endswith(' s') for label in labels) >= 2 and sum(not label.endswith(' s') for label in labels) >= 2, labels)
        check(f'a curve of {place}', page.value(f"$('{place}').querySelector('polyline').points.length") > 5)
    imbalance = re.search(r'at most (\d\.\d\d)$', text('imbalance'))
    check('imbalance without a balancer', imbalance and 1 <= float(imbalance[1]) <= 2 and text('rounds') == 'no balance round yet', text('imbalance'))

    last = page.value('frames.at(-1).t')
    page.point('rate', 0.25, 0.5)
    wait('the pointer is over the curves', f"pointed !== null && pointed.t < {last} && !drawn")
    seen = re.search(r'at ([\d.]+) s: [\d.]+( k| M)?/s, at most', text('rate'))
    check('the value below the pointer', seen and float(seen[1]) < last, text('rate'))
    check('of the same time in all curves', seen and f'at {seen[1]} s: ' in text('memory'), text('memory'))
    page.point('busy', 0.5, 0.9)
    check('the PE below the pointer', soon(r' s: PE 1 \d+ % busy', lambda: text('busykey')), text('busykey'))
    page.point('heat', 0.9, 0.1)
    check('the cell below the pointer', soon(r'^cell \[3,0\]: [\d.]+ % of a PE', lambda: text('heatkey')), text('heatkey'))
    page.point('command', 0.5, 0.5)

    page.value("$('past').value = 1; $('past').dispatchEvent(new Event('input'))")
    time.sleep(0.3)
    wait('it is drawn', '!drawn')
    check('the slider shows the past', page.value("shown() === frames[1] && $('now').textContent.startsWith(frames[1].t.toFixed(1) + ' s')") is True, text('now'))
    check('and says so', text('shown').endswith(' s ago') and not page.value("$('live').hidden"), text('shown'))
    page.value("for (let i = 0; i < 700; ++i) events.dispatchEvent(new MessageEvent('frame', {data: JSON.stringify({...frames.at(-1), limits: 'half <b>'})}))")
    time.sleep(0.3)
    wait('it is drawn', '!drawn')
    wait('it is drawn', '!drawn')
    check('the past is bounded', page.value('frames.length') == 600)
    check('a time that is gone becomes the first', page.value('chosen === frames[0]') is True)
    page.value("$('live').click(); events.close()")
    time.sleep(0.3)
    wait('it is drawn', '!drawn')
    check('back to now', text('shown') == 'now' and page.value("$('live').hidden") is True, text('shown'))
    page.value("events.dispatchEvent(new MessageEvent('frame', {data: JSON.stringify({...frames.at(-1), limits: 'half <b>'})}))")
    time.sleep(0.3)
    wait('it is drawn', '!drawn')
    check('what limits the run', text('limitstext') == 'half <b>' and not page.value("$('limits').hidden"), text('limitstext'))
    page.value("events.dispatchEvent(new MessageEvent('frame', {data: JSON.stringify({...frames.at(-1), limits: undefined})}))")
    time.sleep(0.3)
    wait('it is drawn', '!drawn')
    check('nothing limits a run that does not say it', page.value("$('limits').hidden") is True)

    def light(of, colour):
        return max(int(c) for c in re.findall(r'\d+', page.value(f"getComputedStyle({of})['{colour}']"))[:3])

    def idle():
        return page.value("Math.max(...$('busy').getContext('2d').getImageData(0, 0, 1, 1).data.slice(0, 3))")

    page.value("frames.forEach((f, i) => { f.t = i / 2; f.busy = [50, 50]; f.measured = i % 2; f.entries = i % 2 ? [['f', 0.5]] : []; }); soon()")
    time.sleep(0.3)
    wait('it is drawn', '!drawn')
    check('only the time that was measured counts', text('entries') == 'f15.0 k ms50.0 %' and 'of the 30.0 s that' in text('entrieskey') and '; processor time' in text('entrieskey'), text('entries') + text('entrieskey'))
    labels = page.value("[...$('imbalance').querySelectorAll('text')].map(label => label.textContent).filter(label => !label.endsWith(' s'))")
    check('labels of a flat curve differ', len(set(labels)) == len(labels) >= 2, labels)
    page.value("frames[0].busy = [0, 0]; soon()")
    for width, dark in ((1000, False), (1000, True), (390, False), (320, True)):
        page.screen(width, 844, dark)
        ink, paper, ground = light('document.body', 'color'), light("document.querySelector('section')", 'backgroundColor'), light('document.body', 'backgroundColor')
        check(f'{width} pixels, dark {dark}: text stands out', (ink > 200 and max(paper, ground) < 60) if dark else (ink < 60 and min(paper, ground) > 240), (ink, paper, ground))
        check(f'{width} pixels, dark {dark}: an idle PE has the colour of the paper', abs(idle() - paper) < 16, (idle(), paper))
        check(f'{width} pixels: nothing is wider', page.value('document.documentElement.scrollWidth') <= width, page.value('document.documentElement.scrollWidth'))
        wide = page.value(f"[...document.querySelectorAll('section, section *, #time, #time *')].filter(e => e.getBoundingClientRect().right > {width}).map(e => e.id || e.outerHTML)")
        check(f'{width} pixels: all is inside', wide == [], wide)


def smaller(png):
    """The same picture with its 256 most frequent colours, as a PNG with a palette."""
    at, data = 8, b''
    while at < len(png):
        size, kind = struct.unpack('>I4s', png[at:at + 8])
        if kind == b'IHDR':
            width, height, _, colour = struct.unpack('>IIBB', png[at + 8:at + 18])
        if kind == b'IDAT':
            data += png[at + 8:at + 8 + size]
        at += size + 12
    raw, each, rows = zlib.decompress(data), {2: 3, 6: 4}[colour], []
    row = bytearray(width * each)
    for y in range(height):
        begin = y * (width * each + 1)
        how, line, before = raw[begin], bytearray(raw[begin + 1:begin + 1 + width * each]), row
        for i in range(len(line)):
            a, b, c = line[i - each] if i >= each else 0, before[i], before[i - each] if i >= each else 0
            paeth = min((a, b, c), key=lambda one: abs(a + b - c - one))
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[how]) & 255
        row = line
        rows.append(row)
    pixels = [[line[i:i + 3] for i in range(0, len(line), each)] for line in map(bytes, rows)]
    often = Counter(pixel for line in pixels for pixel in line)
    colours = [colour for colour, _ in often.most_common(256)]
    spare = {}  # the nearest of them to each other colour, in steps of 4
    number = {colour: i for i, colour in enumerate(colours)}
    for colour in often:
        if colour not in number:
            coarse = tuple(v // 4 for v in colour)
            if coarse not in spare:
                spare[coarse] = min(range(256), key=lambda i: sum((a - b) ** 2 for a, b in zip(colour, colours[i])))
            number[colour] = spare[coarse]

    def chunk(kind, content):
        return struct.pack('>I', len(content)) + kind + content + struct.pack('>I', zlib.crc32(kind + content))

    return (png[:8] + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 3, 0, 0, 0)) + chunk(b'PLTE', b''.join(colours)) +
            chunk(b'IDAT', zlib.compress(b''.join(b'\0' + bytes(number[pixel] for pixel in line) for line in pixels), 9)) + chunk(b'IEND', b''))


def take_pictures(page):
    while page.value("maps >= 40 && pictures.size > 0 && $('entries').children.length > 0") is not True:
        time.sleep(0.5)
    page.value("events.close(); heat.abort(); $('state').textContent = 'running'")
    for name, width, dark in (('page', 1000, False), ('page_dark', 1000, True), ('page_phone', 390, False)):
        page.screen(width, 600, dark)
        page.screen(width, min(page.value('document.documentElement.scrollHeight'), 1400 if width < 500 else 1600), dark)
        with open(os.path.join(folder, name + '.png'), 'wb') as file:
            file.write(smaller(base64.b64decode(page.ask('Page.captureScreenshot', format='png')['data'])))


token = [] if folder else ['--monitor-token', 'secret']
grid = ['--size', '1024', '--blocks', '8'] if folder else ['--size', '256', '--blocks', '4']
with tempfile.TemporaryDirectory() as scratch:
    run = subprocess.Popen([stencil, '--pes', '2', '--monitor', '0', *token, *grid, '--steps', '1000000000'],
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        url = re.search(r'http://[0-9.:]*/', run.stderr.readline())
        if not url:
            sys.exit('FAILED: the run says no address')
        page = Page(os.path.join(scratch, 'profile'))
        try:
            page.screen(1000, 844)
            page.ask('Page.navigate', url=url[0] + '?heat=Block' + ('' if folder else '&token=secret'))
            take_pictures(page) if folder else check_page(page)
        finally:
            page.close()
    finally:
        run.terminate()
        run.wait()
if n_failed:
    sys.exit(f'{n_failed} failed')
print('the pictures are taken' if folder else 'the page shows the run')
