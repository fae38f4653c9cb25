# SPDX-License-Identifier: MIT
"""The rotations of a tracked run, from the text of tools/motion.h and tools/turn.h alone."""
import math

MASK = 2**64 - 1


def random_numbers(seed):
    """Numbers from -1 to 1."""
    state = seed
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield ((z ^ (z >> 31)) >> 11) * 2.0**-52 - 1


def axes(seed):
    numbers = random_numbers(seed)
    while True:
        axis = [next(numbers), next(numbers), next(numbers)]
        if 2.0**-20 < axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2] <= 1:
            yield axis


def turn(axis, part, whole):
    """About `axis` by part/whole of a full turn."""
    back, part = part < 0, math.fmod(abs(part), whole)
    if 2 * part > whole:
        part, back = whole - part, not back
    if part == 0:
        return (0.0, 0.0, 0.0, 1.0)
    x, y, z = axis
    square = x * x + y * y + z * z
    exact = {2: 0.0, 3: math.sqrt(square / 3), 4: math.sqrt(square), 6: math.sqrt(square * 3)}
    if whole / part in exact:
        w = exact[whole / part]
    elif 4 * part > whole:
        rest = math.pi * (whole - 2 * part) / (2 * whole)
        x, y, z, w = x * math.cos(rest), y * math.cos(rest), z * math.cos(rest), math.sqrt(square) * math.sin(rest)
    else:
        half = math.pi * part / whole
        x, y, z, w = x * math.sin(half), y * math.sin(half), z * math.sin(half), math.sqrt(square) * math.cos(half)
    return (x, y, z, -w if back and whole != 2 * part else w)


def after(a, b):
    """b after a, of length 1."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    q = (bw * ax + bx * aw + by * az - bz * ay, bw * ay - bx * az + by * aw + bz * ax,
         bw * az + bx * ay - by * ax + bz * aw, bw * aw - bx * ax - by * ay - bz * az)
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return tuple(c / length for c in q)


def motion(frames, steps, axis=None, seed=1):
    """The rotation one step before frame 0, then those of the frames; random axes from `seed` where none is given."""
    source = axes(seed)
    about = axis or next(source)
    rotations, now = [turn(about, -1, steps)], (0.0, 0.0, 0.0, 1.0)
    for frame in range(frames):
        if axis:
            now = turn(axis, frame % steps, steps)
        elif frame:
            about = next(source) if frame % 50 == 0 else about
            now = after(now, turn(about, 1, steps))
        rotations.append(now)
    return rotations
