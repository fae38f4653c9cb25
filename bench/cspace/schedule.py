#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Simulates how a job of slices is dealt to the cores of many nodes, and prints hours and bytes.

The costs that it starts from are measured ones: seconds and bytes of a slice of a pair of pieces. Pairs differ: their
costs are spread by --spread, a factor that two thirds of them are within. Cores differ by a few percent; a share of
them, the stragglers, is slower by --slow. A node is lost once in --mtbf hours; then, as MPI has it, the whole job ends,
what is in work is lost, and the job goes on with --resume after --restart seconds, without that node.

Three ways of dealing are compared: equal shares for each core in order (static), units of the dearest pair first as
the command's ranks do, a late one to a second core (dealt), and the bound that no way beats (ideal).
"""
import argparse
import heapq
import math
import random
from typing import NamedTuple


class Job(NamedTuple):
    units: list  # (pair, seconds of a core of speed 1)
    pairs: int
    per_pair: int


class Machine(NamedTuple):
    speeds: list  # of each core; a node's cores stand together
    cores: int  # of a node
    losses: list  # (time, node), rising
    restart: float


LATE_LEAST, LATE_TIMES = 2.0, 2.0


def make_job(rotations, pairs, per_unit, seconds, spread, rng):
    """The units of a job. The mean over all slices of all pairs is `seconds`."""
    per_pair = -(-rotations // per_unit)
    factors = [math.exp(rng.gauss(0, math.log(spread))) for _ in range(pairs)]
    mean = sum(factors) / pairs
    units = []
    for pair in range(pairs):
        for unit in range(per_pair):
            slices = min(per_unit, rotations - unit * per_unit)
            units.append((pair, slices * seconds * factors[pair] / mean * rng.uniform(0.9, 1.1)))
    return Job(units, pairs, per_pair)


def make_machine(nodes, cores, options, rng):
    speeds = []
    for _ in range(nodes * cores):
        speed = rng.uniform(0.97, 1.03)
        speeds.append(speed / options.slow if rng.random() < options.stragglers else speed)
    losses, time = [], 0.0
    while options.mtbf > 0 and len(losses) < nodes - 1:
        time += rng.expovariate(nodes / (options.mtbf * 3600))
        losses.append((time, rng.randrange(nodes)))
    return Machine(speeds, cores, losses, options.restart)


def ideal(job, machine):
    """No schedule is shorter without losses."""
    return sum(cost for _, cost in job.units) / sum(machine.speeds)


def static(job, machine):
    """Each core makes an equal run of units, whatever they cost; no losses."""
    count, cores = len(job.units), len(machine.speeds)
    return max(sum(cost for _, cost in job.units[count * i // cores:count * (i + 1) // cores]) / speed
               for i, speed in enumerate(machine.speeds))


class Dealer:
    """As tools/ranks/dealer.c deals; a heap of pairs by their mean cost stands for its scan."""

    def __init__(self, job):
        self.job = job
        self.next = [0] * job.pairs
        self.timed = [[0, 0.0] for _ in range(job.pairs)]
        self.tried = 0
        self.heap = []
        self.dealt = {}  # unit: [since, made twice]
        self.again = []  # units that a loss has thrown back
        self.done = bytearray(len(job.units))
        self.count = 0

    def push(self, pair):
        count, total = self.timed[pair]
        if self.next[pair] < self.job.per_pair:
            heapq.heappush(self.heap, (-(total / count if count else 0), pair))

    def deal(self, now):
        if self.again:
            unit = self.again.pop()
        else:
            if self.tried < self.job.pairs:
                pair = self.tried
                self.tried += 1
            elif self.heap:
                pair = heapq.heappop(self.heap)[1]
            else:
                return self.late(now)
            unit = pair * self.job.per_pair + self.next[pair]
            self.next[pair] += 1
            self.push(pair)
        self.dealt[unit] = [now, False]
        return unit

    def late(self, now):
        for unit, state in self.dealt.items():
            count, total = self.timed[unit // self.job.per_pair]
            if not state[1] and now - state[0] > max(LATE_LEAST, LATE_TIMES * (total / count if count else 0)):
                state[:] = [now, True]
                return unit
        return None

    def finish(self, unit, now):
        if self.done[unit]:
            return
        self.done[unit] = 1
        self.count += 1
        timed = self.timed[unit // self.job.per_pair]
        timed[0] += 1
        timed[1] += now - self.dealt.pop(unit)[0]

    def lose_all(self):
        """The job has ended: what is in work will be dealt again."""
        self.again += self.dealt
        self.dealt.clear()


def dealt(job, machine):
    """The time until all units are made, the losses that came, and the seconds of cores that they cost."""
    dealer = Dealer(job)
    alive = [True] * len(machine.speeds)
    losses = list(machine.losses)
    lost, wasted, run = 0, 0.0, 0
    events, now = [], 0.0  # (time, core, unit, its beginning, number of the run)
    wait = max(LATE_LEAST / 4, max(cost for _, cost in job.units) / 20)  # until one with nothing to do asks again

    def feed(core, now):
        unit = dealer.deal(now)
        cost = job.units[unit][1] / machine.speeds[core] if unit is not None else wait
        heapq.heappush(events, (now + cost, core, unit, now, run))

    for core in range(len(machine.speeds)):
        feed(core, 0.0)
    while dealer.count < len(job.units):
        if losses and losses[0][0] < events[0][0]:
            time, node = losses.pop(0)
            cores = range(node * machine.cores, (node + 1) * machine.cores)
            if time < now or not alive[cores[0]]:
                continue
            wasted += sum(max(0.0, time - event[3]) for event in events if event[2] is not None)
            lost, run, now = lost + 1, run + 1, time + machine.restart
            dealer.lose_all()
            events.clear()
            for core in cores:
                alive[core] = False
            for core, lives in enumerate(alive):
                if lives:
                    feed(core, now)
            continue
        now, core, unit, _, _ = heapq.heappop(events)
        if unit is not None:
            dealer.finish(unit, now)
        feed(core, now)
    return now, lost, wasted


def plan(options):
    """Rows of what --nodes name: (nodes, ideal, static, dealt, losses, share of time lost), in hours."""
    rows = []
    for nodes in options.nodes:
        rng = random.Random(options.seed)
        job = make_job(options.rotations, options.pairs, options.slices_per_unit, options.seconds, options.spread, rng)
        machine = make_machine(nodes, options.cores, options, rng)
        took, lost, wasted = dealt(job, machine)
        rows.append((nodes, ideal(job, machine) / 3600, static(job, machine) / 3600, took / 3600, lost,
                     wasted / sum(cost for _, cost in job.units)))
    return rows


def parse(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--rotations", type=int, default=72 * 8**6, help="of the grid (level 6)")
    add("--pairs", type=int, default=1000, help="of a robot's piece and an obstacle's")
    add("--seconds", type=float, required=True, help="of one core for a slice of a pair, writing included")
    add("--bytes", type=float, required=True, help="of the file for a slice of a pair")
    add("--slices-per-unit", type=int, default=65536)
    add("--spread", type=float, default=2.0, help="of the pairs' costs, a factor")
    add("--nodes", type=lambda text: [int(n) for n in text.split(",")], default=[1, 4, 16, 64])
    add("--cores", type=int, default=32, help="of a node")
    add("--stragglers", type=float, default=0.02, help="share of cores that are slow")
    add("--slow", type=float, default=4.0, help="how many times as long they take")
    add("--mtbf", type=float, default=2000.0, help="hours between two losses of one node; 0: none")
    add("--restart", type=float, default=300.0, help="seconds from a loss to the job's going on")
    add("--seed", type=int, default=1)
    return parser.parse_args(arguments)


def main():
    options = parse()
    slices = options.rotations * options.pairs
    print(f"{slices:.4g} slices, {slices * options.seconds / 3600:.4g} core hours, "
          f"{slices * options.bytes / 1e9:.4g} GB")
    print("| nodes | cores | ideal, h | static, h | dealt, h | nodes lost | work done twice |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for nodes, best, fixed, took, lost, wasted in plan(options):
        print(f"| {nodes} | {nodes * options.cores} | {best:.3g} | {fixed:.3g} | {took:.3g} | {lost} | {wasted:.2%} |")


if __name__ == "__main__":
    main()
