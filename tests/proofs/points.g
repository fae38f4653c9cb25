# Planes between two sets of points: MARGIN of plans by any motion. u = 2^-53.
# proves: src/plan/rigid/point_sets.c "#define MARGIN 0x1p-44" 512 >= 40
#
# Points are within 2^-50 of the exact ones in each coordinate, `near`. All errors are over the sizes of the products of
# v with two points, whose greatest are told by two sums and a product each, down to `told` of themselves.
# The gap is of a difference s of two points, and a dot product; a point that is chosen may be above another by twice
# what a dot product of points is off by. `gap` is of the plane of the exact points.
chosen = (1 + near) * (1 + last) - 1;
gap = ((1 + near) * (1 + s) * (1 + last) - 1 + 2 * chosen) / (1 - told);
{ near in [0, 8b-53] /\ s in [0, 1b-53] /\ last in [0, 0x3.02p-53] /\ told in [0, 0x3.02p-53]
-> chosen in [0, 0xb.1p-53] /\ gap in [0, 40b-53] }
