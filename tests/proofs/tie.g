# Ties that doubles settle: sized_sign in sign.c. u = 2^-53.
# proves: src/exact/sign.c "#define RELATIVE_BOUND 0x1p-48" 32 >= 13
#
# A sum has terms a_k (b v), b_k (a v) and c_k w, each a sum of products in turn. A product of those has at most two
# products and two sums of b v, then two sums. `size` adds up the magnitudes with the same roundings at most.
# Lemma. The sum is off by at most `term` of the sum of magnitudes, which `size` does not exceed by more than `term`. A
# sum above `ratio` times `size` in magnitude has the right sign; the product with the bound rounds by u.
term = (1 + m1) * (1 + s1) * (1 + s2) * (1 + m2) * (1 + s3) * (1 + s4) - 1;
e = |term|;
ratio = 2 * e / (1 - e) * (1 + p);
{ |m1| <= 1b-53 /\ |s1| <= 1b-53 /\ |s2| <= 1b-53 /\ |m2| <= 1b-53 /\ |s3| <= 1b-53 /\ |s4| <= 1b-53 /\ |p| <= 1b-53
-> ratio in [0, 13b-53] }
