# Cross products, determinants and scaling to unit length: pir_vec_cross. u = 2^-53.
# proves: src/query/frame/frame.h "The product rounds by 3u" 3 >= 3
# proves: src/query/frame/frame.h "scaling by 5u" 5 >= 5
# proves: src/cgm/sides.c "a triple product by less than 12u" 12 >= 8
#
# A component a_i b_j - a_j b_i has a product m and a difference s.
# Lemma. The magnitudes |a_i b_j| + |a_j b_i| have a vector no longer than sqrt(2) |a||b|: its square is at most
# 2 sum(a_i^2 b_j^2, i != j) <= 2 |a|^2 |b|^2. So the product is off by sqrt(2) `part` |a||b|. A triple product has three
# more roundings, over the same magnitudes.
# A vector scaled by the reciprocal of its length: squares m2, sums a and b, root r, reciprocal v and product w.
part = (1 + m) * (1 + s) - 1;
cross = sqrt(2) * |part|;
triple = sqrt(2) * |(1 + m) * (1 + s) * (1 + m2) * (1 + a) * (1 + b) - 1|;
scaling = 1 / (sqrt((1 + m2) * (1 + a) * (1 + b)) * (1 + r)) * (1 + v) * (1 + w) - 1;
{ |m| <= 1b-53 /\ |s| <= 1b-53 /\ |m2| <= 1b-53 /\ |a| <= 1b-53 /\ |b| <= 1b-53 /\ |r| <= 1b-53 /\ |v| <= 1b-53
/\ |w| <= 1b-53
-> cross in [0, 3b-53] /\ triple in [0, 8b-53] /\ |scaling| <= 5b-53 }
