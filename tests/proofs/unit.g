# Unit vectors of integers: pir_int3_unit. u = 2^-53.
# proves: src/exact/vectors.c "8u holds both" 8 >= 6
# proves: src/query/frame/frame.h "A unit normal is off by 6u" 6 >= 6
#
# A component x is converted with an error c of 1.001u, relatively (pir_int_to_double). The sum of squares consists of
# terms that are not negative, so its relative error is at most that of the term that has the most: a square of a
# converted component, its product m, two sums a and b. Then a root r and a quotient d.
# Lemma. Each component off by e, relatively, puts the vector off by e of its length: |(e_k x_k)| <= max |e_k| |x|.
# Besides, components below 2^-1000 of the largest lose 2^-900 at most, which the second u above 5.6u holds.
F = (1 + c) * (1 + c) * (1 + m) * (1 + a) * (1 + b);
own = (1 + k) / (sqrt(F) * (1 + r)) * (1 + d) - 1;
{ |c| <= 0x1.01p-53 /\ |k| <= 0x1.01p-53 /\ |m| <= 1b-53 /\ |a| <= 1b-53 /\ |b| <= 1b-53 /\ |r| <= 1b-53
/\ |d| <= 1b-53
-> |own| <= 6b-53 }
