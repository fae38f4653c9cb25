# SPDX-License-Identifier: MIT
"""A headless Chromium over a pipe: opens pages, runs scripts in them, and keeps what they complain of."""
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

NAMES = ("chromium", "chromium-browser", "google-chrome")


def find():
    return next((path for path in map(shutil.which, NAMES) if path), None)


class Chromium:
    def __init__(self, program, *options):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_read, self.to_write = os.pipe()
        self.to_read, to_write = os.pipe()

        def give_pipes():  # Chromium reads from 3 and writes to 4
            first, second = os.dup(to_read), os.dup(to_write)
            os.dup2(first, 3)
            os.dup2(second, 4)
            os.closerange(5, 64)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             f"--user-data-dir={self.folder.name}", "--remote-debugging-pipe", *options, "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False,
            preexec_fn=give_pipes)
        os.close(to_read)
        os.close(to_write)
        self.text, self.messages, self.number = b"", [], 0
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(domain + ".enable")

    session = None

    def receive(self, seconds=240):
        """The next message."""
        end = time.monotonic() + seconds
        while b"\0" not in self.text:
            if not select.select([self.to_read], [], [], max(0, end - time.monotonic()))[0]:
                raise TimeoutError("Chromium says nothing")
            got = os.read(self.to_read, 1 << 20)
            if not got:
                raise EOFError("Chromium has ended")
            self.text += got
        message, _, self.text = self.text.partition(b"\0")
        return json.loads(message)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to_write, json.dumps(message).encode() + b"\0")
        while (answer := self.receive()).get("id") != self.number:
            self.messages.append(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def wait(self, method):
        """Until an event of this name has come."""
        while True:
            for i, message in enumerate(self.messages):
                if message.get("method") == method:
                    del self.messages[i]
                    return
            self.messages.append(self.receive())

    def open(self, address):
        self.messages = [m for m in self.messages if m.get("method") != "Page.loadEventFired"]
        self.call("Page.navigate", url=address)
        self.wait("Page.loadEventFired")

    def evaluate(self, script):
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait_until(self, condition):
        """Until a condition of the page's script holds, however slow the machine is."""
        end = time.monotonic() + 240
        while not self.evaluate(condition):
            if time.monotonic() > end:
                raise TimeoutError(f"never: {condition}")
            time.sleep(0.02)

    def drag(self, canvas):
        """Drags a canvas of the page a little way to the lower right."""
        self.evaluate(f"{canvas}.setPointerCapture = () => {{}}")
        for kind, x, y in (("pointerdown", 100, 100), ("pointermove", 180, 130), ("pointerup", 180, 130)):
            self.evaluate(f"{canvas}.dispatchEvent(new PointerEvent('{kind}', "
                          f"{{clientX: {x}, clientY: {y}, pointerId: 1}}));")

    def complaints(self):
        """What pages have complained of since the last time this was asked."""
        told = []
        for message in self.messages:
            details = message.get("params", {})
            if message.get("method") == "Runtime.exceptionThrown":
                told.append(str(details["exceptionDetails"]))
            elif message.get("method") == "Log.entryAdded" and details["entry"]["level"] in ("error", "warning"):
                told.append(details["entry"]["text"] + " " + details["entry"].get("url", ""))
            elif message.get("method") == "Runtime.consoleAPICalled" and details["type"] in ("error", "warning"):
                told.append(str(details["args"]))
        self.messages = []
        return told

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.to_write)
        os.close(self.to_read)
        self.folder.cleanup()
