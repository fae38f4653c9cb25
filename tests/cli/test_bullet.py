#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What stands, and with SETTLES what comes to rest, in a Bullet world with Pirouette's narrow phase.

Usage: test_bullet.py PROGRAM ROOT SECONDS [SETTLES]   SETTLES is how long the pile of 500 hulls runs.
"""
import re
import subprocess
import sys

LINE = re.compile(r"Pirouette's narrow phase: +(stands for|moves on at) ([\d.]+) s, at the end mean speed (\S+) m/s, "
                  r"deepest overlap (\S+) m, (\S+) % of a size$", re.M)


def run(program, root, name, seconds):
    done = subprocess.run([program, f"{root}/examples/scenes/{name}.json", seconds, "pirouette"],
                          capture_output=True, text=True, timeout=3000)
    assert (done.returncode, done.stderr) == (0, ""), done
    print(done.stdout, end="")
    line, = LINE.findall(done.stdout)
    return line


def main(program, root, seconds, settles=None):
    for name in ("stack", "cards"):
        what, when, speed, _, part = run(program, root, name, seconds)
        assert (what, float(when)) == ("stands for", float(seconds)), (name, what, when)
        assert float(speed) < 0.005 and float(part) < 0.1, (name, speed, part)
    if settles:
        _, _, speed, _, part = run(program, root, "pile", settles)
        assert float(speed) < 1e-3 and float(part) < 2, ("pile", speed, part)
    # compounds, and one that does not read
    done = subprocess.run([program, f"{root}/examples/scenes/gears.json", "0.1"], capture_output=True, text=True,
                          timeout=600)
    assert done.returncode == 0 and done.stdout.count("\n") == 3, done
    done = subprocess.run([program, f"{root}/none.json"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 2 and "none.json" in done.stderr, done


if __name__ == "__main__":
    main(*sys.argv[1:])
