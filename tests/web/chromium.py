"""A page in headless Chromium, driven through its debugging pipe."""

import base64
import json
import os
import pathlib
import select
import shutil
import subprocess
import tempfile
import time


class Page:
    """An open page. A context manager: the browser ends with it."""

    def __init__(self, url, size=(1280, 720), flags=()):
        self.folder = tempfile.mkdtemp(prefix="relevo-web-")
        self.count, self.answers, self.events, self.rest = 0, {}, [], b""
        to_child, self.to = os.pipe()
        self.of, of_child = os.pipe()

        def pipes():
            # Chromium reads from 3 and writes to 4. Numbers that are in the way move first.
            a, b = os.dup(to_child), os.dup(of_child)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self.process = subprocess.Popen(
            [shutil.which("chromium"), "--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-gpu-sandbox",
             "--remote-debugging-pipe", f"--user-data-dir={self.folder}", f"--window-size={size[0]},{size[1]}", *flags, "about:blank"],
            preexec_fn=pipes, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_child)
        os.close(of_child)
        target = next(t for t in self.send("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.send("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.send(f"{domain}.enable")
        self.send("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False)
        self.events.clear()
        self.send("Page.navigate", url=url)
        while not any(e["method"] == "Page.loadEventFired" for e in self.events):
            self.receive(60)

    session = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.to)
        os.close(self.of)
        shutil.rmtree(self.folder, ignore_errors=True)

    def send(self, method, timeout_s=60, **params):
        self.count += 1
        message = {"id": self.count, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + timeout_s
        while self.count not in self.answers:
            self.receive(end - time.monotonic())
        answer = self.answers.pop(self.count)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def receive(self, wait_s):
        if wait_s <= 0 or not select.select([self.of], [], [], wait_s)[0]:
            raise TimeoutError("Chromium does not answer")
        *messages, self.rest = (self.rest + os.read(self.of, 1 << 20)).split(b"\0")
        for message in map(json.loads, messages):
            if "id" in message:
                self.answers[message["id"]] = message
            else:
                self.events.append(message)

    def value(self, script, timeout_s=60):
        """Of an expression or a promise, as JSON has it."""
        result = self.send("Runtime.evaluate", timeout_s, expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description", details["text"]))
        return result["result"].get("value")

    def wait(self, script, timeout_s=60):
        """Until an expression is true."""
        end = time.monotonic() + timeout_s
        while not self.value(script):
            if time.monotonic() > end:
                raise TimeoutError(f"still not so after {timeout_s} s: {script}")
            time.sleep(0.05)

    def screenshot(self, path):
        pathlib.Path(path).write_bytes(base64.b64decode(self.send("Page.captureScreenshot")["data"]))

    def requests(self):
        """Addresses that the page asked for, but for what lies in itself."""
        return [e["params"]["request"]["url"] for e in self.events if e["method"] == "Network.requestWillBeSent"
                and not e["params"]["request"]["url"].startswith(("blob:", "data:"))]

    def complaints(self):
        """Errors that the browser wrote into its console."""
        return [e["params"]["entry"]["text"] for e in self.events if e["method"] == "Log.entryAdded"] + \
            [e["params"]["exceptionDetails"]["text"] for e in self.events if e["method"] == "Runtime.exceptionThrown"]
