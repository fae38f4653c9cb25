# SPDX-License-Identifier: MIT
"""A million poses from numpy beside a loop of C's own over the same, on one thread and on two.

Usage: batch.py POSE_LOOP [COUNT]   POSE_LOOP is the program of bench/pairs/pose_loop.c; the package is importable.

Answers have to be the same bits. Figures are the least of five rounds, in which the ways take turns, in nanoseconds a
pose: of one thread CPU time, for a machine that does other things as well, of two against one wall time. Memory is what
the process has grown by in the last rounds.
"""
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

import pirouette

ROUNDS = 5


def sphere(count, seed):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return pirouette.Polytope(points / np.linalg.norm(points, axis=1)[:, None])


def hovering(count):
    """P turns by a 500th of a turn a pose, about an axis that changes every 50, and comes and goes about contact."""
    random = np.random.default_rng(7)
    poses = np.empty((count, 7))
    axes = np.repeat(random.normal(size=(count // 50 + 1, 3)), 50, axis=0)[:count]
    half = np.arange(count) * (np.pi / 500)
    poses[:, :3] = axes / np.linalg.norm(axes, axis=1)[:, None] * np.sin(half)[:, None]
    poses[:, 3] = np.cos(half)
    angle = np.arange(count) / 300
    reach = 1.8 + 0.2 * np.sin(np.arange(count) / 40)
    poses[:, 4:] = np.stack([np.cos(angle), np.sin(angle), 0.3 * np.sin(angle / 7)], axis=1) * reach[:, None]
    return poses


def loop(program, folder, rounds):
    """Nanoseconds a pose of C's own loop, and its distances."""
    told = subprocess.run([program, folder / "p.off", folder / "q.off", folder / "poses", folder / "distances",
                           str(rounds)], check=True, capture_output=True, text=True).stdout
    return min(map(float, told.split())), np.fromfile(folder / "distances")


def run(program, folder, vertices, count):
    p, q, poses = sphere(vertices, 1), sphere(vertices, 2), hovering(count)
    p.write(folder / "p.off", exact=True)
    q.write(folder / "q.off", exact=True)
    p, q = pirouette.Polytope.read(folder / "p.off"), pirouette.Polytope.read(folder / "q.off")
    poses.tofile(folder / "poses")
    pairs = [pirouette.Pair(p, q), pirouette.Pair(p, q, threads=2)]
    cpu, wall = [np.inf] * 2, [np.inf] * 2
    for number in range(ROUNDS):
        ns, right = loop(program, folder, 1)
        cpu[0] = min(cpu[0], ns)
        for way, pair in enumerate(pairs):
            start, used = time.perf_counter(), time.process_time()
            answers = pair.signed_distance(poses)
            wall[way] = min(wall[way], (time.perf_counter() - start) / count * 1e9)
            if way == 0:
                cpu[1] = min(cpu[1], (time.process_time() - used) / count * 1e9)
            assert np.array_equal(answers.distance, right)
        del answers
        if number == 1:
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    print(f"{vertices:4d} vertices: C's loop {cpu[0]:7.1f} ns, numpy {cpu[1]:7.1f} ({cpu[1] / cpu[0]:.3f}x); "
          f"wall {wall[0]:7.1f}, on two threads {wall[1]:7.1f} ({wall[0] / wall[1]:.2f}x); grown by {grown} KB")


def main(program, count):
    with tempfile.TemporaryDirectory() as folder:
        for vertices in (8, 60, 500):
            run(program, pathlib.Path(folder), vertices, count)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 1000000)
