# Slacks: PIR_SLACK_BOUND. u = 2^-53.
# proves: src/query/frame/frame.h "#define PIR_SLACK_BOUND 0x1p-46" 128 >= 115
# proves: src/query/frame/frame.h "Together that is below 60u" 60 >= 60
# proves: src/query/frame/frame.h "less than 64u / sin" 64 >= 62
#
# Unit vectors are off by 6u (unit.g), turned ones by `turned`: r by 35u where it is relative (relative.g), the product
# rounds by `rows` (dot.g).
# Lemma. Of two unit vectors with errors da and db, at an angle of the sine s, the product is off by
# (1 + da)(1 + db) - 1 and by its rounding, `cross`; over its length s that is the error of its direction; `scaling` is
# that of its length (cross.g). Directions of a' and a differ by 2 |a' - a| / |a| at most, and by (1 + eps) of that
# where it is small: below, for s above 2^-40, as edges nearer to parallel have exact normals (PIR_SIN_EXACT), by
# (1 + 2^-10). So `edges` bounds the error times s.
# Slacks h - n x are over the lengths that they are made of: a vertex is off by 3u, one of P that is turned by `vertex`,
# x by 2u; a difference or a sum of vertices rounds by u, a dot product by `last`, the last two operations by 2u. `facet`
# has a turned normal, `other` Q's and a turned vertex, `edge` that of two edges, times err, and a turned vertex.
turned = (1 + dr) * (1 + da) - 1 + rows * (1 + dr) * (1 + da);
product = (1 + turned) * (1 + da) - 1 + cross * (1 + turned) * (1 + da);
edges = product * (1 + 1b-10) + scaling;
vertex = (1 + v) * (1 + dr) * (1 + rows) - 1;
facet = (1 + turned) * (1 + v) * (1 + x) * (1 + s1) * (1 + last) * (1 + s2) - 1;
other = (1 + da) * (1 + vertex) * (1 + x) * (1 + s1) * (1 + last) * (1 + s2) - 1;
edge = (1 + n) * (1 + vertex) * (1 + x) * (1 + s1) * (1 + last) * (1 + s2) - 1;
{ dr in [0, 35b-53] /\ da in [0, 6b-53] /\ rows in [0, 0x5.4p-53] /\ cross in [0, 3b-53] /\ scaling in [0, 5b-53]
/\ n in [0, 62b-53] /\ v in [0, 3b-53] /\ x in [0, 2b-53] /\ s1 in [0, 1b-53] /\ last in [0, 0x3.02p-53]
/\ s2 in [0, 2b-53]
-> turned in [0, 47b-53] /\ edges in [0, 62b-53] /\ vertex in [0, 44b-53]
/\ facet in [0, 60b-53] /\ other in [0, 60b-53] /\ edge in [0, 115b-53] }
