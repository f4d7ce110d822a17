#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The time that whole bakes take to a given error, by an old build and by this one, as a Markdown table:

    bench/time_to_error.py OUT_FOLDER [MESH ...]

Of the six scenes of bench/scenes.py, and of meshes: for V and for B, the rays per texel that an RMS error takes, and the
seconds of the whole process with as many, the least of some rounds in which the builds take turns; then its processor time,
which other work on the machine changes less. The last lines are the means of the six scenes and of the meshes: of all their
seconds, and of the ratios.

VMLIGHT_BIN has the executables of this build (build/release/bin), among them map_error. VMLIGHT_OLD_BIN has makevismap of
the old one; without it, VMLIGHT_OLD_COMMIT (7ebb889, the last without reconstruction) is built in OUT_FOLDER.
VMLIGHT_ERRORS (".01 .005"), VMLIGHT_RESOLUTION (1024), VMLIGHT_THREADS (2), VMLIGHT_ROUNDS (3) and
VMLIGHT_REFERENCE_SAMPLES (2048) change what is measured. Maps are kept: an interrupted run resumes where it stopped; delete
them to measure another build.
"""
import math
import os
import resource
import subprocess
import sys
import time

from help_flag import answer_help
import reconstruct

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.path.abspath(reconstruct.BIN)
ERRORS = [float(word) for word in os.environ.get("VMLIGHT_ERRORS", ".01 .005").split()]
RESOLUTION = os.environ.get("VMLIGHT_RESOLUTION", "1024")
THREADS = os.environ.get("VMLIGHT_THREADS", "2")
ROUNDS = int(os.environ.get("VMLIGHT_ROUNDS", "3"))
REFERENCE = os.environ.get("VMLIGHT_REFERENCE_SAMPLES", "2048")
COUNTS = [2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 91, 128, 181, 256, 362, 512, 724, 1024]
FIRST = COUNTS.index(16)
SLOPE = .65  # of the logarithms of errors over those of rays, roughly; two counts apart, rays double
QUANTITIES = {"V": 0, "B": 3}  # columns of map_error


def old_build(folder):
    """The folder of the old makevismap."""
    if "VMLIGHT_OLD_BIN" in os.environ:
        return os.path.abspath(os.environ["VMLIGHT_OLD_BIN"])
    source, build = os.path.join(folder, "old"), os.path.join(folder, "old", "build", "time_to_error")
    if not os.path.exists(source):
        subprocess.run(["git", "-C", os.path.join(HERE, ".."), "worktree", "add", "--detach", os.path.abspath(source),
                        os.environ.get("VMLIGHT_OLD_COMMIT", "7ebb889")], check=True, stdout=sys.stderr)
    for words in (["cmake", "-S", source, "-B", build, "-DCMAKE_BUILD_TYPE=Release"],
                  ["cmake", "--build", build, "--target", "makevismap", "--parallel"]):
        subprocess.run(words, check=True, stdout=sys.stderr)
    return os.path.abspath(os.path.join(build, "bin"))


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def bake(binaries, mesh, out, samples, *flags):
    """Seconds of the whole process, and of all processors."""
    begin, used = time.monotonic(), processor_seconds()
    subprocess.run([os.path.join(binaries, "makevismap"), mesh, "-o", out, "--resolution", RESOLUTION, "--samples",
                    str(samples), "--threads", THREADS, "--quiet", *flags], check=True, stderr=subprocess.DEVNULL)
    return time.monotonic() - begin, processor_seconds() - used


class Build:
    """Maps of a mesh by one build, and their errors."""

    def __init__(self, binaries, kind, folder, mesh, flags=(), plain_flags=()):
        self.binaries, self.flags, self.kind, self.folder, self.mesh = binaries, flags, kind, folder, mesh
        self.name = os.path.splitext(os.path.basename(mesh))[0]
        self.known = {}
        # Each has its own: the old build cuts bent quads along other diagonals, which is another surface.
        self.truth = os.path.join(folder, f"{self.name}.{RESOLUTION}.truth.{kind}.exr")
        if not os.path.exists(self.truth):
            bake(binaries, mesh, self.truth, REFERENCE, "--seed", "77", "--channels", "coverage", *plain_flags)

    def errors(self, samples):
        if samples not in self.known:
            out = os.path.join(self.folder, f"{self.name}.{RESOLUTION}.{samples}.{self.kind}.exr")
            if not os.path.exists(out):
                bake(self.binaries, self.mesh, out, samples, *self.flags)
            self.known[samples] = reconstruct.errors(self.truth, out)
        return self.known[samples]

    def rays_for(self, column, error):
        """The fewest rays per texel: between two counts, by their errors' logarithms. None if out of reach."""
        # Leaps along the slope that errors usually have find the two counts with few bakes; then single steps make sure.
        here, meets = FIRST, {}
        while True:
            meets[here] = self.errors(COUNTS[here])[column] <= error
            below = max((k for k, met in meets.items() if not met), default=-1)
            above = min((k for k, met in meets.items() if met and k > below), default=len(COUNTS))
            if above - below == 1:
                break
            leap = round(math.log2(self.errors(COUNTS[here])[column] / error) / SLOPE * 2)
            here = min(max(here + leap, below + 1), above - 1)
        if above == len(COUNTS):
            return None
        if below < 0:
            return COUNTS[above]
        few, many = COUNTS[below], COUNTS[above]
        low, high = (math.log(self.errors(count)[column]) for count in (few, many))
        share = (low - math.log(error)) / (low - high)
        return math.ceil(few * (many / few) ** share)

    def time(self, samples):
        return bake(self.binaries, self.mesh, os.path.join(self.folder, f"timed.{self.kind}.exr"), samples,
                    *self.flags)


def text(times):
    """Of [seconds of the old build, of the new] by the clock and the same of the processor: the cells of a row."""
    return " | ".join(f"{old:.2f} | {new:.2f} | {old / new:.2f}" for old, new in times)


def print_means(title, rows):
    for quantity in QUANTITIES:
        for error in ERRORS:
            some = [times for key, times in rows if key == (quantity, error)]
            if not some:
                continue
            means = [[sum(times[clock][k] for times in some) / len(some) for k in (0, 1)] for clock in (0, 1)]
            ratio = math.exp(sum(math.log(times[0][0] / times[0][1]) for times in some) / len(some))
            print(f"| **{title}**, mean ratio {ratio:.2f} | {quantity} | {error:g} | | | {text(means)} |")


def main():
    answer_help(__doc__)
    if len(sys.argv) < 2:
        sys.exit("usage: bench/time_to_error.py OUT_FOLDER [MESH ...]")
    folder, more = sys.argv[1], sys.argv[2:]
    os.makedirs(folder, exist_ok=True)
    scenes = os.path.join(folder, "scenes")
    subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), scenes], check=True)
    old = old_build(folder)
    print("| mesh | of | RMS error | rays, old | new | seconds, old | new | old / new | processor, old | new | old / new |")
    print("|---" * 11 + "|")
    results = {"six scenes": [], "meshes": []}
    six = [os.path.join(scenes, name + ".obj") for name in reconstruct.SCENES]
    for mesh in six + more:
        name = os.path.splitext(os.path.basename(mesh))[0]
        builds = [Build(old, "old", folder, mesh),
                  Build(BIN, "new", folder, mesh, ["--reconstruct", "auto"], ["--reconstruct", "off"])]
        for quantity, column in QUANTITIES.items():
            for error in ERRORS:
                rays = [build.rays_for(column, error) for build in builds]
                if None in rays:
                    print(f"| {name} | {quantity} | {error:g} | {rays[0] or '-'} | {rays[1] or '-'}" + " |" * 7, flush=True)
                    continue
                times = [[math.inf, math.inf], [math.inf, math.inf]]
                for _ in range(ROUNDS):
                    for k, build in enumerate(builds):
                        for clock, seconds in zip(times, build.time(rays[k])):
                            clock[k] = min(clock[k], seconds)
                results["six scenes" if mesh in six else "meshes"].append(((quantity, error), times))
                print(f"| {name} | {quantity} | {error:g} | {rays[0]} | {rays[1]} | {text(times)} |", flush=True)
    for title, rows in results.items():
        print_means(title, rows)


if __name__ == "__main__":
    main()
