# The filter of s(a, b) = (M(q) a) b: PIR_SIGN_BOUND. u = 2^-53.
# proves: src/exact/sign.h "#define PIR_SIGN_BOUND 0x1p-47" 64 >= 62
#
# r is off by 37u, where a rotation is relative, unit vectors by 8u, as they are promised; the product with r rounds by
# `rows`, the last dot product by `last` (dot.g).
# Lemma. |(r + dr)(a + da) - r a| <= (1 + |dr|)(1 + |da|) - 1 for |r|, |a| <= 1, and likewise for the dot product.
turned = (1 + dr) * (1 + da) - 1 + rows * (1 + dr) * (1 + da);
all = (1 + turned) * (1 + db) * (1 + last) - 1;
{ dr in [0, 37b-53] /\ da in [0, 8b-53] /\ db in [0, 8b-53] /\ rows in [0, 0x5.4p-53] /\ last in [0, 0x3.02p-53]
-> turned in [0, 51b-53] /\ all in [0, 62b-53] }
