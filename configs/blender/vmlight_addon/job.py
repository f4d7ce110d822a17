# SPDX-License-Identifier: Apache-2.0
"""Commands that run one after the other beside Blender, with their progress."""
import os
import subprocess
import threading
import time

from . import messages

try:
    import pty
except ImportError:  # Windows
    pty = None

KILL_AFTER = 3.0  # seconds, of a process that does not heed SIGTERM


class Step:
    """@param label: what the user calls it; a line of progress starts with it
    @param words: the command. Its first argument is a temporary file: messages call it by the label"""

    def __init__(self, label, words):
        self.label, self.words = label, words

    def readable(self, text):
        return text.replace(f'"{self.words[1]}"', f'"{self.label}"') if self.label and len(self.words) > 1 else text


class Job:
    """Runs steps in a thread. All that is read from outside is a plain value, set by the thread."""

    def __init__(self, steps):
        self.steps = list(steps)
        self.fraction, self.line = 0.0, ""
        self.log = []  # (kind, text): warnings, errors and notes
        self.error = ""
        self.cancelled = self.finished = False
        self._process = None
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._run, name="vmlight", daemon=True)

    def start(self):
        self._thread.start()
        return self

    def wait(self, seconds=None):
        self._thread.join(seconds)
        return self

    def cancel(self):
        """Ends the process that runs, and waits for it: it leaves no file behind."""
        with self._lock:
            self.cancelled = True
            process = self._process
            if process and process.poll() is None:
                process.terminate()
        if self._thread.is_alive():
            self.wait(KILL_AFTER)
        if process and process.poll() is None:
            process.kill()
            self.wait()

    def _run(self):
        try:
            for number, step in enumerate(self.steps):
                if not self._run_step(number, step):
                    return
            self.fraction = 1.0
        except Exception as fault:  # a thread's exception would be seen by nobody
            self.error = str(fault)
        finally:
            self.finished = True

    def _run_step(self, number, step):
        self.line = step.label
        with self._lock:
            if self.cancelled:
                return False
            try:
                stream = self._start(step.words)
            except OSError as fault:
                self.error = f'cannot run "{step.words[0]}": {fault.strerror or fault}'
                return False
        lines = messages.Lines()
        for data in stream:
            for message in lines.feed(data):
                self._take(message, number, step)
        for message in lines.end():
            self._take(message, number, step)
        code = self._process.wait()
        if code and not self.cancelled:
            errors = [text for kind, text in self.log if kind == "ERROR"]
            name = os.path.basename(step.words[0])
            self.error = errors[-1] if errors else f"{name} ended with " + (f"signal {-code}" if code < 0 else f"code {code}")
        return code == 0 and not self.cancelled

    def _take(self, message, number, step):
        if message.kind == "PROGRESS":
            self.fraction = (number + message.fraction) / len(self.steps)
            self.line = f"{step.label}: {message.text}" if step.label else message.text
        else:
            self.log.append((message.kind, step.readable(message.text)))

    def _start(self, words):
        """Starts the process, and returns the chunks of what it prints. A terminal hears of progress ten times a second,
        a pipe, where there is no terminal, every tenth of the work."""
        options = {"stdin": subprocess.DEVNULL}
        if os.name == "nt":
            options["creationflags"] = subprocess.CREATE_NO_WINDOW
        terminal = _open_terminal()
        if not terminal:
            self._process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
            return iter(lambda: self._process.stdout.read1(4096), b"")
        ours, theirs = terminal
        try:
            self._process = subprocess.Popen(words, stdout=theirs, stderr=theirs, start_new_session=True, **options)
        except OSError:
            os.close(ours)
            raise
        finally:
            os.close(theirs)
        return _terminal(ours)


def _open_terminal():
    """Both ends of a new one, or None."""
    try:
        return pty.openpty() if pty else None
    except OSError:  # a container without /dev/pts
        return None


def _terminal(descriptor):
    try:
        while True:
            try:
                data = os.read(descriptor, 4096)
            except OSError:  # Linux's way to say that the other end is closed
                return
            if not data:
                return
            yield data
    finally:
        os.close(descriptor)


def run(steps, seconds=600):
    """Runs the steps and waits for them: for scripts, and what takes no time.

    @returns the Job; its `error` is "" if all went well"""
    job = Job(steps).start()
    end = time.monotonic() + seconds
    job.wait(max(end - time.monotonic(), 0))
    if not job.finished:
        job.cancel()
        job.error = f"{job.line}: not done within {seconds:g} s"
    return job
