# Matrices of relative rotations: pir_rotation_set_relative. u = 2^-53.
# proves: src/exact/rotation.h "37·2^-53 if relative" 37 >= 35
#
# Each component of the product is off by u of itself and by some u^2 of the length, so the product is off by `q` of its
# length, 1.01u, and its direction by `chord` at most.
# Lemma. Unit quaternions at a distance c turn by angles that differ by t = 4 asin(c/2). R - R' has the singular values
# 2 sin(t/2), twice, and 0: in Frobenius norm 2 sqrt(2) sin(2 asin(c/2)) <= 2 sqrt(2) c.
chord = q / (1 - q);
turned = 2 * sqrt(2) * chord;
all = r + turned;
{ q in [0, 0x1.04p-53] /\ |r| <= 31b-53
-> turned in [0, 3b-53] /\ |all| <= 35b-53 }
