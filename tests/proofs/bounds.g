# Bounds on groups of facets: caps in depth/bounds.c. u = 2^-53.
# proves: src/query/depth/bounds.c "128u, holds" 128 >= 120
#
# w = R a + b - x: a vertex is off by 3u, turned by 35u and 5.3u (dot.g), x by 2u, two sums by 2u. A turned normal is
# off by 47u (slack.g). The bound's own arithmetic takes 16u.
w = (1 + v) * (1 + dr) * (1 + rows) * (1 + x) * (1 + sums) - 1;
bound = (1 + w) * (1 + n) * (1 + own) - 1;
{ v in [0, 3b-53] /\ dr in [0, 35b-53] /\ rows in [0, 0x5.4p-53] /\ x in [0, 2b-53] /\ sums in [0, 2b-53]
/\ n in [0, 47b-53] /\ own in [0, 16b-53]
-> w in [0, 48b-53] /\ bound in [0, 120b-53] }
