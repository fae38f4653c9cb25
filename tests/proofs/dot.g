# Dot products, and products of matrices and vectors: pir_vec_dot, pir_mat_apply. u = 2^-53.
# proves: src/exact/sign.h "the last dot product 3.01u" 3.01 >= 3.01
# proves: src/exact/sign.h "5.3u from rounding" 5.3 >= 5.25
#
# A term of x x' + y y' + z z' has a product m and at most two sums.
# Lemma. The magnitudes of the terms add up to at most |a||b| (Cauchy and Schwarz), so `term` bounds the error relative
# to that. A matrix of rows of length 1 has three of them: sqrt(3) `term` in length.
# For components of at most 1 in magnitude, and vectors no longer than 1, the rounding of doubles itself:
@d = float<ieee_64, ne>;
term = (1 + m) * (1 + a) * (1 + b) - 1;
rows = sqrt(3) * |term|;
s d= x1 * x2 + y1 * y2 + z1 * z2;
exact = x1 * x2 + y1 * y2 + z1 * z2;
{ |m| <= 1b-53 /\ |a| <= 1b-53 /\ |b| <= 1b-53
/\ |x1| <= 1 /\ |x2| <= 1 /\ |y1| <= 1 /\ |y2| <= 1 /\ |z1| <= 1 /\ |z2| <= 1 /\ |x1 * x2 + y1 * y2| <= 1
-> |term| <= 0x3.02p-53 /\ rows in [0, 0x5.4p-53] /\ |s - exact| <= 4b-53 }
