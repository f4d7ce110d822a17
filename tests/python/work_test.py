# SPDX-License-Identifier: Apache-2.0
"""Long work: progress, signals, threads. Nothing here depends on how long anything takes.

Run as: work_test.py, with VMLIGHT_SOURCE and the package on PYTHONPATH"""
import os
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np

import vmlight
from scenes import Case, pit, plane, sky

# Minutes of rays, in tiles that take a fraction of a second.
ENDLESS = dict(occluder=pit(), resolution=2048, samples=512, reconstruct="off", margin=0)


class Stop(Exception):
    pass


class Progress(Case):
    def test_the_share_grows_to_one(self):
        calls = []
        vmlight.make_vismap(plane(), pit(), resolution=128, samples=4, progress=lambda *call: calls.append(call))
        self.assertEqual(calls[-1], (1.0, "bake"))
        done = [share for share, step in calls if step == "bake"]
        self.assertEqual(done, sorted(done))

    def test_every_function_tells(self):
        vismap = vmlight.make_vismap(plane(), resolution=8)
        for step, call in [("filter", lambda **a: vmlight.make_cfem(sky(), **a)),
                           ("light", lambda **a: vmlight.make_lightmap(vismap, sky(), **a)),
                           ("light", lambda **a: vmlight.Relighter(vismap, sky()).light(**a)),
                           ("trace", lambda **a: vmlight.make_reference(plane(), sky(), resolution=8, samples=4, **a)),
                           ("write", lambda **a: vismap.write(os.path.join(self.folder(), "a.exr"), **a))]:
            calls = []
            call(progress=lambda *call: calls.append(call))
            self.assertEqual(calls[-1], (1.0, step))

    def test_what_the_callback_raises_stops_the_work(self):
        calls = []

        def progress(done, step):
            calls.append(threading.current_thread())
            raise Stop(step)

        for _ in range(2):  # the first leaves nothing behind that hinders the second
            with self.assertRaises(Stop):
                vmlight.make_vismap(plane(), progress=progress, **ENDLESS)
        self.assertEqual(calls, [threading.current_thread()] * 2)
        relighter = vmlight.Relighter(vmlight.make_vismap(plane(), resolution=8), sky())
        with self.assertRaises(Stop):
            relighter.light(progress=progress)
        self.assertTrue(np.isfinite(relighter.light().pixels).all())

    def test_a_callback_may_bake(self):
        made = []

        def progress(done, step):
            if not made:
                made.append(vmlight.make_vismap(plane(), resolution=4))

        vmlight.make_vismap(plane(), pit(), resolution=64, samples=4, progress=progress)
        self.assertEqual(made[0].pixels.shape, (4, 4, 4))

    def test_a_callback_that_takes_other_arguments_fails(self):
        with self.assertRaises(TypeError):
            vmlight.make_vismap(plane(), progress=lambda: None, **ENDLESS)


class Signals(Case):
    def test_ctrl_c_raises_keyboard_interrupt(self):
        started = threading.Event()

        def interrupt():
            started.wait()
            os.kill(os.getpid(), signal.SIGINT)

        other = threading.Thread(target=interrupt)
        other.start()
        with self.assertRaises(KeyboardInterrupt):
            vmlight.make_vismap(plane(), progress=lambda *_: started.set(), **ENDLESS)
        other.join()

    def test_other_signals_are_handled_meanwhile(self):
        handled = []
        started = threading.Event()
        before = signal.signal(signal.SIGUSR1, lambda *_: handled.append(threading.current_thread()))
        self.addCleanup(signal.signal, signal.SIGUSR1, before)

        def send():
            started.wait()
            os.kill(os.getpid(), signal.SIGUSR1)

        def progress(done, step):
            started.set()
            if handled:
                raise Stop

        other = threading.Thread(target=send)
        other.start()
        with self.assertRaises(Stop):
            vmlight.make_vismap(plane(), progress=progress, **ENDLESS)
        other.join()
        self.assertEqual(handled, [threading.main_thread()])

    def test_an_interrupted_write_leaves_no_file(self):
        folder = self.folder()

        def progress(done, step):
            raise KeyboardInterrupt

        image = vmlight.Image(np.zeros((2048, 2048, 4), np.float32))
        try:
            image.write(os.path.join(folder, "a.exr"), progress=progress)
        except KeyboardInterrupt:
            pass
        # Whole, if it was done before it heard; else not there.
        for name in os.listdir(folder):
            self.assertEqual(vmlight.Image.read(os.path.join(folder, name)).pixels.shape, (2048, 2048, 4))


class Threads(Case):
    def test_other_threads_run_during_a_bake(self):
        # No thread gives way by itself: the other one runs only while the bake does not hold the lock.
        interval = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, interval)
        gate, steps = threading.Event(), [0]

        def count():
            gate.wait()
            for _ in range(1000):
                steps[0] += 1

        def progress(done, step):
            if steps[0] == 1000:
                raise Stop

        other = threading.Thread(target=count)
        other.start()
        sys.setswitchinterval(1000)
        gate.set()
        with self.assertRaises(Stop):
            vmlight.make_vismap(plane(), progress=progress, **ENDLESS)
        sys.setswitchinterval(interval)
        other.join()

    def test_threads_bake_and_light_at_once(self):
        vismap = vmlight.make_vismap(plane(), pit(), resolution=64, samples=16)
        relighter = vmlight.Relighter(vismap, sky())
        turns = [(0, 0, 20 * i) for i in range(8)]
        expected = [relighter.light(rotate=turn).pixels.copy() for turn in turns]
        faults = []

        def bake():
            for _ in range(4):
                again = vmlight.make_vismap(plane(), pit(), resolution=64, samples=16)
                faults.extend([] if (again.pixels == vismap.pixels).all() else ["bake"])

        def light():
            for _ in range(10):
                for turn, pixels in zip(turns, expected):
                    lit = relighter.light(rotate=turn)
                    faults.extend([] if (lit.pixels == pixels).all() else ["light"])

        threads = [threading.Thread(target=work) for work in (bake, bake, light, light, light)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(faults, [])

    def test_python_exits_during_a_bake(self):
        # Of a thread that it does not wait for.
        code = """
import threading
import vmlight
from scenes import pit, plane
started = threading.Event()
arguments = dict(occluder=pit(), resolution=2048, samples=512, reconstruct="off", margin=0)
bake = lambda: vmlight.make_vismap(plane(), progress=lambda *_: started.set(), **arguments)
threading.Thread(target=bake, daemon=True).start()
started.wait()
"""
        result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300,
                                cwd=os.path.dirname(os.path.abspath(__file__)))
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_a_forked_process_works(self):
        expected = vmlight.make_vismap(plane(), pit(), resolution=128, samples=4)
        child = os.fork()
        if child == 0:  # no exception may reach the code of the parent
            code = 1
            try:
                code = int((vmlight.make_vismap(plane(), pit(), resolution=128, samples=4).pixels != expected.pixels).any())
            finally:
                os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_any_number_of_threads_gives_the_same(self):
        one = vmlight.make_vismap(plane(), pit(), resolution=64, samples=16, threads=1)
        self.assert_same(vmlight.make_vismap(plane(), pit(), resolution=64, samples=16, threads=3), one)


if __name__ == "__main__":
    unittest.main()
