# The distance of a point from a polytope, from above: solid/pieces/convex_distance. u = 2^-53, R = 1.
# proves: src/solid/pieces/convex_distance.h "Both are less than 2^-47 R" 64 >= 46
#
# A difference w of two points is up to 2 sqrt(3) long; a unit normal n is off by 4u; a dot product rounds by 3.02u. The
# product n x s of it and a side rounds by 3u, its length aside (cross.g).
height = sqrt(12) * ((1 + n) * (1 + w) * (1 + last) - 1);
beside = sqrt(12) * ((1 + n) * (1 + w) * (1 + cross) * (1 + w) * (1 + last) - 1);
{ n in [0, 4b-53] /\ w in [0, 1b-53] /\ last in [0, 0x3.02p-53] /\ cross in [0, 3b-53]
-> height in [0, 28b-53] /\ beside in [0, 46b-53] }
