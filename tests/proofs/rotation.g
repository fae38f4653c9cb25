# Matrices of quaternions: pir_doubles_at. u = 2^-53.
# proves: src/exact/rotation.h "within 31·2^-53 of R in Frobenius norm" 31 >= 31
# proves: src/exact/rotation.h "within 8·2^-53" 8 >= 6
#
# An entry is a sum of four terms +- q_i q_j, or of twice two, over n = |q|^2; each term has a product m and at most
# three sums. n has terms that are not negative, so its relative error is that of the term that has the most. Then a
# reciprocal v and a product w. `entry` is what this does to one term.
# Lemma. The magnitudes of an entry's terms add up to at most n, so an entry is off by at most `entry`, and nine of
# them by 3 `entry` in Frobenius norm, which is at least what the matrix does to a unit vector.
# A component of `unit` has a root r of n, a reciprocal v and a product w.
sums = (1 + a) * (1 + b) * (1 + c);
n = (1 + m2) * (1 + a2) * (1 + b2) * (1 + c2);
entry = (1 + m) * sums / n * (1 + v) * (1 + w) - 1;
matrix = 3 * entry;
part = 1 / (sqrt(n) * (1 + r)) * (1 + v) * (1 + w) - 1;
{ |m| <= 1b-53 /\ |a| <= 1b-53 /\ |b| <= 1b-53 /\ |c| <= 1b-53 /\ |m2| <= 1b-53 /\ |a2| <= 1b-53 /\ |b2| <= 1b-53
/\ |c2| <= 1b-53 /\ |v| <= 1b-53 /\ |w| <= 1b-53 /\ |r| <= 1b-53
-> |entry| <= 0xa.1p-53 /\ |matrix| <= 31b-53 /\ |part| <= 6b-53 }
