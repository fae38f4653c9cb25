# Rates, slopes and sides of a facet: RATE_BOUND, PIR_SLOPE_BOUND, PIR_SIDE_ERRORS. u = 2^-53.
# proves: src/query/decide/line.c "#define RATE_BOUND 0x1p-46" 128 >= 115
# proves: src/query/decide/facet.h "#define PIR_SLOPE_BOUND 0x1p-46" 128 >= 118
# proves: src/query/frame/frame.h "#define PIR_SLACK_BOUND 0x1p-46" 128 >= 118
#
# A normal is off by `n`, 64u where its err is 1, else by that times err (slack.g), and all other errors are taken times
# err, which is at least 1. A line's direction is off by `way`: 4u, and where Q is turned by 35u and the rounding of
# the product more. A normal turned back into P's frame is off by another 35u and 5.3u. Edges are off by 6u, turned by
# 47u.
rate = (1 + n) * (1 + way) * (1 + last) - 1;
slope = (1 + n) * (1 + dr) * (1 + rows) * (1 + edge) * (1 + last) - 1;
side = (1 + n) * (1 + turned) * (1 + cross) - 1;
{ n in [0, 64b-53] /\ way in [0, 45b-53] /\ last in [0, 0x3.02p-53] /\ dr in [0, 35b-53] /\ rows in [0, 0x5.4p-53]
/\ edge in [0, 6b-53] /\ turned in [0, 47b-53] /\ cross in [0, 3b-53]
-> rate in [0, 115b-53] /\ slope in [0, 118b-53] /\ side in [0, 118b-53] }
