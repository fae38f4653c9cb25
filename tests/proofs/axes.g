# Slacks along all axes of two small bodies: pair/axes. u = 2^-53, lengths over the reach.
# proves: src/pair/axes/axes.c "known to 110u" 110 >= 110
#
# The product of two edges is off by `cross`: 6u and 47u, and 3u of rounding (slack.g, cross.g). P's vertices are turned
# first: 3u, 35u and 5.3u. The dot product and the sums round by 3.02u and 2u.
cross = (1 + a) * (1 + b) * (1 + c) - 1;
vertex = (1 + v) * (1 + dr) * (1 + rows) - 1;
slack = (1 + cross) * (1 + vertex) * (1 + last) * (1 + sums) - 1;
{ a in [0, 6b-53] /\ b in [0, 47b-53] /\ c in [0, 3b-53] /\ v in [0, 3b-53] /\ dr in [0, 35b-53]
/\ rows in [0, 0x5.4p-53] /\ last in [0, 0x3.02p-53] /\ sums in [0, 2b-53]
-> cross in [0, 64b-53] /\ vertex in [0, 44b-53] /\ slack in [0, 110b-53] }
