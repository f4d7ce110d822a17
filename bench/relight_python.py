# SPDX-License-Identifier: Apache-2.0
"""The relight loop in Python against the same in C++: lightmaps of a 1024x1024 map for many rotations, in turns.

Run as: relight_python.py BUILD [ROUNDS [COUNT]], with BUILD/python on PYTHONPATH. Prints the best and the median lightmap of
each, and their ratios. Other work on the machine only ever adds time, to either."""
import os
import subprocess
import sys
import tempfile
import time

from help_flag import answer_help

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/data")
SIDE = 1024


def relight_in_python(relighter, count, threads):
    times = []
    for i in range(count):
        start = time.perf_counter()
        lightmap = relighter.light(rotate=(0, 360 * i / count, 0), threads=threads)
        times.append(1e3 * (time.perf_counter() - start))
    assert lightmap.pixels.shape == (SIDE, SIDE, 3)
    return times


def main():
    answer_help(__doc__)
    import vmlight  # --help needs no PYTHONPATH

    build = sys.argv[1]
    rounds, count = [int(number) for number in sys.argv[2:4] + ["5", "200"][len(sys.argv[2:4]):]]
    environment = os.path.join(DATA, "studio_small_03.hdr")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "vismap.exr")
        vmlight.make_vismap(os.path.join(DATA, "spot.obj"), resolution=SIDE, samples=16).write(path)
        relighter = vmlight.Relighter(path, environment)
        for threads in 1, 0:
            best, medians = {}, {}
            for _ in range(rounds):
                program = [os.path.join(build, "bin/relight_bench"), path, environment, str(count), str(threads)]
                least, median = map(float, subprocess.run(program, check=True, capture_output=True, text=True).stdout.split())
                python = sorted(relight_in_python(relighter, count, threads))
                for name, low, middle in ("C++", least, median), ("Python", python[0], python[count // 2]):
                    best[name] = min(low, best.get(name, low))
                    medians[name] = min(middle, medians.get(name, middle))
            print(f"{threads or 'all'} threads, best: C++ {best['C++']:.3f} ms, Python {best['Python']:.3f} ms, "
                  f"ratio {best['Python'] / best['C++']:.3f}; best median: C++ {medians['C++']:.3f} ms, Python "
                  f"{medians['Python']:.3f} ms, ratio {medians['Python'] / medians['C++']:.3f}")


if __name__ == "__main__":
    main()
