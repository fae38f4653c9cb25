# SPDX-License-Identifier: MIT
"""All angles at which a sum changes while one body makes a full turn, in order, and the sum between them."""
import pirouette

p, q = pirouette.Polytope.shape("cube"), pirouette.Polytope.shape("dodecahedron")
sum_ = pirouette.MinkowskiSum(p, q)
turn = sum_.events([1, 2, 3])
facets = turn.facet_count()  # just after the begin, where features of both lie in parallel
events = list(turn)
print(f"{len(events)} events in a turn about (1, 2, 3), {facets} facets at first")
for event in events:
    facets += len(event.gained) - len(event.lost)
    if event.after is not None:
        sum_.rotate(event.after)  # a rotation between this event and the next
        assert len(sum_.mesh()) == facets
for event in events[:5]:
    print(f"{event.angle[0]:.9f} degrees: {len(event.lost)} facets end, {len(event.gained)} begin")
print("done: turns")
