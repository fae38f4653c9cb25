# Signs over Gaussian maps on the cube: cgm/sides.c. u = 2^-53.
# proves: src/cgm/sides.c "|δa| + |δb| + 5u" 5 >= 5
# proves: src/cgm/cgm.h "#define PIR_CGM_TURNED_ERROR (45 * 0x1p-53)" 45 >= 45
#
# A unit vector, off by 8u, turned by a matrix that is off by 31u, which rounds by 5.3u. The product of two vectors, up
# to 1 + 2^-40 long and off by 45u at most: besides both errors, what their product and the rounding take is `more`.
turned = (1 + dr) * (1 + da) - 1 + rows * (1 + dr) * (1 + da);
more = a * b + cross * (1 + l) * (1 + l) + (a + b) * l;
{ dr in [0, 31b-53] /\ da in [0, 8b-53] /\ rows in [0, 0x5.4p-53] /\ a in [0, 45b-53] /\ b in [0, 45b-53]
/\ cross in [0, 3b-53] /\ l in [0, 1b-40]
-> turned in [0, 45b-53] /\ more in [0, 5b-53] }
