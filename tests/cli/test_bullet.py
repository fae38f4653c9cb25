#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What stands in a Bullet world with Pirouette's narrow phase: test_bullet.py PROGRAM ROOT SECONDS"""
import re
import subprocess
import sys

LINE = re.compile(r"Pirouette's narrow phase: +(stands for|moves on at) ([\d.]+) s, at the end mean speed (\S+) m/s, "
                  r"deepest overlap (\S+) m$", re.M)


def main(program, root, seconds):
    for name in ("stack", "cards"):
        done = subprocess.run([program, f"{root}/examples/scenes/{name}.json", seconds, "pirouette"],
                              capture_output=True, text=True, timeout=1800)
        assert (done.returncode, done.stderr) == (0, ""), done
        (what, when, speed, depth), = LINE.findall(done.stdout)
        assert (what, float(when)) == ("stands for", float(seconds)), done.stdout
        assert float(speed) < 0.02 and float(depth) < 1e-3, done.stdout
    # compounds, and one that does not read
    done = subprocess.run([program, f"{root}/examples/scenes/gears.json", "0.1"], capture_output=True, text=True,
                          timeout=60)
    assert done.returncode == 0 and done.stdout.count("\n") == 3, done
    done = subprocess.run([program, f"{root}/none.json"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "none.json" in done.stderr, done


if __name__ == "__main__":
    main(*sys.argv[1:])
